// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is at the inputs of a design of any organization at one edge, and its record.

use super::kinds::Kinds;
use crate::layout::Layout;
use foveate_design::PortRole;
use foveate_model::{SerialInput, Thresholds};

/// What is applied at one edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Applied<'a> {
    pub(crate) reset: bool,
    pub(crate) valid: bool,
    /// One pixel per lane.
    pub(crate) pixels: &'a [u16],
    /// The sides of the region at the frame's border, where that is a port.
    pub(crate) border: u8,
    pub(crate) thresholds: Thresholds,
}

impl<'a> Applied<'a> {
    /// A pixel for every lane.
    pub(crate) fn valid(pixels: &'a [u16], thresholds: &Thresholds) -> Self {
        Self { valid: true, ..Self::idle(pixels, thresholds) }
    }

    /// No pixel, whatever the pixel port shows.
    pub(crate) fn idle(pixels: &'a [u16], thresholds: &Thresholds) -> Self {
        Self { reset: false, valid: false, pixels, border: 0, thresholds: *thresholds }
    }

    /// To a serial array.
    pub(crate) fn of_array(&self) -> SerialInput<'_> {
        let &Self { reset, valid, pixels, ref thresholds, .. } = self;
        SerialInput { reset, valid, pixels, thresholds }
    }

    pub(crate) fn write(&self, kinds: &Kinds, layout: &Layout, record: &mut [u8]) {
        for field in layout.fields() {
            let value = match field.port.role {
                PortRole::Reset => self.reset.into(),
                PortRole::Valid => self.valid.into(),
                PortRole::Border => self.border.into(),
                PortRole::Level(kind) => self.thresholds.level[kinds.index(kind)].into(),
                PortRole::MinScore(kind) => self.thresholds.min_score[kinds.index(kind)],
                PortRole::TemporalLevel => self.thresholds.temporal_level.into(),
                PortRole::TemporalMinCount => self.thresholds.temporal_min_count.into(),
                PortRole::Pixel => {
                    field.set_all(record, self.pixels.iter().map(|&pixel| pixel.into()));
                    continue;
                }
                // The clock, which is in no record, and outputs.
                PortRole::Clock
                | PortRole::DecisionValid
                | PortRole::Srs
                | PortRole::Trs
                | PortRole::Active
                | PortRole::Score(_)
                | PortRole::TemporalCount
                | PortRole::ForwardValid
                | PortRole::ForwardPixel
                | PortRole::Ready
                | PortRole::ScoreValid
                | PortRole::ScoreIndex
                | PortRole::Region
                | PortRole::AnyScore
                | PortRole::ForwardPosition
                | PortRole::ForwardSlot
                | PortRole::ForwardRegion => continue,
            };
            field.set(record, 0, value);
        }
    }
}
