// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds of a design with their widths and values, and the input ports of those that are
//! no constants.

use crate::{Design, Port, PortDirection, PortRole, ThresholdSource};
use foveate_camera::RegionClass;

/// A threshold of a design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DesignThreshold {
    /// The role of the threshold, also if it is a constant.
    pub role: PortRole,
    /// The width in bits.
    pub width: u32,
    /// The value of the configuration.
    pub value: u64,
    /// Documentation in one line.
    pub doc: String,
}

impl Design {
    /// Returns the thresholds of the design: for each feature its level and its minimum score, then
    /// those of the temporal score and of summaries. In a design with zones the keen ones follow in
    /// the same order, and then the level of the summaries of regions that are off.
    #[must_use]
    pub fn thresholds(&self) -> Vec<DesignThreshold> {
        let mut list = self.class_thresholds_list(RegionClass::Normal);
        if self.zones().is_none() {
            return list;
        }
        let keen = self.class_thresholds_list(RegionClass::Keen).into_iter();
        list.extend(keen.map(|own| DesignThreshold {
            role: keen_role(own.role),
            doc: format!("in keen regions: {}", own.doc),
            ..own
        }));
        if let Some(level) = self.class_thresholds(RegionClass::Off).summary_level {
            list.push(DesignThreshold {
                role: PortRole::OffSummaryLevel,
                width: self.pixel_bits(),
                value: level.into(),
                doc: "in regions that are off: a mean that differs by more is sent again"
                    .to_owned(),
            });
        }
        list
    }

    /// Returns the thresholds of a class, in the order of [`Design::thresholds`], with the roles of
    /// normal regions.
    fn class_thresholds_list(&self, class: RegionClass) -> Vec<DesignThreshold> {
        let thresholds = self.class_thresholds(class);
        let mut list = Vec::new();
        let mut add = |role, width, value, doc: &str| {
            list.push(DesignThreshold { role, width, value, doc: doc.to_owned() });
        };
        for feature in thresholds.features {
            let kind = feature.kind();
            if let Some(level) = feature.level() {
                let doc = match kind.counts_window_hits() {
                    true => "a pixel is a hit above this",
                    false => "a pixel counts if it is farther from the mean than this",
                };
                add(PortRole::Level(kind), feature.level_bits(), level.into(), doc);
            }
            let doc = "the feature votes from this score on";
            add(PortRole::MinScore(kind), feature.score_bits(), feature.min_score(), doc);
        }
        let (level, min_count) = (thresholds.temporal_level, thresholds.min_count);
        let doc = "a pixel has changed above this difference";
        add(PortRole::TemporalLevel, self.pixel_bits(), level.into(), doc);
        let doc = "TRS from this count on";
        add(PortRole::TemporalMinCount, self.count_bits(), min_count.into(), doc);
        if let Some(level) = thresholds.summary_level {
            let doc = "a mean that differs by more is sent again";
            add(PortRole::SummaryLevel, self.pixel_bits(), level.into(), doc);
        }
        list
    }
}

/// Returns the role of the keen threshold that takes the place of this one.
#[must_use]
pub fn keen_role(role: PortRole) -> PortRole {
    match role {
        PortRole::Level(kind) => PortRole::KeenLevel(kind),
        PortRole::MinScore(kind) => PortRole::KeenMinScore(kind),
        PortRole::TemporalLevel => PortRole::KeenTemporalLevel,
        PortRole::TemporalMinCount => PortRole::KeenTemporalMinCount,
        PortRole::SummaryLevel => PortRole::KeenSummaryLevel,
        other => other,
    }
}

/// Returns the threshold inputs, which are the same for every organization. The list is empty if
/// thresholds are constants.
pub(crate) fn threshold_ports(design: &Design) -> Vec<Port> {
    match design.threshold_source() {
        ThresholdSource::Constant => Vec::new(),
        ThresholdSource::Runtime => {
            let port = |one: &DesignThreshold| {
                Port::scalar(PortDirection::Input, one.role, one.width, &one.doc)
            };
            design.thresholds().iter().map(port).collect()
        }
    }
}
