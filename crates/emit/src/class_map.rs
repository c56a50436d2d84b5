// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of classes of a serial array or a raster core: its parameters, and the signals that are
//! connected to its ports. A design without zones connects constants.

use super::camera_flags::threshold_signal;
use foveate_camera::RegionClass;
use foveate_design::{CLASSES_PER_WORD, Design, PortRole, class_word, keen_role};

/// Bits of the number of a word of the map, in terms of the grid. They are at least 1.
const ADDRESS_BITS: &str = "(COLUMNS*ROWS > 32 ? $clog2((COLUMNS*ROWS+15)/16) : 1)";

/// Returns the range of the port with the number of a word of the map.
pub(crate) fn class_address_range() -> String {
    debug_assert_eq!(CLASSES_PER_WORD, 16);
    format!("[{ADDRESS_BITS}-1:0]")
}

/// Returns the map of the configuration as a constant of the Verilog with the classes of a row of
/// regions in each line, or `None` for a design without zones.
pub(crate) fn first_map(design: &Design) -> Option<String> {
    let classes = design.zones()?.configured_classes();
    if has_normal_map(design) {
        return Some("0".to_owned());
    }
    let rows: Vec<_> = classes.chunks(columns(design)).rev().map(row_constant).collect();
    Some(format!("{{\n        {}\n    }}", rows.join(",\n        ")))
}

/// Returns true if the design has a memory of classes whose first map has only normal regions.
pub(crate) fn has_normal_map(design: &Design) -> bool {
    let is_normal =
        |classes: &[RegionClass]| classes.iter().all(|&class| class == RegionClass::Normal);
    design.has_class_memory()
        && design.zones().is_some_and(|zones| is_normal(zones.configured_classes()))
}

fn columns(design: &Design) -> usize {
    usize::try_from(design.columns()).expect("a row of regions is in memory")
}

/// Returns the classes of a row of regions as a hexadecimal constant, that of the first region in
/// the lowest bits.
fn row_constant(classes: &[RegionClass]) -> String {
    let digits: Vec<_> =
        classes.chunks(2).rev().map(|pair| format!("{:x}", class_word(pair))).collect();
    format!("{}'h{}", 2 * classes.len(), digits.concat())
}

/// Returns the parameters of the memory of classes.
pub(crate) fn class_parameters(design: &Design) -> Vec<(String, String)> {
    let zones = design.zones().map(|_| {
        [
            ("ZONES", "1".to_owned()),
            ("CLASS_ADDRESS_BITS", ADDRESS_BITS.to_owned()),
            ("CLASSES", "CLASSES".to_owned()),
        ]
    });
    zones.into_iter().flatten().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Returns the ports of the memory of classes, and the signals connected to them.
pub(crate) fn class_connections(design: &Design) -> [(&'static str, &'static str); 5] {
    match design.zones() {
        Some(_) => {
            ["zone_write_i", "zone_address_i", "zone_word_i", "zone_commit_i", "zone_pending_o"]
                .map(|port| (port, port))
        }
        None => [
            ("zone_write_i", "1'b0"),
            ("zone_address_i", "1'b0"),
            ("zone_word_i", "32'd0"),
            ("zone_commit_i", "1'b0"),
            ("zone_pending_o", "unused_zone_pending"),
        ],
    }
}

/// Returns the signal of the keen threshold that takes the place of this one. Without zones it is
/// the signal of this threshold.
pub(crate) fn keen_signal(design: &Design, role: PortRole) -> String {
    threshold_signal(design, design.zones().map_or(role, |_| keen_role(role)))
}

/// Returns the signals of the summary level of keen regions and of regions that are off.
pub(crate) fn class_summary_levels(design: &Design) -> [String; 2] {
    match (design.periphery(), design.zones()) {
        (None, _) => [0, 0].map(|_: u32| format!("{}'d0", design.pixel_bits())),
        (Some(_), None) => [PortRole::SummaryLevel; 2].map(|role| threshold_signal(design, role)),
        (Some(_), Some(_)) => [PortRole::KeenSummaryLevel, PortRole::OffSummaryLevel]
            .map(|role| threshold_signal(design, role)),
    }
}
