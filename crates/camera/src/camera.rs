// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated camera: one immutable value from which all other numbers are derived.

use crate::{
    CameraConfig, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    Periphery, ReferencePolicy, SpatialFeature, VoteCombination, Zones,
};

/// A region-based event camera: a configuration that has been checked, with every number that
/// follows from it. It says what is computed, and nothing about the hardware.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    config: CameraConfig,
    width: u32,
    height: u32,
    features: Vec<SpatialFeature>,
    temporal: TemporalParameters,
    periphery: Option<Periphery>,
    zones: Option<Zones>,
}

/// The thresholds and the reference of the temporal score.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TemporalParameters {
    /// The per-pixel threshold in grey levels: a pixel has changed when it differs by more than
    /// this.
    pub level: u32,
    /// The per-region threshold in pixels: TRS is 1 when at least this many pixels have changed.
    pub min_count: u32,
    /// The reference that a frame is compared with.
    pub reference: ReferencePolicy,
}

impl Camera {
    /// Makes a camera from a configuration that [`CameraConfig::validate`] has checked and
    /// completed.
    pub(crate) fn new(
        config: CameraConfig,
        (width, height): (u32, u32),
        features: Vec<SpatialFeature>,
        temporal: TemporalParameters,
        (periphery, zones): (Option<Periphery>, Option<Zones>),
    ) -> Self {
        Self { config, width, height, features, temporal, periphery, zones }
    }

    /// Returns the configuration with every key that applies filled in. `periphery` is empty unless
    /// irrelevant regions send means.
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

    /// Returns the rule for pixels of a window that lie beyond the border of a region.
    #[must_use]
    pub fn neighborhood(&self) -> Neighborhood {
        self.config.region.neighborhood
    }

    /// The filter in front of every score.
    #[must_use]
    pub fn filter(&self) -> DenoiseFilter {
        self.config.denoise.filter
    }

    /// The spatial features, in the order of the configuration.
    #[inline]
    #[must_use]
    pub fn features(&self) -> &[SpatialFeature] {
        &self.features
    }

    /// Returns the kinds of the spatial features, in the order of the configuration.
    #[must_use]
    pub fn feature_kinds(&self) -> Vec<FeatureKind> {
        self.features.iter().map(SpatialFeature::kind).collect()
    }

    /// Returns the rule by which the votes of the features become SRS.
    #[must_use]
    pub fn combine(&self) -> VoteCombination {
        self.config.decision.combine
    }

    /// Returns the parameters of the temporal score.
    #[must_use]
    pub fn temporal(&self) -> &TemporalParameters {
        &self.temporal
    }

    /// Returns the pixels that the screen shows where SRS is 0.
    #[must_use]
    pub fn irrelevant(&self) -> IrrelevantRendering {
        self.config.render.irrelevant
    }

    /// Returns the parameters of the summaries that irrelevant regions send, or `None` if they send
    /// none.
    #[inline]
    #[must_use]
    pub fn periphery(&self) -> Option<&Periphery> {
        self.periphery.as_ref()
    }

    /// Returns the thresholds of classes of regions, or `None` for a camera without zones.
    /// [`Camera::class_thresholds`] has the thresholds of one class.
    #[inline]
    #[must_use]
    pub fn zones(&self) -> Option<&Zones> {
        self.zones.as_ref()
    }

    /// Returns the choice of the pixels that an active region forwards: denoised or raw.
    #[must_use]
    pub fn payload(&self) -> Payload {
        self.config.render.payload
    }
}
