// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison ([`compare`]): every clip goes through the cameras, and then through the
//! codecs at equal quality. A codec gets the coarsest quantizer that is good enough
//! ([`coarsest_quantizer`]), which is found by bisection, because quality falls as the
//! quantizer rises.

use crate::link::clip::{ClipResults, SweptResult, read_clip};
use crate::link::encoder::check_encoders;
use crate::link::error::scratch_error;
use crate::link::figures::bytes_per_second;
use crate::link::report::{FORMAT_VERSION, QUANTIZER};
use crate::link::{
    ArrayResults, ClipEncoder, ClipReport, Codec, CurvePoint, EncodedClip, EncoderPreset,
    FrameTaker, LinkError, LinkFigures, LinkReport, LinkUnit, Quality, SenderCameras, SenderReport,
    Timeline, files,
};
use foveate_design::DesignConfig;
use foveate_media::{InputOptions, RunClips, RunHooks, RunMonitor};
use foveate_pixels::FramePixels;
use foveate_tools::{FolderKind, ScratchFolder, StagedFolder, Tool, Toolchain};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The request of a comparison.
#[derive(Clone, Debug)]
pub struct LinkRequest<'a> {
    /// The clips. Image files together are one clip; every other input is a clip of its own.
    pub inputs: &'a [PathBuf],
    /// The options for reading the clips.
    pub input: &'a InputOptions,
    /// The design.
    pub config: &'a DesignConfig,
    /// The codecs, in the order of the table.
    pub codecs: &'a [Codec],
    /// The preset of the encoders.
    pub preset: EncoderPreset,
    /// The rate of the link in bits per second.
    pub link_bits_per_second: u64,
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
    request: &LinkRequest<'_>,
    tools: &Toolchain,
    output: &Path,
    overwrite: bool,
    hooks: &dyn RunHooks,
) -> Result<LinkReport, LinkError> {
    let staging = StagedFolder::new(output, LINK_FOLDER, overwrite)?;
    let footage = RunClips::new(request.inputs, &[], &request.config.camera, request.input)?;
    let ffmpeg = tools.find(Tool::Ffmpeg)?.banner;
    check_encoders(tools, request.codecs)?;
    let monitor = RunMonitor::of_clips(hooks, footage.clips().len());
    let mut clips = Vec::new();
    for number in 0..footage.clips().len() {
        clips.push(compare_clip(request, tools, (&footage, number), &monitor)?);
        monitor.add_clip();
    }
    let report = LinkReport {
        format_version: FORMAT_VERSION,
        foveate_version: env!("CARGO_PKG_VERSION"),
        ffmpeg,
        effort: request.preset.name(),
        luma: request.input.luma.name(),
        link_bits_per_second: request.link_bits_per_second,
        clock_hz: request.clock_hz,
        clips,
    };
    files::write(&staging, &report)?;
    staging.commit()?;
    Ok(report)
}

fn compare_clip(
    request: &LinkRequest<'_>,
    tools: &Toolchain,
    (clips, number): (&RunClips, usize),
    monitor: &RunMonitor<'_>,
) -> Result<ClipReport, LinkError> {
    let name = &clips.clips()[number].name;
    let place = std::env::temp_dir();
    let folder = ScratchFolder::new().map_err(scratch_error("make a folder in", &place))?;
    let seen = read_clip((clips, number), request.config, folder.path(), monitor)?;
    let timeline = Timeline::new(name, &seen.times_us, seen.design.height())?;
    let cameras = SenderCameras::new(name, &seen.design, &timeline, request.clock_hz)?;
    let figures = |units: Vec<LinkUnit>| {
        LinkFigures::from_units(units, &timeline, request.link_bits_per_second)
    };
    let play = |take: &mut FrameTaker<'_>| {
        seen.grey_footage.visit_frames(monitor, &mut |pixels| take(FramePixels::Bytes(pixels)))
    };
    let array = cameras.array_results(&seen.sent, request.link_bits_per_second, play)?;
    let array_clocks = array.added_clocks;
    let mut senders = camera_reports(&cameras, array, &seen, &figures);
    let mut curves: Vec<CurvePoint> =
        seen.swept.iter().map(|measured| region_point(&seen, measured, &timeline)).collect();
    for &codec in request.codecs {
        let mut encoder =
            ClipEncoder::new(tools, &seen.grey_footage, (codec, request.preset), monitor);
        for equal in EqualFigure::ALL {
            let (quantizer, found) = equal.search(&mut encoder, codec, seen.quality)?;
            let encoded = encoder.encode_with(quantizer)?;
            senders.push(SenderReport {
                sender: codec.name(),
                equal: Some(equal.name()),
                quantizer: Some(quantizer),
                search_result: Some(found),
                quality: Some(encoded.quality),
                figures: figures(cameras.codec_units(&encoded.packets)),
                unbuffered: None,
            });
        }
        for &quantizer in codec.curve_quantizers() {
            encoder.encode_with(quantizer)?;
        }
        curves.extend(
            encoder.encoded_clips().iter().map(|known| codec_point(codec, known, &timeline)),
        );
    }
    Ok(ClipReport {
        name: name.clone(),
        inputs: seen.inputs,
        problem: seen.problem,
        design: seen.design.fingerprint(),
        width: seen.design.width(),
        height: seen.design.height(),
        frames: timeline.frames(),
        duration_ns: timeline.end_ns(),
        array_clocks,
        needed_clock_hz: cameras.needed_clock_hz(),
        senders,
        curves,
    })
}

