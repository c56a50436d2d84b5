// SPDX-License-Identifier: MIT OR Apache-2.0
//! Configurations of serial designs.

use foveate_spec::{Config, FeatureKind, Organization, SpatialConfig};

/// A serial design with these features; everything else is the paper's.
pub(crate) fn config(features: &[SpatialConfig]) -> Config {
    let mut config = Config { spatial: features.to_vec(), ..Config::default() };
    config.hardware.organization = Organization::Serial;
    config
}

pub(crate) fn feature(kind: FeatureKind, mean_fraction_bits: u32) -> SpatialConfig {
    let mut feature = SpatialConfig::new(kind);
    feature.mean_fraction_bits = (kind == FeatureKind::Mad).then_some(mean_fraction_bits);
    feature
}

pub(crate) fn name(config: &Config, grid: (u32, u32)) -> String {
    let kinds: Vec<_> = config.spatial.iter().map(|s| s.feature.name()).collect();
    format!(
        "{} N={} P={} {} {} {} {} {} {} {} {:?} fold {} of {}x{}",
        kinds.join("+"),
        config.region.size,
        config.frame.pixel_bits,
        config.denoise.filter,
        config.region.neighborhood,
        config.temporal.reference,
        config.render.irrelevant,
        config.render.payload,
        config.decision.combine,
        config.hardware.thresholds,
        config.hardware.feed,
        config.hardware.fold,
        grid.0,
        grid.1,
    )
}
