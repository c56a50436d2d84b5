// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pipelined organization: one RPU per region, one pixel per clock; see `docs/timing.md`.

mod ports;
mod timing;

pub use timing::PipelinedTiming;

use crate::rules::{Rules, Unit};
use crate::{
    Design, Feed, HardwareConfig, Organization, PipelinedDesign, Pipelining, Port, Timing,
};
use foveate_camera::ConfigError;

/// What a pipelined array has of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pipelined {
    /// How finely the arithmetic is cut by registers.
    pub pipelining: Pipelining,
}

impl Pipelined {
    /// What is asked for, if a pipelined array takes it.
    pub(crate) fn validate(asked: &HardwareConfig) -> Result<Self, ConfigError> {
        asked.refuse_raster_keys()?;
        if asked.fold != 1 {
            let remedy = "only the serial organization shares lanes; use 1";
            return Err(asked.clash("hardware.fold", asked.fold.to_string(), remedy));
        }
        if let Some(memory) = asked.memory {
            let remedy = "only the lanes of the serial organization have such a memory; \
                          leave the key out";
            return Err(asked.clash("hardware.memory", format!("\"{memory}\""), remedy));
        }
        match asked.feed {
            None | Some(Feed::Parallel) => {
                Ok(Self { pipelining: asked.pipelining.unwrap_or_default() })
            }
            Some(Feed::Raster) => {
                let remedy = "only the serial organization takes the frame row by row; \
                              leave the key out";
                Err(asked.clash("hardware.feed", format!("\"{}\"", Feed::Raster), remedy))
            }
        }
    }

    /// `[hardware]`. A default is left out, so that designs have the fingerprints from before there was the key.
    pub(crate) fn config(&self) -> HardwareConfig {
        HardwareConfig {
            organization: Organization::Pipelined,
            pipelining: self.pipelining.if_deep(),
            ..HardwareConfig::default()
        }
    }
}

impl Rules for PipelinedDesign<'_> {
    fn unit(&self) -> Unit {
        Unit {
            name: Organization::Pipelined.unit_name(),
            module: "rpu",
            count: self.regions(),
            regions: 1,
            rpu_in_rcm: true,
            split: "rpu",
        }
    }

    fn lone_unit(&self) -> Design {
        self.design().clone()
    }

    fn timing(&self) -> Timing {
        PipelinedTiming::of(*self).answers()
    }

    fn rpu_ports(&self) -> Vec<Port> {
        ports::rpu(self)
    }

    fn rcm_ports(&self) -> Vec<Port> {
        ports::rcm(self)
    }
}
