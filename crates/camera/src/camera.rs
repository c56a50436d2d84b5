// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated configuration of what is computed: one immutable value from which everything else is derived.

use crate::{
    CameraConfig, Combine, FeatureKind, Filter, Irrelevant, Neighborhood, Payload, Periphery,
    Reference, SpatialFeature,
};

/// A camera: what is computed of which frames. A configuration that has been checked, with every number that
/// follows from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    config: CameraConfig,
    width: u32,
    height: u32,
    features: Vec<SpatialFeature>,
    temporal: Temporal,
    periphery: Option<Periphery>,
}

/// The temporal score with its thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Temporal {
    /// A pixel has changed when it differs by more than this.
    pub level: u32,
    /// TRS from this count on.
    pub min_count: u32,
    /// What a frame is compared with.
    pub reference: Reference,
}

impl Camera {
    /// What [`CameraConfig::validate`] has found valid, every key filled in.
    pub(crate) fn new(
        config: CameraConfig,
        (width, height): (u32, u32),
        features: Vec<SpatialFeature>,
        temporal: Temporal,
        periphery: Option<Periphery>,
    ) -> Self {
        Self { config, width, height, features, temporal, periphery }
    }

    /// The configuration with every key filled in.
    #[must_use]
    pub fn config(&self) -> &CameraConfig {
        &self.config
    }

    /// Frame width W in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Frame height H in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Bits per pixel P.
    #[must_use]
    pub fn pixel_bits(&self) -> u32 {
        self.config.frame.pixel_bits
    }

    /// Side of a region N in pixels.
    #[must_use]
    pub fn region_size(&self) -> u32 {
        self.config.region.size
    }

    /// What windows see beyond a region's border.
    #[must_use]
    pub fn neighborhood(&self) -> Neighborhood {
        self.config.region.neighborhood
    }

    /// The filter in front of every score.
    #[must_use]
    pub fn filter(&self) -> Filter {
        self.config.denoise.filter
    }

    /// The spatial features, in the order of the configuration.
    #[must_use]
    pub fn features(&self) -> &[SpatialFeature] {
        &self.features
    }

    /// Their kinds, in that order.
    #[must_use]
    pub fn kinds(&self) -> Vec<FeatureKind> {
        self.features.iter().map(SpatialFeature::kind).collect()
    }

    /// How their votes become SRS.
    #[must_use]
    pub fn combine(&self) -> Combine {
        self.config.decision.combine
    }

    /// The temporal score.
    #[must_use]
    pub fn temporal(&self) -> &Temporal {
        &self.temporal
    }

    /// What is shown where SRS is 0.
    #[must_use]
    pub fn irrelevant(&self) -> Irrelevant {
        self.config.render.irrelevant
    }

    /// What irrelevant regions send; none where they send nothing.
    #[must_use]
    pub fn periphery(&self) -> Option<&Periphery> {
        self.periphery.as_ref()
    }

    /// Which pixels an active region forwards.
    #[must_use]
    pub fn payload(&self) -> Payload {
        self.config.render.payload
    }
}
