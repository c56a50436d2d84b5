// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated configuration: one immutable value from which everything else is derived.

use crate::{
    Combine, Config, Feed, Filter, Irrelevant, Neighborhood, Organization, Payload, Pipelining,
    Reference, SpatialFeature, Store, Thresholds,
};

/// A design: a configuration that has been checked, with every number that follows from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    config: Config,
    width: u32,
    height: u32,
    features: Vec<SpatialFeature>,
    temporal: Temporal,
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

impl Design {
    /// What [`Config::validate`] has found valid, every key filled in.
    pub(crate) fn new(
        config: Config,
        (width, height): (u32, u32),
        features: Vec<SpatialFeature>,
        temporal: Temporal,
    ) -> Self {
        Self { config, width, height, features, temporal }
    }

    /// The configuration with every key filled in.
    #[must_use]
    pub fn config(&self) -> &Config {
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

    /// Which pixels an active region forwards.
    #[must_use]
    pub fn payload(&self) -> Payload {
        self.config.render.payload
    }

    /// The structure of the array.
    #[must_use]
    pub fn organization(&self) -> Organization {
        self.config.hardware.organization
    }

    /// Regions per lane K: 1 for `pipelined`, where an RPU has but one.
    #[must_use]
    pub fn fold(&self) -> u32 {
        self.config.hardware.fold
    }

    /// How pixels enter; `pipelined` is always fed in parallel.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.config.hardware.feed.unwrap_or_default()
    }

    /// Pixels of a word K of the raster organization; 1 in the others.
    #[must_use]
    pub fn pixels_per_clock(&self) -> u32 {
        self.config.hardware.pixels_per_clock.unwrap_or(1)
    }

    /// How finely the arithmetic of the raster organization is cut by registers.
    #[must_use]
    pub fn pipelining(&self) -> Pipelining {
        self.config.hardware.pipelining.unwrap_or_default()
    }

    /// Where the frame store of the raster organization is, and of what it is built.
    #[must_use]
    pub fn store(&self) -> Store {
        self.config.hardware.store.unwrap_or_default()
    }

    /// Whether the pixels of active regions leave the array or core.
    #[must_use]
    pub fn forwards(&self) -> bool {
        self.config.hardware.forward.unwrap_or(true)
    }

    /// Whether the array is told where frames start, and finds them again; see `docs/sync.md`.
    #[must_use]
    pub fn syncs(&self) -> bool {
        self.config.hardware.sync.unwrap_or(false)
    }

    /// The configuration with every key that its organization takes, also those that it leaves out while they have
    /// their default.
    #[must_use]
    pub fn spelled_out(&self) -> Config {
        let mut config = self.config.clone();
        let hardware = &mut config.hardware;
        hardware.pipelining = Some(self.pipelining());
        // What has a frame store may forward.
        hardware.forward = hardware.store.map(|_| self.forwards());
        config
    }

    /// Where the thresholds come from.
    #[must_use]
    pub fn thresholds(&self) -> Thresholds {
        self.config.hardware.thresholds
    }
}
