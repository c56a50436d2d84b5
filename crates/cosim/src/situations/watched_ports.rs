// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports that the monitor of situations watches, and their values at a clock.

use crate::layout::{RecordField, RecordLayout};
use foveate_design::PortRole;

fn is_threshold(role: PortRole) -> bool {
    matches!(
        role,
        PortRole::Level(_)
            | PortRole::MinScore(_)
            | PortRole::TemporalLevel
            | PortRole::TemporalMinCount
            | PortRole::SummaryLevel
            | PortRole::KeenLevel(_)
            | PortRole::KeenMinScore(_)
            | PortRole::KeenTemporalLevel
            | PortRole::KeenTemporalMinCount
            | PortRole::KeenSummaryLevel
            | PortRole::OffSummaryLevel
    )
}

/// The place of a port in the records of a clock; empty if the core has no such port.
#[derive(Clone, Debug)]
pub(super) struct WatchedPort {
    field: Option<RecordField>,
    is_output: bool,
}

/// The places of all watched ports. They are found once, because a recording has millions of
/// clocks.
#[derive(Clone, Debug)]
pub(super) struct WatchedPorts {
    pub(super) any_score: WatchedPort,
    pub(super) class_commit: WatchedPort,
    pub(super) class_pending: WatchedPort,
    pub(super) class_word: WatchedPort,
    pub(super) class_write: WatchedPort,
    pub(super) decision_valid: WatchedPort,
    pub(super) displacement_x: WatchedPort,
    pub(super) displacement_y: WatchedPort,
    pub(super) forward_abort: WatchedPort,
    pub(super) forward_frame: WatchedPort,
    pub(super) forward_last: WatchedPort,
    pub(super) forward_ready: WatchedPort,
    pub(super) forward_region: WatchedPort,
    pub(super) forward_summary: WatchedPort,
    pub(super) forward_valid: WatchedPort,
    pub(super) lost_region: WatchedPort,
    pub(super) lost_valid: WatchedPort,
    pub(super) pixel: WatchedPort,
    pub(super) ready: WatchedPort,
    pub(super) region: WatchedPort,
    pub(super) region_class: WatchedPort,
    pub(super) reset: WatchedPort,
    pub(super) score_index: WatchedPort,
    pub(super) score_valid: WatchedPort,
    pub(super) srs: WatchedPort,
    pub(super) start_of_frame: WatchedPort,
    pub(super) summary: WatchedPort,
    pub(super) sync_error: WatchedPort,
    pub(super) temporal_count: WatchedPort,
    pub(super) trs: WatchedPort,
    pub(super) underrun: WatchedPort,
    pub(super) valid: WatchedPort,
    pub(super) thresholds: Vec<RecordField>,
}

impl WatchedPorts {
    pub(super) fn new(inputs: &RecordLayout, outputs: &RecordLayout) -> Self {
        let port = |role: PortRole| {
            let find = |layout: &RecordLayout| {
                layout.fields().iter().find(|field| field.port.role == role).cloned()
            };
            match find(outputs) {
                Some(field) => WatchedPort { field: Some(field), is_output: true },
                None => WatchedPort { field: find(inputs), is_output: false },
            }
        };
        let thresholds = inputs.fields().iter().filter(|field| is_threshold(field.port.role));
        Self {
            any_score: port(PortRole::AnyScore),
            class_commit: port(PortRole::ClassCommit),
            class_pending: port(PortRole::ClassPending),
            class_word: port(PortRole::ClassWord),
            class_write: port(PortRole::ClassWrite),
            decision_valid: port(PortRole::DecisionValid),
            displacement_x: port(PortRole::DisplacementX),
            displacement_y: port(PortRole::DisplacementY),
            forward_abort: port(PortRole::ForwardAbort),
            forward_frame: port(PortRole::ForwardFrame),
            forward_last: port(PortRole::ForwardLast),
            forward_ready: port(PortRole::ForwardReady),
            forward_region: port(PortRole::ForwardRegion),
            forward_summary: port(PortRole::ForwardSummary),
            forward_valid: port(PortRole::ForwardValid),
            lost_region: port(PortRole::LostRegion),
            lost_valid: port(PortRole::LostValid),
            pixel: port(PortRole::Pixel),
            ready: port(PortRole::Ready),
            region: port(PortRole::Region),
            region_class: port(PortRole::RegionClass),
            reset: port(PortRole::Reset),
            score_index: port(PortRole::ScoreIndex),
            score_valid: port(PortRole::ScoreValid),
            srs: port(PortRole::Srs),
            start_of_frame: port(PortRole::StartOfFrame),
            summary: port(PortRole::Summary),
            sync_error: port(PortRole::SyncError),
            temporal_count: port(PortRole::TemporalCount),
            trs: port(PortRole::Trs),
            underrun: port(PortRole::Underrun),
            valid: port(PortRole::Valid),
            thresholds: thresholds.cloned().collect(),
        }
    }
}

/// One clock: the applied inputs, and the outputs after its edge.
#[derive(Clone, Copy)]
pub(super) struct WatchedClock<'a> {
    pub(super) input: &'a [u8],
    pub(super) output: &'a [u8],
}

impl WatchedPort {
    /// Returns true if the core has the port.
    pub(super) fn exists(&self) -> bool {
        self.field.is_some()
    }

    /// Returns the number of lanes; 0 if the core has no such port.
    pub(super) fn lanes(&self) -> u32 {
        self.field.as_ref().map_or(0, |field| field.port.lanes)
    }
}

impl WatchedClock<'_> {
    fn record(&self, port: &WatchedPort) -> &[u8] {
        if port.is_output { self.output } else { self.input }
    }

    pub(super) fn lane(&self, port: &WatchedPort, lane: u32) -> u64 {
        port.field.as_ref().map_or(0, |field| field.get(self.record(port), lane))
    }

    pub(super) fn value(&self, port: &WatchedPort) -> u64 {
        self.lane(port, 0)
    }

    pub(super) fn is_high(&self, port: &WatchedPort) -> bool {
        let is_high =
            |field: &RecordField| field.bytes_in(self.record(port)).iter().any(|&byte| byte != 0);
        port.field.as_ref().is_some_and(is_high)
    }

    pub(super) fn bit(&self, port: &WatchedPort, lane: u32) -> bool {
        self.lane(port, lane) == 1
    }
}
