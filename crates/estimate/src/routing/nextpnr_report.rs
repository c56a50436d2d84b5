// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report of nextpnr after a complete run.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::error::EstimateError;

/// The needed part of the report that nextpnr writes.
#[derive(Debug, Deserialize)]
pub(super) struct NextpnrReport {
    fmax: BTreeMap<String, AchievedClock>,
    utilization: BTreeMap<String, Utilization>,
    critical_paths: Vec<TimingPath>,
}

#[derive(Debug, Deserialize)]
struct AchievedClock {
    achieved: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
struct Utilization {
    used: u64,
    available: u64,
}

/// A path between clock edges, or from or to an unclocked end.
#[derive(Debug, Deserialize)]
pub(super) struct TimingPath {
    from: String,
    to: String,
    #[serde(rename = "path")]
    pub(super) steps: Vec<PathStep>,
}

/// A delay in a cell or on a wire, in nanoseconds.
#[derive(Debug, Deserialize)]
pub(super) struct PathStep {
    pub(super) delay: f64,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) net: Option<String>,
    pub(super) from: CellPin,
    pub(super) to: CellPin,
}

#[derive(Debug, Deserialize)]
pub(super) struct CellPin {
    pub(super) cell: String,
    pub(super) port: String,
}

impl PathStep {
    pub(super) fn is_wire(&self) -> bool {
        self.kind == "routing"
    }
}

impl NextpnrReport {
    pub(super) fn parse(json: &[u8]) -> Result<Self, EstimateError> {
        serde_json::from_slice(json)
            .map_err(|error| EstimateError::UnreadableReport { reason: error.to_string() })
    }

    /// Returns the clock that is reached, in MHz: the slowest one, although designs have only one
    /// clock.
    pub(super) fn fmax_mhz(&self) -> Result<f64, EstimateError> {
        let clocks = self.fmax.values().map(|clock| clock.achieved);
        let slowest = clocks.min_by(f64::total_cmp);
        slowest
            .ok_or_else(|| EstimateError::UnreadableReport { reason: "it has no clock".to_owned() })
    }

    /// Returns the used and the available number of a resource; 0 for a resource that the device
    /// lacks.
    pub(super) fn utilization_of(&self, resource: &str) -> (u64, u64) {
        self.utilization
            .get(resource)
            .map_or((0, 0), |utilization| (utilization.used, utilization.available))
    }

    /// Returns the longest path between two edges of the clock.
    pub(super) fn longest(&self) -> Option<&TimingPath> {
        let is_clocked =
            |path: &&TimingPath| ![&path.from, &path.to].iter().any(|end| end.contains("async"));
        self.critical_paths.iter().filter(is_clocked).max_by(|a, b| a.delay().total_cmp(&b.delay()))
    }
}

impl TimingPath {
    pub(super) fn delay(&self) -> f64 {
        self.steps.iter().map(|step| step.delay).sum()
    }
}
