// SPDX-License-Identifier: MIT OR Apache-2.0
//! The part of the card about a clip: the clock that it needs, the latency, the buffer in front of
//! the link, and the regions that are lost without it.

use std::path::Path;

use foveate_design::Design;
use foveate_explore::link::{
    ArrayLink, ArrayLoad, ClipLoad, LinkRate, UnbufferedFigures, milliseconds_text,
};
use foveate_media::{ClipReading, ImageRelation, RunClips, RunMonitor};

use crate::args::{CheckArgs, ClockFrequency, DesignArgs, warn_about_inputs};
use crate::error::CliError;
use crate::progress::RunTerminal;

/// Returns the design for the frames of a clip, and its load over this clip.
pub(super) fn measure(
    args: &CheckArgs,
    source: &DesignArgs,
    clip: &Path,
) -> Result<(Design, ClipLoad), CliError> {
    let config = source.config()?;
    let (inputs, input) = ([clip.to_owned()], args.input.options(ImageRelation::Clip));
    let clips = RunClips::new(&inputs, &[], &config.camera, &input)?;
    if let [first, _, ..] = clips.clips() {
        return Err(CliError::Usage(format!(
            "`{}` has {} clips, and --clip takes one; name one of them, for example {}",
            clip.display(),
            clips.clips().len(),
            first.inputs[0].display()
        )));
    }
    warn_about_inputs(&inputs, &input);
    let (width, height) = clips.common_format(ClipReading::Repeated)?.size;
    let design = source.design_for_frames(width, height)?;
    let link =
        ArrayLink { bits_per_second: args.link.0, clock_hz: args.clock.map(|clock| clock.0) };
    let hooks = RunTerminal::new(args.quiet)?;
    let monitor = RunMonitor::of_frames(&hooks, None);
    let load = ClipLoad::measure((&clips, 0), &design, link, &monitor);
    hooks.progress.finish();
    Ok((design, load?))
}

/// Returns the lines of the card.
pub(super) fn clip_lines(load: &ClipLoad) -> Vec<(&'static str, String)> {
    let clip = format!(
        "{}: {} frames in {} ms, in front of a link with {}",
        load.name,
        load.frames,
        milliseconds_text(load.duration_ns),
        LinkRate(load.link_bits_per_second)
    );
    let mut lines = vec![("clip", clip), ("clip clock", clock_line(load))];
    if let Some(array) = &load.array {
        lines.push(("latency", latency_line(load, array)));
        lines.push(("buffer", buffer_line(array)));
        let unbuffered = array.unbuffered.as_ref();
        lines.extend(unbuffered.map(|own| ("without buffer", unbuffered_line(own, load.frames))));
    }
    lines
}

fn clock_line(load: &ClipLoad) -> String {
    let needed = ClockFrequency(load.needed_clock_hz);
    let result = match (load.clock_hz.map(ClockFrequency), &load.array) {
        (None, _) => String::new(),
        (Some(clock), Some(_)) => format!("; {clock} keeps up"),
        (Some(clock), None) => format!("; {clock} does not keep up"),
    };
    format!("{needed} is the slowest that keeps up{result}")
}

fn latency_line(load: &ClipLoad, array: &ArrayLoad) -> String {
    let clocks = match load.clock_hz {
        Some(_) => String::new(),
        None => format!(
            "; without --clock: at {} the array adds up to {} clocks",
            ClockFrequency(load.needed_clock_hz),
            array.added_clocks
        ),
    };
    format!(
        "at most {} ms from reading a pixel to its decision, and {} ms to the last byte behind the link{clocks}",
        milliseconds_text(array.figures.decision_ns),
        milliseconds_text(array.figures.delivery_ns.longest)
    )
}

fn buffer_line(array: &ArrayLoad) -> String {
    let bytes = array.figures.buffer_bytes;
    let rate = array.figures.bytes_per_second;
    match array.figures.overloaded {
        false => format!("{bytes} bytes in front of the link lose nothing"),
        true => format!(
            "{bytes} bytes in front of the link lose nothing of this clip, and a longer clip needs more: it has {} and the link carries less",
            LinkRate(rate.saturating_mul(8))
        ),
    }
}

fn unbuffered_line(own: &UnbufferedFigures, frames: u64) -> String {
    format!(
        "{} at {}; the link takes the last word of a row of regions at most {} ms after its oldest pixel was read",
        own.losses_text(frames),
        ClockFrequency(own.clock_hz),
        milliseconds_text(own.last_word_ns)
    )
}

/// Returns the reasons why the check fails: the clock does not keep up, or the clip ended early.
pub(super) fn failures(load: &ClipLoad) -> Vec<String> {
    let too_slow = load.clock_hz.filter(|_| load.array.is_none()).map(|clock_hz| {
        format!(
            "{} does not keep up with `{}`; use a clock of at least {}, or a design that takes fewer clocks",
            ClockFrequency(clock_hz),
            load.name,
            ClockFrequency(load.needed_clock_hz)
        )
    });
    let problem = load.problem.as_ref();
    let problem = problem.map(|problem| format!("`{}` is not complete: {problem}", load.name));
    too_slow.into_iter().chain(problem).collect()
}
