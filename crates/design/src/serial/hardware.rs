// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a serial array has of its own, and what of a configuration it takes.

use crate::takes::Takes;
use crate::{Feed, HardwareConfig, MemoryKind, Organization, Pipelining, Thresholds};
use foveate_camera::{Camera, ConfigError, FeatureKind, Irrelevant, Reference, in_range};

/// Smallest side of a region.
const MIN_SIDE: u32 = 4;

/// What a serial array has of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Serial {
    /// Regions per lane K.
    pub fold: u32,
    /// How pixels enter.
    pub feed: Feed,
    /// Of what the memories of the lanes are to be built, where the configuration says so; see [`super::LaneMemory`].
    pub memory: Option<MemoryKind>,
    /// How finely the arithmetic is cut by registers.
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
        // Values without a name are refused before, or were asked for.
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
    /// `[hardware]`. A default is left out, so that designs have the fingerprints from before there was the key.
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
