// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the network sees: the rendered frames of a design, and where each differs from the one before.

use crate::picture::Picture;
use crate::{InferenceError, Mapping};
use foveate_design::Design;
use foveate_engine::Engine;
use foveate_footage::{Kind, SourceFrame};
use foveate_network::{Form, Mask};

/// A design with a receiver behind it.
pub(crate) struct Camera {
    engine: Engine,
    picture: Picture,
    /// From which every image of a set begins.
    black: Option<Picture>,
    /// Frames so far.
    frames: u64,
}

/// A frame as the network sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<'a> {
    /// From 0.
    pub(crate) number: u64,
    pub(crate) name: &'a str,
    pub(crate) time_us: u64,
    pub(crate) values: &'a [f32],
    pub(crate) changed: &'a Mask,
    pub(crate) active_regions: u64,
    pub(crate) changed_regions: u64,
}

impl Camera {
    pub(crate) fn new(design: &Design, input: &Form, mapping: &Mapping, kind: Kind) -> Self {
        let picture = Picture::new(design, input, mapping);
        let black = (kind == Kind::Set).then(|| picture.clone());
        Self { engine: Engine::new(design), picture, black, frames: 0 }
    }

    /// The picture before the first frame.
    pub(crate) fn black(&self) -> Option<&[f32]> {
        self.black.as_ref().map(|picture| &picture.values[..])
    }

    /// Shows the design another frame.
    pub(crate) fn see<'a>(
        &'a mut self,
        frame: &'a SourceFrame,
    ) -> Result<Seen<'a>, InferenceError> {
        if let Some(black) = &self.black {
            self.engine.reset();
            self.picture.clone_from(black);
        }
        self.engine.step_raster(&frame.frame)?;
        self.picture.show(self.engine.rendered());
        self.frames += 1;
        let active = self.engine.outcome().active.iter().filter(|&&active| active).count();
        Ok(Seen {
            number: self.frames - 1,
            name: &frame.name,
            time_us: frame.time_us,
            values: &self.picture.values,
            changed: &self.picture.changed,
            active_regions: active as u64,
            changed_regions: self.picture.changed_regions as u64,
        })
    }
}

/// A frame that is kept.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    number: u64,
    name: String,
    time_us: u64,
    values: Vec<f32>,
    changed: Mask,
    active_regions: u64,
    changed_regions: u64,
}

impl Kept {
    pub(crate) fn of(seen: Seen<'_>) -> Self {
        Self {
            number: seen.number,
            name: seen.name.to_owned(),
            time_us: seen.time_us,
            values: seen.values.to_vec(),
            changed: seen.changed.clone(),
            active_regions: seen.active_regions,
            changed_regions: seen.changed_regions,
        }
    }

    pub(crate) fn seen(&self) -> Seen<'_> {
        Seen {
            number: self.number,
            name: &self.name,
            time_us: self.time_us,
            values: &self.values,
            changed: &self.changed,
            active_regions: self.active_regions,
            changed_regions: self.changed_regions,
        }
    }
}
