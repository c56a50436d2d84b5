// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison: every clip goes through the cameras, and then through the codecs at equal
//! quality.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use foveate_design::Config;
use foveate_footage::{InputOptions, Subject, subjects};
use foveate_simulator::{BatchHooks, BatchProgress};
use foveate_staging::{FolderKind, ScratchFolder, StagedFolder};
use foveate_toolchain::{Tool, Toolchain};

use crate::clip::{Measured, Seen, watch};
use crate::encoder::{check_encoders, scratch};
use crate::figures::per_second;
use crate::report::{FORMAT_VERSION, QUANTIZER};
use crate::search::coarsest;
use crate::{
    Cameras, ClipReport, Codec, Effort, Encoded, Encoder, Figures, LinkError, LinkReport, Point,
    Quality, SenderReport, Timeline, Unit, files,
};
use foveate_design::DECISION_BITS;

/// The request of a comparison.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The clips. Image files together are one clip; every other input is a clip of its own.
    pub inputs: &'a [PathBuf],
    /// The options for reading the clips.
    pub input: &'a InputOptions,
    /// The design.
    pub config: &'a Config,
    /// The codecs, in the order of the table.
    pub codecs: &'a [Codec],
    /// The preset of the encoders.
    pub effort: Effort,
    /// The rate of the link in bits per second.
    pub link: u64,
    /// The clock of the array in Hz. Without it the array takes no time, and the report states the
    /// clocks that are left out.
    pub clock_hz: Option<u64>,
}

/// Compares the senders and writes `output`, which appears at the end.
///
/// # Errors
/// Fails if an input cannot be read or is not a clip, ffmpeg is missing or fails, the folder cannot
/// be written, or `hooks` cancels; nothing is written then.
pub fn compare(
    request: &Request<'_>,
    tools: &Toolchain,
    output: &Path,
    overwrite: bool,
    hooks: &dyn BatchHooks,
) -> Result<LinkReport, LinkError> {
    let staging = StagedFolder::new(output, LINK, overwrite)?;
    let subjects = subjects(request.inputs, request.input)?;
    let ffmpeg = tools.find(Tool::Ffmpeg)?.banner;
    check_encoders(tools, request.codecs)?;
    let (frames, all) = (Cell::new(0), subjects.len());
    let mut clips = Vec::new();
    for subject in &subjects {
        let done = clips.len();
        let tick = || {
            frames.set(frames.get() + 1);
            hooks.progress(BatchProgress { clips: done, all, frames: frames.get() });
            hooks.cancelled()
        };
        clips.push(one(request, tools, subject, &tick)?);
    }
    let report = LinkReport {
        format_version: FORMAT_VERSION,
        foveate_version: env!("CARGO_PKG_VERSION"),
        ffmpeg,
        effort: request.effort.name(),
        link_bits_per_second: request.link,
        clock_hz: request.clock_hz,
        clips,
    };
    files::write(&staging, &report)?;
    staging.commit()?;
    Ok(report)
}

fn one(
    request: &Request<'_>,
    tools: &Toolchain,
    subject: &Subject,
    tick: &dyn Fn() -> bool,
) -> Result<ClipReport, LinkError> {
    let place = std::env::temp_dir();
    let folder = ScratchFolder::new().map_err(scratch("make a folder in", &place))?;
    let seen = watch(subject, request.config, request.input, folder.path(), tick)?;
    let timeline = Timeline::new(&subject.name, &seen.times_us, seen.design.height())?;
    let cameras = Cameras::new(&subject.name, &seen.design, &timeline, request.clock_hz)?;
    let figures = |units: Vec<Unit>| Figures::of(units, &timeline, request.link);
    let mut senders = of_cameras(&cameras, &seen, &figures);
    let mut curves: Vec<Point> =
        seen.swept.iter().map(|measured| own_point(&seen, measured, &timeline)).collect();
    for &codec in request.codecs {
        let mut encoder = Encoder::new(tools, &seen.footage, (codec, request.effort), tick);
        for equal in Equal::ALL {
            let (quantizer, found) = equal.search(&mut encoder, codec, seen.quality)?;
            let encoded = encoder.at(quantizer)?;
            senders.push(SenderReport {
                sender: codec.name(),
                equal: Some(equal.name()),
                quantizer: Some(quantizer),
                found: Some(found),
                quality: Some(encoded.quality),
                figures: figures(cameras.codec(&encoded.packets)),
            });
        }
        for &quantizer in codec.steps() {
            encoder.at(quantizer)?;
        }
        curves.extend(encoder.known().iter().map(|known| codec_point(codec, known, &timeline)));
    }
    Ok(ClipReport {
        name: subject.name.clone(),
        inputs: seen.inputs,
        problem: seen.problem,
        design: seen.design.fingerprint(),
        width: seen.design.width(),
        height: seen.design.height(),
        frames: timeline.frames(),
        duration_ns: timeline.end(),
        array_clocks: cameras.own_clocks(),
        needed_clock_hz: cameras.needed_clock_hz(),
        senders,
        curves,
    })
}

