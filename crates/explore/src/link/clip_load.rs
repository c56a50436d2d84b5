// SPDX-License-Identifier: MIT OR Apache-2.0
//! The load of one design over one clip: the clock that the generated array needs, and its figures
//! on a link, without any other sender.
//!
//! The clip is read once for the times of its frames and for the values that are sent. A raster
//! core reads it again, because its clocks depend on the times of all frames. No frame is kept.

use foveate_design::{Design, Hardware};
use foveate_engine::Engine;
use foveate_media::{ClipPlayer, FrameDepths, RunClips, RunMonitor};
use serde::{Deserialize, Serialize};

use crate::link::clip::{check_forwarding, check_order};
use crate::link::{
    FrameTaker, LinkError, LinkFigures, SenderCameras, SentCounts, Timeline, UnbufferedFigures,
};

/// The link behind an array, and the clock of the array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayLink {
    /// The rate of the link in bits per second.
    pub bits_per_second: u64,
    /// The clock of the array in Hz. Without one the array takes no time, as in [`SenderCameras`].
    pub clock_hz: Option<u64>,
}

/// The load of a design over a clip.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClipLoad {
    /// The name of the clip.
    pub name: String,
    /// The inputs as the user named them.
    pub inputs: Vec<String>,
    /// The reason why the clip ended early, if it did.
    pub problem: Option<String>,
    /// The number of frames.
    pub frames: u64,
    /// The time from the first frame to the end of the last frame, in ns.
    pub duration_ns: u64,
    /// The rate of the link in bits per second.
    pub link_bits_per_second: u64,
    /// The slowest clock in Hz at which the array keeps up with the frames.
    pub needed_clock_hz: u64,
    /// The clock of the array in Hz. Without one, the array takes no time.
    pub clock_hz: Option<u64>,
    /// The load of the array on the link; `None` if its clock does not keep up with the frames.
    pub array: Option<ArrayLoad>,
}

/// The load of an array on a link, over a clip.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArrayLoad {
    /// The most clocks that the array adds to a time after the pixels that it waits for have been
    /// read. Those of a raster core are of this clip, at the clock of the array, or without one at
    /// the slowest that keeps up.
    pub added_clocks: u64,
    /// The load on the link.
    pub figures: LinkFigures,
    /// The figures without a buffer between array and link; only for a raster core.
    pub unbuffered: Option<UnbufferedFigures>,
}

impl ClipLoad {
    /// Measures a design over a clip, which is given by its number. Frames are converted to the
    /// depth of the design. The clip must be one that can be opened twice.
    ///
    /// # Errors
    /// Fails if the clip cannot be read, has fewer than two frames, has no order or no rising
    /// times, if the design has another size or sends no pixels, or if `monitor` cancels.
    pub fn measure(
        (clips, number): (&RunClips, usize),
        design: &Design,
        link: ArrayLink,
        monitor: &RunMonitor<'_>,
    ) -> Result<Self, LinkError> {
        check_forwarding(design)?;
        let name = &clips.clips()[number].name;
        let mut player = clips.open(number)?;
        check_order(&player, name)?;
        let (times_us, sent) = read_counts(&mut player, design, monitor)?;
        let timeline = Timeline::new(name, &times_us, design.height())?;
        let cameras = |clock_hz| SenderCameras::without_rows(name, design, &timeline, clock_hz);
        let needed_clock_hz = cameras(None)?.needed_clock_hz();
        let array = match link.clock_hz.is_none_or(|clock_hz| clock_hz >= needed_clock_hz) {
            false => None,
            true => {
                let play =
                    |take: &mut FrameTaker<'_>| play_clip((clips, number), design, monitor, take);
                let rate = link.bits_per_second;
                let results = cameras(link.clock_hz)?.array_results(&sent, rate, play)?;
                Some(ArrayLoad {
                    added_clocks: results.added_clocks,
                    figures: LinkFigures::from_units(results.units, &timeline, rate),
                    unbuffered: results.unbuffered,
                })
            }
        };
        Ok(Self {
            name: name.clone(),
            inputs: player.inputs().to_vec(),
            problem: player.problem().map(str::to_owned),
            frames: timeline.frames(),
            duration_ns: timeline.end_ns(),
            link_bits_per_second: link.bits_per_second,
            needed_clock_hz,
            clock_hz: link.clock_hz,
            array,
        })
    }
}

/// Returns the times of the frames in microseconds, and the values that are sent for them, which a
/// raster core counts by itself.
fn read_counts(
    player: &mut ClipPlayer,
    design: &Design,
    monitor: &RunMonitor<'_>,
) -> Result<(Vec<u64>, Vec<SentCounts>), LinkError> {
    let mut engine = match design.hardware() {
        Hardware::Pipelined(_) | Hardware::Serial(_) => Some(Engine::new(design)),
        Hardware::Raster(_) => None,
    };
    let (mut times_us, mut sent) = (Vec::new(), Vec::new());
    for frame in monitor.watch(player) {
        let frame = frame?;
        times_us.push(frame.time_us);
        if let Some(engine) = &mut engine {
            let frames = FrameDepths::from_frame(&frame, [design.pixel_bits()])?;
            let actions = &frames.show_to(engine)?.actions;
            sent.push(SentCounts::from_actions(design, actions, Vec::new()));
        }
    }
    Ok((times_us, sent))
}

/// Reads a clip again, and gives its frames in the depth of the design to `take`.
fn play_clip(
    (clips, number): (&RunClips, usize),
    design: &Design,
    monitor: &RunMonitor<'_>,
    take: &mut FrameTaker<'_>,
) -> Result<(), LinkError> {
    let bits = design.pixel_bits();
    for frame in monitor.watch(&mut clips.open(number)?) {
        let frame = frame?;
        take(FrameDepths::from_frame(&frame, [bits])?.frame_at(bits).borrowed_pixels())?;
    }
    Ok(())
}
