// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pipelined organization: one RPU per region, one pixel per clock; see `docs/timing.md`.

mod ports;
mod timing;

pub use timing::PipelinedTiming;

use crate::rules::{Rules, Unit};
use crate::{Design, Feed, HardwareConfig, MemoryKind, Port, Timing};
use foveate_camera::{Camera, ConfigError};

/// The organization as the answers to [`Rules`].
pub(crate) struct Pipelined;

impl Rules for Pipelined {
    fn unit(&self, design: &Design) -> Unit {
        Unit {
            name: self.unit_name(),
            module: "rpu",
            count: design.regions(),
            regions: 1,
            rpu_in_rcm: true,
            split: "rpu",
        }
    }

    fn unit_name(&self) -> &'static str {
        "RPU"
    }

    fn feeds(&self) -> &'static [Feed] {
        &[]
    }

    fn memories(&self) -> &'static [MemoryKind] {
        &[]
    }

    fn folds(&self) -> bool {
        false
    }

    fn hardware(&self, asked: &HardwareConfig, _: &Camera) -> Result<HardwareConfig, ConfigError> {
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
            None | Some(Feed::Parallel) => Ok(HardwareConfig {
                feed: None,
                pipelining: asked.deep_pipelining(),
                ..asked.clone()
            }),
            Some(Feed::Raster) => {
                let remedy = "only the serial organization takes the frame row by row; \
                              leave the key out";
                Err(asked.clash("hardware.feed", format!("\"{}\"", Feed::Raster), remedy))
            }
        }
    }

    fn lone_unit(&self, design: &Design) -> Design {
        design.clone()
    }

    fn timing(&self, design: &Design) -> Timing {
        PipelinedTiming::of(design).answers()
    }

    fn rpu_ports(&self, design: &Design) -> Vec<Port> {
        ports::rpu(design)
    }

    fn rcm_ports(&self, design: &Design) -> Vec<Port> {
        ports::rcm(design)
    }
}
