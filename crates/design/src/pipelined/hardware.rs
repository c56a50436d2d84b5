// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a pipelined array, and the configurations that it supports.

use crate::takes::Takes;
use crate::{HardwareConfig, Organization, Pipelining, ThresholdSource};
use foveate_camera::{Camera, ConfigError, FeatureKind, IrrelevantRendering, ReferencePolicy};

/// The properties that only a pipelined array has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipelinedHardware {
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
}

impl Takes for PipelinedHardware {
    fn takes_feature(kind: FeatureKind) -> bool {
        match kind {
            FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Mad | FeatureKind::Variance => {
                true
            }
        }
    }

    fn takes_reference(reference: ReferencePolicy) -> bool {
        match reference {
            ReferencePolicy::Previous | ReferencePolicy::LastSent => true,
        }
    }

    fn takes_irrelevant(irrelevant: IrrelevantRendering) -> bool {
        match irrelevant {
            IrrelevantRendering::Zero | IrrelevantRendering::Hold | IrrelevantRendering::Mean => {
                true
            }
        }
    }

    fn takes_thresholds(thresholds: ThresholdSource) -> bool {
        match thresholds {
            ThresholdSource::Runtime | ThresholdSource::Constant => true,
        }
    }

    fn takes_sync() -> bool {
        true
    }

    fn validate(asked: &HardwareConfig, _: &Camera) -> Result<Self, ConfigError> {
        // The keys that are ignored here have been checked before.
        let &HardwareConfig {
            pipelining,
            fold: _,
            feed: _,
            memory: _,
            pixels_per_clock: _,
            store: _,
            forward: _,
            interface: _,
            organization: _,
            sync: _,
            thresholds: _,
        } = asked;
        Ok(Self { pipelining: pipelining.unwrap_or_default() })
    }
}

impl PipelinedHardware {
    /// Returns the table `[hardware]`. A default is left out, so that the fingerprint of a design
    /// is the same as before the key existed.
    pub(crate) fn config(&self) -> HardwareConfig {
        HardwareConfig {
            organization: Organization::Pipelined,
            pipelining: self.pipelining.non_default(),
            ..HardwareConfig::default()
        }
    }
}
