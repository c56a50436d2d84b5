// SPDX-License-Identifier: MIT OR Apache-2.0
//! The first difference on the buses, as a mismatch.

use super::port_record::BusViolation;
use crate::mismatch::{Mismatch, PortMismatch};
use std::fmt::LowerHex;

/// The port on which packets leave.
pub(super) const PACKETS: &str = "m_axis_packets";

/// A difference between what a core showed on its buses and what it had to show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BusMismatch {
    pub(super) clock: u64,
    /// The number of the frame in its packets.
    pub(super) frame: u64,
    pub(super) region: Option<u32>,
    pub(super) port: String,
    /// The subject of the comparison, in words.
    pub(super) subject: String,
    pub(super) expected: String,
    pub(super) got: String,
}

impl BusMismatch {
    /// Makes a difference between two numbers on the packet port.
    pub(super) fn from_numbers(
        at: impl Into<String>,
        expected: impl LowerHex,
        got: impl LowerHex,
    ) -> Self {
        Self {
            clock: 0,
            frame: 0,
            region: None,
            port: PACKETS.to_owned(),
            subject: at.into(),
            expected: format!("{expected:x}"),
            got: format!("{got:x}"),
        }
    }

    /// Makes a difference about something that is missing (`must` is true) or must not be there
    /// (`must` is false); the numbers are 1 for present and 0 for absent.
    pub(super) fn from_presence(at: impl Into<String>, must: bool) -> Self {
        Self::from_numbers(at, u8::from(must), u8::from(!must))
    }

    pub(super) fn with_region(self, region: u32) -> Self {
        Self { region: Some(region), ..self }
    }

    /// Converts the difference to a mismatch of the scene `scene`.
    pub(super) fn into_mismatch(self, scene: &str) -> Mismatch {
        let Self { clock, frame, region, port, subject: at, expected, got } = self;
        let one = PortMismatch {
            port: port.clone(),
            clock,
            region,
            score: None,
            activity: at.clone(),
            expected: expected.clone(),
            actual: got.clone(),
        };
        Mismatch {
            sequence: scene.to_owned(),
            frame,
            clock,
            clock_in_frame: clock,
            region,
            port,
            score: None,
            activity: at,
            expected,
            actual: got,
            ports: vec![one],
        }
    }
}

impl From<&BusViolation> for BusMismatch {
    fn from(breach: &BusViolation) -> Self {
        let BusViolation { clock, port, message: what } = breach.clone();
        Self { clock, port, ..Self::from_presence(what, false) }
    }
}
