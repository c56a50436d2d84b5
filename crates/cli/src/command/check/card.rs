// SPDX-License-Identifier: MIT OR Apache-2.0
//! The card: all values that follow from a configuration, in the form of its JSON.

use foveate_design::{Design, DesignConfig, DesignTiming, Hardware, Port, PortDirection};
use foveate_explore::link::ClipLoad;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

use super::array::{FoldProposal, LaneArray, ReachedFrameRate, RequiredClock};
use crate::args::{ClockFrequency, FramesPerSecond};
use crate::error::CliError;

/// All values that follow from a configuration.
#[derive(Serialize)]
pub(super) struct DesignCard {
    pub(super) format_version: u32,
    pub(super) fingerprint: String,
    pub(super) config: DesignConfig,
    pub(super) grid: RegionGrid,
    pub(super) pixel_max: u32,
    pub(super) region_pixels: u32,
    pub(super) stream: RegionStream,
    pub(super) features: Vec<FeatureRow>,
    pub(super) count_bits: u32,
    /// The lanes, for a serial design only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) array: Option<LaneArray>,
    pub(super) timing: TimingFigures,
    /// The frame rate at the given clock. It is left out if no clock is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rate: Option<ReachedFrameRate>,
    /// The clock that is needed. It is left out if a clock is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) needs: Option<RequiredClock>,
    /// The proposed fold. It is left out unless both a clock and a frame rate are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) proposal: Option<FoldProposal>,
    /// The load over a clip. It is left out if no clip is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) clip: Option<ClipLoad>,
    pub(super) rpu_ports: Vec<PortRow>,
    pub(super) rcm_ports: Vec<PortRow>,
}

#[derive(Serialize)]
pub(super) struct RegionGrid {
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) regions: u32,
}

#[derive(Serialize)]
pub(super) struct RegionStream {
    pub(super) halo: u32,
    pub(super) side: u32,
    pub(super) pixels: u32,
}

#[derive(Serialize)]
pub(super) struct FeatureRow {
    pub(super) feature: &'static str,
    pub(super) level: Option<u32>,
    pub(super) level_bits: Option<u32>,
    pub(super) min_score: u64,
    pub(super) score_max: u64,
    pub(super) score_bits: u32,
}

/// The timing figures of the organization by their names, with `phases` if it has phases.
pub(super) struct TimingFigures(pub(super) DesignTiming);

#[derive(Serialize)]
struct PhaseRow<'a> {
    phase: &'a str,
    steps: u64,
}

impl Serialize for TimingFigures {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (name, value) in self.0.figures() {
            map.serialize_entry(name, value)?;
        }
        let phases = self.0.phases().iter();
        let phases: Vec<_> =
            phases.map(|(phase, steps)| PhaseRow { phase, steps: *steps }).collect();
        if !phases.is_empty() {
            map.serialize_entry("phases", &phases)?;
        }
        map.end()
    }
}

#[derive(Serialize)]
pub(super) struct PortRow {
    pub(super) name: String,
    pub(super) direction: &'static str,
    pub(super) width: u32,
    pub(super) lanes: u32,
    pub(super) doc: String,
}

impl DesignCard {
    pub(super) fn from_design(
        design: &Design,
        clock: Option<ClockFrequency>,
        wanted: Option<FramesPerSecond>,
        clip: Option<ClipLoad>,
    ) -> Result<Self, CliError> {
        let clocks = design.timing().clocks_per_frame();
        let propose = |(clock, rate)| FoldProposal::for_design(design, rate, clock);
        Ok(Self {
            format_version: 2,
            fingerprint: design.fingerprint(),
            config: design.config(),
            grid: RegionGrid {
                columns: design.columns(),
                rows: design.rows(),
                regions: design.regions(),
            },
            pixel_max: design.pixel_max(),
            region_pixels: design.region_pixels(),
            stream: RegionStream {
                halo: design.halo(),
                side: design.stream_side(),
                pixels: design.stream_pixels(),
            },
            features: design.features().iter().map(FeatureRow::from_feature).collect(),
            count_bits: design.count_bits(),
            timing: TimingFigures(design.timing()),
            array: match design.hardware() {
                Hardware::Serial(own) => Some(LaneArray::from_design(design.with_hardware(own))),
                Hardware::Pipelined(_) | Hardware::Raster(_) => None,
            },
            rate: clock.map(|clock| ReachedFrameRate::at_clock(clock, clocks)),
            needs: clock.is_none().then(|| RequiredClock::for_frame_rate(wanted, clocks)),
            proposal: clock.zip(wanted).map(propose).transpose()?,
            clip,
            rpu_ports: design.rpu_ports().iter().map(PortRow::from_port).collect(),
            rcm_ports: design.rcm_ports().iter().map(PortRow::from_port).collect(),
        })
    }
}

impl FeatureRow {
    fn from_feature(feature: &foveate_camera::SpatialFeature) -> Self {
        Self {
            feature: feature.kind().name(),
            level: feature.level(),
            level_bits: feature.level().map(|_| feature.level_bits()),
            min_score: feature.min_score(),
            score_max: feature.score_max(),
            score_bits: feature.score_bits(),
        }
    }
}

impl PortRow {
    fn from_port(port: &Port) -> Self {
        Self {
            name: port.name.clone(),
            direction: match port.direction {
                PortDirection::Input => "input",
                PortDirection::Output => "output",
            },
            width: port.width,
            lanes: port.lanes,
            doc: port.doc.clone(),
        }
    }
}