fn of_cameras(
    cameras: &Cameras<'_>,
    seen: &Seen,
    figures: &dyn Fn(Vec<Unit>) -> Figures,
) -> Vec<SenderReport> {
    let row = |sender, quality, units| SenderReport {
        sender,
        equal: None,
        quantizer: None,
        found: None,
        quality,
        figures: figures(units),
    };
    let own = Some(seen.quality);
    let by_rows = cameras.region_by_rows(&seen.sent);
    by_rows
        .map(|units| row("region by rows", own, units))
        .into_iter()
        .chain([
            row("region array", own, cameras.region_array(&seen.sent)),
            row("pixel events", None, cameras.pixel(&seen.sent)),
            row("raw", Some(Quality::IDENTICAL), cameras.raw()),
        ])
        .collect()
}

/// The figure in which a codec must equal the region camera.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Equal {
    Psnr,
    Ssim,
}

impl Equal {
    const ALL: [Self; 2] = [Self::Psnr, Self::Ssim];

    fn name(self) -> &'static str {
        match self {
            Self::Psnr => "psnr",
            Self::Ssim => "ssim",
        }
    }

    /// Finds the coarsest quantizer that is at least as good as the region camera, or returns the
    /// finest one if none is. Also returns which case it is: `finest`, `coarsest` or `equal`.
    fn search(
        self,
        encoder: &mut Encoder<'_>,
        codec: Codec,
        own: Quality,
    ) -> Result<(u32, &'static str), LinkError> {
        let range = codec.quantizers();
        let found = coarsest(range.clone(), |quantizer| {
            let quality = encoder.at(quantizer)?.quality;
            Ok::<_, LinkError>(match self {
                Self::Psnr => quality.has_psnr_of(own),
                Self::Ssim => quality.has_ssim_of(own),
            })
        })?;
        Ok(match found {
            None => (*range.start(), "finest"),
            Some(quantizer) if quantizer == *range.end() => (quantizer, "coarsest"),
            Some(quantizer) => (quantizer, "equal"),
        })
    }
}

fn own_point(seen: &Seen, measured: &Measured, timeline: &Timeline) -> Point {
    let map = DECISION_BITS * u64::from(seen.design.regions()) * timeline.frames();
    let bits = map + measured.pixels * u64::from(seen.design.pixel_bits());
    Point {
        sender: "region",
        knob: measured.swept.key,
        value: measured.swept.value,
        bytes_per_second: per_second(bits, timeline.end()),
        quality: measured.quality,
    }
}

fn codec_point(
    codec: Codec,
    (&quantizer, encoded): (&u32, &Encoded),
    timeline: &Timeline,
) -> Point {
    Point {
        sender: codec.name(),
        knob: QUANTIZER,
        value: quantizer.into(),
        bytes_per_second: per_second(8 * encoded.packets.iter().sum::<u64>(), timeline.end()),
        quality: encoded.quality,
    }
}

/// The kind of folder that a comparison writes, and the only kind that it replaces.
pub const LINK: FolderKind =
    FolderKind { what: "a comparison of links (its link.json)", is: is_link };

fn is_link(folder: &Path) -> bool {
    folder.join("link.json").is_file()
}
