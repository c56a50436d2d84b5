// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip that is read once ([`read_clip`]): every camera sees its frames, and they go to a
//! file for the codecs.

use crate::link::error::scratch_error;
use crate::link::sweep::{SweptDesign, swept_designs};
use crate::link::{GreyFootage, LinkError, Quality, SentCounts};
use foveate_camera::RegionAction;
use foveate_design::{Design, DesignConfig};
use foveate_engine::Engine;
use foveate_measure::FrameSimilarity;
use foveate_media::{ClipPlayer, PlayedFrame, RunClips, RunMonitor, SourceKind};
use foveate_pixels::FramePixels;
use foveate_simulator::{PixelCamera, PixelEventOptions};
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

pub(crate) struct ClipResults {
    pub(crate) inputs: Vec<String>,
    /// The reason why the clip ended early, if it did.
    pub(crate) problem: Option<String>,
    pub(crate) design: Design,
    pub(crate) times_us: Vec<u64>,
    pub(crate) sent: Vec<SentCounts>,
    pub(crate) quality: Quality,
    pub(crate) swept: Vec<SweptResult>,
    pub(crate) grey_footage: GreyFootage,
}

/// A swept design of a curve, and its results.
pub(crate) struct SweptResult {
    pub(crate) swept: SweptDesign,
    pub(crate) pixels: u64,
    pub(crate) quality: Quality,
}

/// A camera, and the comparison of its screen with the input.
struct ComparedCamera {
    engine: Engine,
    likeness: FrameSimilarity,
}

impl ComparedCamera {
    fn new(design: &Design) -> Self {
        let likeness = FrameSimilarity::new(design.width(), design.height());
        Self { engine: Engine::new(design), likeness }
    }

    fn step(&mut self, frame: &PlayedFrame) -> Result<&[RegionAction], LinkError> {
        frame.show_to(&mut self.engine)?;
        let pixels = (self.engine.rendered(), frame.frame.borrowed_pixels());
        if let (FramePixels::Bytes(screen), FramePixels::Bytes(input)) = pixels {
            self.likeness.add(screen, input)?;
        }
        Ok(&self.engine.outcome().actions)
    }
}

/// Checks that frames follow each other, so that they have a rate.
pub(crate) fn check_order(player: &ClipPlayer, clip: &str) -> Result<(), LinkError> {
    match player.kind() {
        SourceKind::Clip => Ok(()),
        SourceKind::Set => Err(LinkError::DataSet { name: clip.to_owned() }),
    }
}

/// Checks that a design sends pixels.
pub(crate) fn check_forwarding(design: &Design) -> Result<(), LinkError> {
    if design.has_forwarding() { Ok(()) } else { Err(LinkError::NoPixels) }
}

/// Reads a clip, which is given by its number, and writes its frames to a file in `folder`.
pub(crate) fn read_clip(
    (clips, number): (&RunClips, usize),
    config: &DesignConfig,
    folder: &Path,
    monitor: &RunMonitor<'_>,
) -> Result<ClipResults, LinkError> {
    let clip = clips.clips()[number].name.clone();
    let mut player = clips.open(number)?;
    check_order(&player, &clip)?;
    let (width, height) = player.size();
    let design = config.validate_for_frames(width, height)?;
    check_forwarding(&design)?;
    if design.pixel_bits() != 8 {
        return Err(LinkError::UnsupportedDepth { bits: design.pixel_bits() });
    }
    let path = folder.join("clip.gray");
    let file = File::create(&path).map_err(scratch_error("write", &path))?;
    let mut file = BufWriter::new(file);
    let mut camera = ComparedCamera::new(&design);
    let mut pixels = PixelCamera::new(&design, PixelEventOptions::default())?;
    let mut others = Vec::new();
    for swept in swept_designs(&design.config()) {
        others.push((ComparedCamera::new(&swept.design), 0, swept));
    }
    let (mut times_us, mut sent) = (Vec::new(), Vec::new());
    for current in monitor.watch(&mut player) {
        let current = current?;
        let FramePixels::Bytes(frame) = current.frame.borrowed_pixels() else {
            return Err(LinkError::UnsupportedDepth { bits: current.frame.bits() });
        };
        file.write_all(frame).map_err(scratch_error("write", &path))?;
        let mut events = vec![0; height as usize];
        pixels.step(&current.frame.to_frame()?, |event| events[event.y as usize] += 1);
        sent.push(SentCounts::from_actions(&design, camera.step(&current)?, events));
        for (other, pixels, _) in &mut others {
            // Only thresholds differ from the design, so the regions are the same.
            *pixels += design.values_sent_per_frame(other.step(&current)?);
        }
        times_us.push(current.time_us);
    }
    file.flush().map_err(scratch_error("write", &path))?;
    let measured = |(watch, pixels, swept): (ComparedCamera, u64, SweptDesign)| {
        let quality = Quality::from_likeness(&watch.likeness);
        SweptResult { swept, pixels, quality }
    };
    let frames = times_us.len() as u64;
    Ok(ClipResults {
        inputs: player.inputs().to_vec(),
        problem: player.problem().map(str::to_owned),
        times_us,
        sent,
        quality: Quality::from_likeness(&camera.likeness),
        swept: others.into_iter().map(measured).collect(),
        grey_footage: GreyFootage { clip, path, width, height, frames },
        design,
    })
}
