// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip that is read once: every camera sees its frames, and they go to a file for the codecs.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use foveate_design::{Action, Config, Design};
use foveate_engine::Engine;
use foveate_fidelity::Likeness;
use foveate_footage::{FootageError, InputOptions, Kind, Subject, open};
use foveate_frame::Plane;
use foveate_simulator::{PixelCamera, PixelEvents};

use crate::encoder::scratch;
use crate::sweep::{Swept, swept};
use crate::{Footage, LinkError, Quality, Sent};

/// The results of one clip.
pub(crate) struct Seen {
    pub(crate) inputs: Vec<String>,
    /// The reason why the clip ended early, if it did.
    pub(crate) problem: Option<String>,
    pub(crate) design: Design,
    pub(crate) times_us: Vec<u64>,
    pub(crate) sent: Vec<Sent>,
    pub(crate) quality: Quality,
    pub(crate) swept: Vec<Measured>,
    pub(crate) footage: Footage,
}

/// A swept design of a curve, and its results.
pub(crate) struct Measured {
    pub(crate) swept: Swept,
    pub(crate) pixels: u64,
    pub(crate) quality: Quality,
}

/// A camera, and the comparison of its screen with the input.
struct Watch {
    engine: Engine,
    likeness: Likeness,
}

impl Watch {
    fn new(design: &Design) -> Self {
        let likeness = Likeness::new(design.width(), design.height());
        Self { engine: Engine::new(design), likeness }
    }

    fn step(&mut self, frame: &[u8], width: u32) -> Result<&[Action], LinkError> {
        self.engine.step_u8(frame, width as usize)?;
        if let Plane::Bytes(screen) = self.engine.rendered() {
            self.likeness.add(screen, frame)?;
        }
        Ok(&self.engine.outcome().actions)
    }
}

/// Reads a clip, and writes its frames to a file in `folder`. `tick` is called for each frame, and
/// returns whether to stop.
pub(crate) fn watch(
    subject: &Subject,
    config: &Config,
    input: &InputOptions,
    folder: &Path,
    tick: &dyn Fn() -> bool,
) -> Result<Seen, LinkError> {
    let mut source = open(&subject.inputs, &config.camera, input)?;
    if source.kind() == Kind::Set {
        return Err(LinkError::Set { name: subject.name.clone() });
    }
    let (width, height) = source.size();
    let design = config.for_frames(width, height)?;
    if !design.forwards() {
        return Err(LinkError::NoPixels);
    }
    if design.pixel_bits() != 8 {
        return Err(LinkError::Depth { bits: design.pixel_bits() });
    }
    let path = folder.join("clip.gray");
    let file = File::create(&path).map_err(scratch("write", &path))?;
    let mut file = BufWriter::new(file);
    let mut camera = Watch::new(&design);
    let mut pixels = PixelCamera::new(&design, PixelEvents::default())?;
    let mut others = Vec::new();
    for swept in swept(&design.config()) {
        others.push((Watch::new(&swept.design), 0, swept));
    }
    let (mut times_us, mut sent) = (Vec::new(), Vec::new());
    while let Some(current) = source.next_frame()? {
        if tick() {
            return Err(LinkError::Cancelled);
        }
        let Plane::Bytes(frame) = current.frame.plane() else {
            return Err(LinkError::Depth { bits: current.frame.bits() });
        };
        file.write_all(frame).map_err(scratch("write", &path))?;
        let mut events = vec![0; height as usize];
        pixels.step(&current.frame.to_frame()?, |event| events[event.y as usize] += 1);
        sent.push(Sent::of(&design, camera.step(frame, width)?, events));
        for (other, pixels, _) in &mut others {
            // Only thresholds differ from the design, so the regions are the same.
            *pixels += design.values_of(other.step(frame, width)?);
        }
        times_us.push(current.time_us);
        source.give_back(current);
    }
    file.flush().map_err(scratch("write", &path))?;
    let inputs = source.inputs().to_vec();
    if times_us.is_empty() {
        return Err(FootageError::NoFrames { inputs: inputs.join(", ") }.into());
    }
    let measured = |(watch, pixels, swept): (Watch, u64, Swept)| {
        let quality = Quality::of(&watch.likeness);
        Measured { swept, pixels, quality }
    };
    let (clip, frames) = (subject.name.clone(), times_us.len() as u64);
    Ok(Seen {
        inputs,
        problem: source.problem(),
        times_us,
        sent,
        quality: Quality::of(&camera.likeness),
        swept: others.into_iter().map(measured).collect(),
        footage: Footage { clip, path, width, height, frames },
        design,
    })
}
