// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mismatch in terms of the vectors: every port that differs, with its place and time.

use crate::comparison::PortDifference;
use crate::core_activity::{CoreActivity, core_activities};
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::mismatch_region;
use crate::recording::Recording;
use foveate_design::{Design, PortRole};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The first output that differs, and the other ports that differ until the end of its sequence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mismatch {
    /// The name of the sequence of frames.
    pub sequence: String,
    /// The index of the frame in the sequence that was entering, from 0.
    pub frame: u64,
    /// The clock edge, counted from the first edge of the run.
    pub clock: u64,
    /// The clock edge, counted from the first edge of the frame.
    pub clock_in_frame: u64,
    /// The region; `None` if a single RPU gets generated pixels.
    pub region: Option<u32>,
    /// The output port.
    pub port: String,
    /// The score at the ports of a serial array, if the port belongs to a score: the name of a
    /// feature, or `temporal count`.
    pub score: Option<String>,
    /// The activity of the hardware: the pixel that enters, or the slot, phase and step of its
    /// work.
    #[serde(rename = "at")]
    pub activity: String,
    /// The value of the model, in hexadecimal.
    pub expected: String,
    /// The value of the simulator, in hexadecimal; unknown digits are `x`.
    #[serde(rename = "got")]
    pub actual: String,
    /// The ports that differ before the sequence ends, each at its first clock. Ports that differ
    /// at the same clock are in the order of the module. The first one is that of the fields above.
    pub ports: Vec<PortMismatch>,
}

/// The first clock at which a port differs. The fields are those of [`Mismatch`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "they are those of Mismatch")]
pub struct PortMismatch {
    pub port: String,
    pub clock: u64,
    pub region: Option<u32>,
    pub score: Option<String>,
    #[serde(rename = "at")]
    pub activity: String,
    pub expected: String,
    #[serde(rename = "got")]
    pub actual: String,
}

impl Mismatch {
    /// Returns the mismatch for the differences of one sequence, which are in order, or `None` if
    /// there are none.
    pub(crate) fn from_differences(
        differences: &[PortDifference],
        design: &Design,
        recording: &Recording,
        level: CosimLevel,
    ) -> Result<Option<Self>, CosimError> {
        let clocks: Vec<u64> = differences.iter().map(|difference| difference.clock).collect();
        let moments = core_activities(design, recording, &clocks)?;
        let named = |(difference, moment): (&PortDifference, &CoreActivity)| {
            port_mismatch(difference, moment, design, recording, level)
        };
        let ports: Vec<PortMismatch> =
            differences.iter().zip(&moments).map(named).collect::<Result<_, _>>()?;
        let Some(first) = ports.first().cloned() else { return Ok(None) };
        let span = recording.span(first.clock);
        let PortMismatch { port, clock, region, score, activity, expected, actual } = first;
        let sequence = span.map_or_else(String::new, |span| span.sequence.clone());
        let frame = span.map_or(0, |span| span.frame);
        let clock_in_frame = clock - span.map_or(0, |span| span.first_clock);
        #[rustfmt::skip]
        let mismatch = Self {
            sequence, frame, clock, clock_in_frame, region, port, score, activity, expected, actual, ports,
        };
        Ok(Some(mismatch))
    }
}

fn port_mismatch(
    difference: &PortDifference,
    moment: &CoreActivity,
    design: &Design,
    recording: &Recording,
    level: CosimLevel,
) -> Result<PortMismatch, CosimError> {
    let PortDifference { clock, port, expected, got, .. } = difference.clone();
    let record = recording.expected_at(clock)?;
    let first = recording.span(clock).and_then(|span| span.region);
    let layout = recording.outputs();
    let region =
        mismatch_region::region_of_difference(design, level, layout, &record, difference, first);
    let role = layout.fields().iter().find(|field| field.port.name == port).map(|f| f.port.role);
    let is_score = matches!(
        role,
        Some(
            PortRole::ScoreValid
                | PortRole::ScoreIndex
                | PortRole::Region
                | PortRole::AnyScore
                | PortRole::DisplacementX
                | PortRole::DisplacementY
        )
    );
    let score = moment.score().filter(|_| is_score).map(str::to_owned);
    Ok(PortMismatch {
        port,
        clock,
        region,
        score,
        activity: moment.to_string(),
        expected,
        actual: got,
    })
}

impl fmt::Display for PortMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { port, clock, region, score, activity, expected, actual } = self;
        write!(f, "clock {clock}: {port}")?;
        if let Some(score) = score {
            write!(f, " ({score})")?;
        }
        if let Some(region) = region {
            write!(f, ", region {region},")?;
        }
        write!(f, " is 'h{actual}, expected 'h{expected}; {activity}")
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { sequence, frame, clock, clock_in_frame, region, port, .. } = self;
        write!(f, "sequence \"{sequence}\", frame {frame}, clock {clock_in_frame} of it")?;
        write!(f, " ({clock} of the run)")?;
        if let Some(region) = region {
            write!(f, ", region {region}")?;
        }
        write!(f, ": {port}")?;
        if let Some(score) = &self.score {
            write!(f, " ({score})")?;
        }
        write!(f, " is 'h{}, expected 'h{}", self.actual, self.expected)
    }
}