fn camera_reports(
    cameras: &SenderCameras<'_>,
    array: ArrayResults,
    seen: &ClipResults,
    figures: &dyn Fn(Vec<LinkUnit>) -> LinkFigures,
) -> Vec<SenderReport> {
    let row = |sender, quality, units| SenderReport {
        sender,
        equal: None,
        quantizer: None,
        search_result: None,
        quality,
        figures: figures(units),
        unbuffered: None,
    };
    let array = SenderReport {
        unbuffered: array.unbuffered,
        ..row("region array", Some(seen.quality), array.units)
    };
    let own = Some(seen.quality);
    let by_rows = cameras.region_units_by_rows(&seen.sent);
    by_rows
        .map(|units| row("region by rows", own, units))
        .into_iter()
        .chain([
            array,
            row("pixel events", None, cameras.pixel_event_units(&seen.sent)),
            row("raw", Some(Quality::IDENTICAL), cameras.raw_units()),
        ])
        .collect()
}

/// The figure in which a codec must equal the region camera.
#[derive(Clone, Copy, Debug, PartialEq)]
enum EqualFigure {
    Psnr,
    Ssim,
}

impl EqualFigure {
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
        encoder: &mut ClipEncoder<'_>,
        codec: Codec,
        own: Quality,
    ) -> Result<(u32, &'static str), LinkError> {
        let range = codec.quantizers();
        let found = coarsest_quantizer(range.clone(), |quantizer| {
            let quality = encoder.encode_with(quantizer)?.quality;
            Ok::<_, LinkError>(match self {
                Self::Psnr => quality.reaches_psnr_of(own),
                Self::Ssim => quality.reaches_ssim_of(own),
            })
        })?;
        Ok(match found {
            None => (*range.start(), "finest"),
            Some(quantizer) if quantizer == *range.end() => (quantizer, "coarsest"),
            Some(quantizer) => (quantizer, "equal"),
        })
    }
}

fn region_point(seen: &ClipResults, measured: &SweptResult, timeline: &Timeline) -> CurvePoint {
    let bits = seen.design.bits_sent(timeline.frames(), measured.pixels);
    CurvePoint {
        sender: "region",
        setting: measured.swept.key,
        value: measured.swept.value,
        bytes_per_second: bytes_per_second(bits, timeline.end_ns()),
        quality: measured.quality,
    }
}

fn codec_point(
    codec: Codec,
    (&quantizer, encoded): (&u32, &EncodedClip),
    timeline: &Timeline,
) -> CurvePoint {
    CurvePoint {
        sender: codec.name(),
        setting: QUANTIZER,
        value: quantizer.into(),
        bytes_per_second: bytes_per_second(
            8 * encoded.packets.iter().sum::<u64>(),
            timeline.end_ns(),
        ),
        quality: encoded.quality,
    }
}

/// The kind of folder that a comparison writes, and the only kind that it replaces.
pub const LINK_FOLDER: FolderKind =
    FolderKind { description: "a comparison of links (its link.json)", matches: is_link };

fn is_link(folder: &Path) -> bool {
    folder.join("link.json").is_file()
}

/// Returns the largest quantizer for which `is_good` returns `true`; `None` if even the first one
/// is not good enough.
///
/// # Errors
/// Fails if `is_good` fails.
pub fn coarsest_quantizer<E>(
    quantizers: RangeInclusive<u32>,
    mut is_good: impl FnMut(u32) -> Result<bool, E>,
) -> Result<Option<u32>, E> {
    let (mut good, mut bad) = quantizers.into_inner();
    if is_good(bad)? {
        return Ok(Some(bad));
    }
    if !is_good(good)? {
        return Ok(None);
    }
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if is_good(middle)? {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Ok(Some(good))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_is_found_in_few_steps() {
        for limit in 0..=53 {
            let mut asked = 0;
            let found = coarsest_quantizer(1..=52, |quantizer| {
                asked += 1;
                Ok::<_, ()>(quantizer <= limit)
            });
            assert_eq!(found, Ok((limit > 0).then_some(limit.min(52))));
            assert!(asked <= 8, "{asked} for {limit}");
        }
        assert_eq!(coarsest_quantizer(5..=5, |_| Ok::<_, ()>(true)), Ok(Some(5)));
        assert_eq!(coarsest_quantizer(0..=9, |_| Err(7)), Err(7));
    }
}
