// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a serial array, and the configurations that it supports.

use crate::takes::Takes;
use crate::{Feed, HardwareConfig, MemoryKind, Organization, Pipelining, Thresholds};
use foveate_camera::{Camera, ConfigError, FeatureKind, Irrelevant, Reference, in_range};

/// Smallest side of a region in pixels.
const MIN_SIDE: u32 = 4;

/// The properties that only a serial array has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Serial {
    /// Regions per lane K.
    pub fold: u32,
    /// The order in which pixels enter.
    pub feed: Feed,
    /// The kind of memory of the lanes, if the configuration chooses it; see [`super::LaneMemory`].
    pub memory: Option<MemoryKind>,
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
}

impl Takes for Serial {
    fn takes_feature(kind: FeatureKind) -> bool {
        match kind {
            FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Mad | FeatureKind::Variance => {
                true
            }
        }
    }

    fn takes_reference(reference: Reference) -> bool {
        match reference {
            Reference::Previous | Reference::LastSent => true,
        }
    }

    fn takes_irrelevant(irrelevant: Irrelevant) -> bool {
        match irrelevant {
            Irrelevant::Zero | Irrelevant::Hold | Irrelevant::Mean => true,
        }
    }

    fn takes_thresholds(thresholds: Thresholds) -> bool {
        match thresholds {
            Thresholds::Runtime | Thresholds::Constant => true,
        }
    }

    fn takes_sync() -> bool {
        true
    }

    fn validate(asked: &HardwareConfig, camera: &Camera) -> Result<Self, ConfigError> {
        // The keys that are ignored here have been checked before.
        let &HardwareConfig {
            fold,
            feed,
            memory,
            pipelining,
            pixels_per_clock: _,
            store: _,
            forward: _,
            interface: _,
            organization: _,
            sync: _,
            thresholds: _,
        } = asked;
        let (size, regions) = (camera.region_size(), camera.regions());
        if size < MIN_SIDE {
            let remedy = format!("use {MIN_SIDE}..=64, or \"pipelined\"");
            return Err(asked.clash("region.size", size.to_string(), &remedy));
        }
        let why = format!(" (the frame has {regions} regions); fold = {regions} makes one lane");
        in_range("hardware.fold", fold, 1..=regions, &why)?;
        Ok(Self {
            fold,
            feed: feed.unwrap_or_default(),
            memory,
            pipelining: pipelining.unwrap_or_default(),
        })
    }
}

impl Serial {
    /// Returns the table `[hardware]`. `pipelining` is left out while it has its default, so that
    /// the fingerprint of a design is the same as before the key existed.
    pub(crate) fn config(&self) -> HardwareConfig {
        HardwareConfig {
            organization: Organization::Serial,
            fold: self.fold,
            feed: Some(self.feed),
            memory: self.memory,
            pipelining: self.pipelining.if_deep(),
            ..HardwareConfig::default()
        }
    }
}
