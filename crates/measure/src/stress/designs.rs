// SPDX-License-Identifier: MIT OR Apache-2.0
//! The material of all cases: designs ([`design_matrix`]), frames ([`frame_from_fn`]), and
//! random numbers that are the same on every machine ([`RandomNumbers`]).

use foveate_camera::{
    Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, SUMMARY_BLOCKS, SpatialConfig,
};
use foveate_design::{Design, DesignConfig, FeatureHardware, Organization};
use foveate_pixels::Frame;

/// Returns a configuration for frames of `size` with regions of side `side` and pixels of `bits`.
/// The thresholds are low enough for any depth.
pub(crate) fn config(
    size: (u32, u32),
    side: u32,
    bits: u32,
    features: &[FeatureKind],
) -> DesignConfig {
    let mut config = DesignConfig::default();
    (config.camera.frame.width, config.camera.frame.height) = (Some(size.0), Some(size.1));
    config.camera.frame.pixel_bits = bits;
    config.camera.region.size = side;
    config.camera.temporal.level = Some((1u32 << bits) / 32);
    config.camera.temporal.min_count = 3;
    config.camera.spatial = features.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    // Pixels of 1 bit are on both sides of a mean only if the mean has a fraction.
    let needs_fraction = bits == 1
        && features.iter().any(|kind| kind.has_second_pass() && kind.score_unit().is_count());
    for spatial in &mut config.camera.spatial {
        if needs_fraction && spatial.has_mean_fraction() {
            spatial.mean_fraction_bits = Some(1);
        }
        if spatial.feature.score_unit().is_count() {
            spatial.level = Some((1 << bits) / 4);
            spatial.min_score = Some(Decimal::from_whole(2));
        } else {
            spatial.min_score = Decimal::from_f64(0.2);
        }
    }
    config
}

/// Validates a configuration that is known to be valid.
pub(crate) fn design(config: &DesignConfig) -> Design {
    config.validate().unwrap_or_else(|error| unreachable!("the matrix holds designs: {error}"))
}

/// Returns an organization that computes the score of the feature: `pipelined` if it can.
pub(crate) fn organization_for(kind: FeatureKind) -> Organization {
    let mut organizations = FeatureHardware::of_kind(kind).organizations();
    organizations.next().expect("an organization computes each score")
}

pub(crate) fn kinds_for(side: u32) -> Vec<FeatureKind> {
    let fits = |&kind: &FeatureKind| match organization_for(kind) {
        Organization::Pipelined | Organization::Raster => true,
        Organization::Serial => side >= 4,
    };
    FeatureKind::ALL.iter().copied().filter(fits).collect()
}

/// Returns designs with every neighborhood, filter, payload and reference, and the features in
/// turn.
pub(crate) fn design_matrix(size: (u32, u32), side: u32, bits: u32) -> Vec<Design> {
    let kinds = kinds_for(side);
    let mut designs = Vec::new();
    for &neighborhood in Neighborhood::ALL {
        for &filter in DenoiseFilter::ALL {
            for &reference in ReferencePolicy::ALL {
                for &payload in Payload::ALL {
                    // Each round begins with the next feature, so that a feature meets both
                    // references and payloads.
                    let turn = designs.len() + designs.len() / kinds.len();
                    let kind = kinds[turn % kinds.len()];
                    let mut config = config(size, side, bits, kind.spec().companions);
                    config.hardware.organization = organization_for(kind).into();
                    config.camera.region.neighborhood = neighborhood;
                    config.camera.denoise.filter = filter;
                    config.camera.temporal.reference = reference;
                    config.camera.render.payload = payload;
                    designs.push(design(&config));
                }
            }
        }
    }
    designs
}

/// Returns the designs of [`design_matrix`] with irrelevant regions that show the means of blocks.
/// The scores of random frames lie on both sides of the thresholds.
pub(crate) fn designs_with_means(size: (u32, u32), side: u32, bits: u32) -> Vec<Design> {
    let mut designs = Vec::new();
    for (number, design_without_means) in design_matrix(size, side, bits).iter().enumerate() {
        let mut config = design_without_means.config();
        config.camera.render.irrelevant = IrrelevantRendering::Mean;
        config.camera.periphery.blocks = Some(SUMMARY_BLOCKS[number % SUMMARY_BLOCKS.len()]);
        config.camera.periphery.level = Some((1 << bits) >> (number % 7 + 1));
        for spatial in &mut config.camera.spatial {
            let feature = design_without_means.feature(spatial.feature);
            let score_max = feature.expect("the design has its features").score_max();
            let minimum = match &spatial.feature.spec().level {
                Some(level) => score_max / level.random_divisor,
                None => 1 << (bits - 2),
            };
            spatial.min_score = Some(Decimal::from_whole(minimum));
        }
        designs.push(design(&config));
    }
    designs
}

/// Makes a frame from a function of column and row.
pub(crate) fn frame_from_fn(size: (u32, u32), bits: u32, pixel: impl Fn(u32, u32) -> u32) -> Frame {
    let pixel = |x, y| u16::try_from(pixel(x, y)).expect("a pixel has at most 16 bits");
    Frame::from_fn(size.0, size.1, bits, pixel)
        .unwrap_or_else(|error| unreachable!("a case makes valid frames: {error}"))
}

/// A small generator of random numbers, an LCG whose upper bits are mixed.
#[derive(Clone, Debug)]
pub(crate) struct RandomNumbers(u64);

impl RandomNumbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed ^ 0x9E37_79B9_7F4A_7C15)
    }

    /// Returns a number in 0..bound.
    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        let mixed = (self.0 ^ (self.0 >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (mixed ^ (mixed >> 32)) % bound.max(1)
    }

    /// Returns a frame of random pixels.
    pub(crate) fn frame(&mut self, size: (u32, u32), bits: u32) -> Frame {
        let (width, height) = (size.0 as usize, size.1 as usize);
        let pixels = (0..width * height)
            .map(|_| u16::try_from(self.below(1 << bits)).expect("a pixel has at most 16 bits"))
            .collect();
        Frame::new(size.0, size.1, bits, pixels)
            .unwrap_or_else(|error| unreachable!("random frames are valid: {error}"))
    }
}
