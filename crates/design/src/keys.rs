// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of `[hardware]`. An unknown key is refused by name, and the message suggests the
//! nearest known key.

use crate::{
    FrameStoreKind, InterfaceKind, LaneMemoryKind, Organization, Pipelining, PixelFeed,
    ThresholdSource,
};
use foveate_camera::{
    AcceptedValues::{Names, Text},
    ConfigKey,
};

/// Every key of `[hardware]`.
pub(crate) const HARDWARE_KEYS: &[ConfigKey] = &[
    ("hardware.organization", Names(Organization::NAMES)),
    ("hardware.fold", Text("a whole number >= 1")),
    ("hardware.feed", Names(PixelFeed::NAMES)),
    ("hardware.memory", Names(LaneMemoryKind::NAMES)),
    ("hardware.pixels_per_clock", Text("1, 2 or 4")),
    ("hardware.pipelining", Names(Pipelining::NAMES)),
    ("hardware.store", Names(FrameStoreKind::NAMES)),
    ("hardware.forward", Text("true or false")),
    ("hardware.interface", Names(InterfaceKind::NAMES)),
    ("hardware.sync", Text("true or false")),
    ("hardware.thresholds", Names(ThresholdSource::NAMES)),
];

/// Returns the keys of `[hardware]` that only this organization has.
pub(crate) fn own_keys(organization: Organization) -> &'static [&'static str] {
    match organization {
        Organization::Pipelined => &[],
        Organization::Serial => &["fold", "feed", "memory"],
        Organization::Raster => &["pixels_per_clock", "store", "forward", "interface"],
    }
}

#[cfg(test)]
mod tests {
    use crate::DesignConfig;
    use foveate_camera::toml_text::TomlConfig;

    /// `docs/configuration.md` has one row per key, and the row of a key lists every name that it
    /// takes.
    #[test]
    fn the_page_of_the_configuration_has_every_key() {
        let page = include_str!("../../../docs/configuration.md");
        let rows: Vec<(&str, &str)> = page
            .lines()
            .filter_map(|line| line.strip_prefix("| `")?.split_once("` |"))
            .filter(|(key, _)| key.contains('.'))
            .collect();
        for (key, takes) in DesignConfig::keys() {
            let row = rows.iter().find(|(name, _)| name == key);
            let (_, row) =
                row.unwrap_or_else(|| panic!("{key} has no row in docs/configuration.md"));
            for value in takes.to_string().split('"').skip(1).step_by(2) {
                assert!(
                    row.contains(&format!("`\"{value}\"`")),
                    "the row of {key} lacks \"{value}\""
                );
            }
        }
        for (key, _) in &rows {
            assert!(DesignConfig::keys().any(|(known, _)| known == key), "{key} is no key");
        }
        assert_eq!(rows.len(), DesignConfig::keys().count(), "a key has two rows");
    }
}
