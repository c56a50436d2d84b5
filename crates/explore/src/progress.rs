// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stages of explorations and fits, as reports of progress.

use foveate_media::RunProgress;

/// Reports that clips are read to find their lengths, so far this number of frames.
pub(crate) fn reading_progress(frames: u64) -> RunProgress<'static> {
    RunProgress::frames(frames, None, "reading the clips")
}

/// Reports that designs run over clips: so many pairs of a clip and a design are done, of all
/// pairs.
pub(crate) fn measuring_progress(done_pairs: usize, all: usize) -> RunProgress<'static> {
    RunProgress::steps("designs over clips", done_pairs as u64, all as u64)
}

/// Reports that a design runs over a clip in front of a link, so far this number of frames.
pub(crate) fn load_progress(frames: u64) -> RunProgress<'static> {
    RunProgress::frames(frames, None, "designs in front of the link")
}

/// Reports that a network runs behind cameras, so far behind this number.
pub(crate) fn network_progress(cameras: usize) -> RunProgress<'static> {
    RunProgress::work(format!("running the network behind cameras, {cameras} so far"))
}

/// Reports that Yosys synthesizes designs: so many distinct RTLs are done, of all distinct RTLs.
pub(crate) fn synthesis_progress(done: usize, all: usize) -> RunProgress<'static> {
    RunProgress::steps("synthesizing with Yosys", done as u64, all as u64)
}

/// Reports that designs are mapped to the cells of a process: so many distinct RTLs are done, of
/// all distinct RTLs.
pub(crate) fn mapping_progress(done: usize, all: usize) -> RunProgress<'static> {
    RunProgress::steps("mapping to cells", done as u64, all as u64)
}

/// Reports that the gates of designs are simulated: so many designs are done, of all designs.
pub(crate) fn energy_progress(done: usize, all: usize) -> RunProgress<'static> {
    RunProgress::steps("simulating gates", done as u64, all as u64)
}
