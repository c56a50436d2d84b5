// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a serial design answers; see [`crate::organization`].

use super::{SerialTiming, ports::ports};
use crate::rules::{Rules, Unit};
use crate::{Design, Feed, HardwareConfig, MemoryKind, Port, Timing};
use foveate_camera::{Camera, ConfigError, in_range};

/// Smallest side of a region.
const MIN_SIDE: u32 = 4;

/// The organization as the answers to [`Rules`].
pub(crate) struct Serial;

impl Rules for Serial {
    fn unit(&self, design: &Design) -> Unit {
        Unit {
            name: self.unit_name(),
            module: "serial_lane",
            count: design.lanes(),
            regions: design.fold(),
            rpu_in_rcm: false,
            // The sequencer is as much of an array as its lanes.
            split: "rcm",
        }
    }

    fn unit_name(&self) -> &'static str {
        "lane"
    }

    fn feeds(&self) -> &'static [Feed] {
        Feed::ALL
    }

    fn memories(&self) -> &'static [MemoryKind] {
        MemoryKind::ALL
    }

    fn folds(&self) -> bool {
        true
    }

    fn hardware(
        &self,
        asked: &HardwareConfig,
        camera: &Camera,
    ) -> Result<HardwareConfig, ConfigError> {
        asked.refuse_raster_keys()?;
        let (size, regions) = (camera.region_size(), camera.regions());
        if size < MIN_SIDE {
            let remedy = format!("use {MIN_SIDE}..=64, or \"pipelined\"");
            return Err(asked.clash("region.size", size.to_string(), &remedy));
        }
        let why = format!(" (the frame has {regions} regions); fold = {regions} makes one lane");
        in_range("hardware.fold", asked.fold, 1..=regions, &why)?;
        Ok(HardwareConfig {
            feed: Some(asked.feed.unwrap_or_default()),
            pipelining: asked.deep_pipelining(),
            ..asked.clone()
        })
    }

    fn lone_unit(&self, design: &Design) -> Design {
        design.one_lane()
    }

    fn timing(&self, design: &Design) -> Timing {
        SerialTiming::of(design).answers()
    }

    fn rpu_ports(&self, design: &Design) -> Vec<Port> {
        ports(&design.one_lane())
    }

    fn rcm_ports(&self, design: &Design) -> Vec<Port> {
        ports(design)
    }
}
