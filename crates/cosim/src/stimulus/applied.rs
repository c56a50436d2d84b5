// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is at the inputs of a design of any organization at one edge, and its record.

use super::kinds::Kinds;
use crate::layout::Layout;
use foveate_design::PortRole;
use foveate_model::{RasterInput, RcmInput, SerialInput, Thresholds};

/// What is applied at one edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Applied<'a> {
    pub(crate) reset: bool,
    pub(crate) valid: bool,
    /// Whether it is the first of a frame, where that is a port.
    pub(crate) sof: bool,
    /// One pixel per lane, or those of a word.
    pub(crate) pixels: &'a [u16],
    /// The sides of the region at the frame's border, where that is a port.
    pub(crate) border: u8,
    /// Whether the word below is a reference, where these are ports.
    pub(crate) reference_valid: bool,
    pub(crate) reference_pixels: &'a [u16],
    /// Whether the sink takes what leaves, where that is a port.
    pub(crate) forward_ready: bool,
    pub(crate) thresholds: Thresholds,
}

impl<'a> Applied<'a> {
    /// A pixel for every lane.
    pub(crate) fn valid(pixels: &'a [u16], thresholds: &Thresholds) -> Self {
        Self { valid: true, ..Self::idle(pixels, thresholds) }
    }

    /// No pixel, whatever the pixel port shows.
    pub(crate) fn idle(pixels: &'a [u16], thresholds: &Thresholds) -> Self {
        let thresholds = *thresholds;
        Self {
            reset: false,
            valid: false,
            sof: false,
            pixels,
            border: 0,
            reference_valid: false,
            reference_pixels: &[],
            forward_ready: true,
            thresholds,
        }
    }

    /// To an array of RPUs.
    pub(crate) fn of_rpus(&self) -> RcmInput<'_> {
        let &Self { reset, valid, sof, pixels, ref thresholds, .. } = self;
        RcmInput { reset, valid, sof, pixels, thresholds }
    }

    /// To a serial array.
    pub(crate) fn of_array(&self) -> SerialInput<'_> {
        let &Self { reset, valid, sof, pixels, ref thresholds, .. } = self;
        SerialInput { reset, valid, sof, pixels, thresholds }
    }

    /// To a raster core.
    pub(crate) fn of_core(&self) -> RasterInput<'_> {
        let &Self { reset, valid, sof, pixels, forward_ready, ref thresholds, .. } = self;
        let &Self { reference_valid, reference_pixels, .. } = self;
        RasterInput {
            reset,
            valid,
            sof,
            pixels,
            reference_valid,
            reference_pixels,
            forward_ready,
            thresholds,
        }
    }

    pub(crate) fn write(&self, kinds: &Kinds, layout: &Layout, record: &mut [u8]) {
        for field in layout.fields() {
            let value = match field.port.role {
                PortRole::Reset => self.reset.into(),
                PortRole::Valid => self.valid.into(),
                PortRole::StartOfFrame => self.sof.into(),
                PortRole::Border => self.border.into(),
                PortRole::ReferenceValid => self.reference_valid.into(),
                PortRole::ForwardReady => self.forward_ready.into(),
                PortRole::Level(kind) => self.thresholds.level[kinds.index(kind)].into(),
                PortRole::MinScore(kind) => self.thresholds.min_score[kinds.index(kind)],
                PortRole::TemporalLevel => self.thresholds.temporal_level.into(),
                PortRole::TemporalMinCount => self.thresholds.temporal_min_count.into(),
                PortRole::Pixel => {
                    field.set_words(record, self.pixels);
                    continue;
                }
                PortRole::ReferencePixel => {
                    field.set_words(record, self.reference_pixels);
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
                | PortRole::SyncError
                | PortRole::ReferenceReady
                | PortRole::StoreValid
                | PortRole::StorePixel
                | PortRole::StoreLast
                | PortRole::Underrun
                | PortRole::ScoreValid
                | PortRole::ScoreIndex
                | PortRole::Region
                | PortRole::AnyScore
                | PortRole::ForwardPosition
                | PortRole::ForwardSlot
                | PortRole::ForwardRegion
                | PortRole::ForwardFirst
                | PortRole::ForwardLast
                | PortRole::ForwardAbort
                | PortRole::ForwardFrame
                | PortRole::Lost
                | PortRole::LostCount
                | PortRole::LostValid
                | PortRole::LostRegion
                | PortRole::LostFrame => continue,
            };
            field.set(record, 0, value);
        }
    }
}
