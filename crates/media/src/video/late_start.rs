// SPDX-License-Identifier: MIT OR Apache-2.0
//! A late start in a long video without decoding everything before it. It is used only where it
//! gives the same frames with the same times, bit for bit:
//!
//! * in MP4 and Matroska, which store the time of every frame. In other containers times are
//!   counted from the beginning, or guessed;
//! * where decoding starts with a frame on whose predecessors no later frame depends: any frame of
//!   an intra-only codec, an IDR picture of H.264, an IRAP picture of H.265. Streams that refresh
//!   their picture gradually have no such frame.
//!
//! All other videos are decoded from the beginning, and the frames before the start are dropped,
//! which is always right.

use super::decoder::{DecodingParameters, StartPosition, VideoDecoder};
use super::probe::VideoProperties;
use crate::FootageError;
use foveate_tools::Toolchain;
use std::time::Duration;

/// The earliest start, in microseconds, for which a seek pays. Before it, decoding from the
/// beginning takes no longer than the test whether a seek is exact.
const MIN_SEEK_US: u64 = 3_000_000;

/// The time in microseconds by which decoding starts earlier, since the beginnings of a file and of
/// its video may differ a little.
const MARGIN_US: u64 = 1_000_000;

/// The time limit for finding a position in a file.
const LIMIT: Duration = Duration::from_secs(60);

/// A decoder that is positioned before the first frame that is needed, and the time of the first
/// frame of the video.
pub(super) struct SeekResult {
    pub(super) decoder: VideoDecoder,
    pub(super) first_pts: i64,
}

/// Returns a decoder near `start_us`, or `None` if decoding from the beginning is faster or the
/// seek is not exact.
pub(super) fn start(
    tools: &Toolchain,
    ffmpeg: &DecodingParameters,
    probe: &VideoProperties,
    start_us: u64,
) -> Result<Option<SeekResult>, FootageError> {
    // Recordings that were joined have the duration of the first one, or none. In them a time is
    // that of several frames.
    let is_within = probe.duration_s.is_some_and(|seconds| {
        Duration::try_from_secs_f64(seconds).is_ok_and(|all| all > Duration::from_micros(start_us))
    });
    if start_us < MIN_SEEK_US || !knows_times(&probe.container) || !is_within {
        return Ok(None);
    }
    let place = start_us - MARGIN_US;
    let place = format!("{}.{:06}", place / 1_000_000, place % 1_000_000);
    if !starts_cleanly(tools, ffmpeg, &probe.codec, StartPosition::SeekTo(&place))? {
        return Ok(None);
    }
    let first = VideoDecoder::start(ffmpeg, StartPosition::BeginningWithContainerTimes)?.peek()?;
    let Some(first_pts) = first.and_then(|first| first.pts) else { return Ok(None) };
    let mut decoder = VideoDecoder::start(ffmpeg, StartPosition::SeekTo(&place))?;
    // A position that is too late would lose frames. No frame at all may be the end of the video,
    // or a fault.
    let early = decoder.peek()?.and_then(|shown| shown.pts).is_some_and(|pts| {
        pts >= first_pts && decoder.time_us(first_pts, pts) <= i128::from(start_us)
    });
    Ok(early.then_some(SeekResult { decoder, first_pts }))
}

/// Returns true if no frame of the video depends on a frame before its beginning.
pub(super) fn begins_cleanly(
    ffmpeg: &DecodingParameters,
    codec: &str,
) -> Result<bool, FootageError> {
    let tools = Toolchain::system().with_cancel_flag(ffmpeg.interrupt.flag());
    starts_cleanly(&tools, ffmpeg, codec, StartPosition::BeginningWithOwnTimes)
}

fn knows_times(container: &str) -> bool {
    container.split(',').any(|name| ["mp4", "matroska"].contains(&name))
}

/// Returns true if no frame at or after the position where decoding starts depends on a frame
/// before it.
fn starts_cleanly(
    tools: &Toolchain,
    ffmpeg: &DecodingParameters,
    codec: &str,
    start: StartPosition<'_>,
) -> Result<bool, FootageError> {
    let (raw, clean): (&str, fn(u8) -> bool) = match codec {
        "mjpeg" | "prores" | "dnxhd" | "huffyuv" | "ffvhuff" | "utvideo" | "rawvideo" => {
            return Ok(true);
        }
        "h264" => ("h264", is_idr),
        "hevc" => ("hevc", is_irap),
        _ => return Ok(false),
    };
    let packet = ffmpeg.input(start).args(["-c", "copy", "-frames:v", "1", "-copyinkf"]);
    let packet = tools.run(&packet.args(["-f", raw, "pipe:1"]).timeout(LIMIT))?;
    Ok(packet.is_success() && first_picture(&packet.stdout, codec).is_some_and(clean))
}

/// Returns the first byte of the first unit of a packet that holds a picture.
fn first_picture(bytes: &[u8], codec: &str) -> Option<u8> {
    let starts = bytes.windows(4).filter(|window| window.starts_with(&[0, 0, 1]));
    let mut headers = starts.map(|window| window[3]);
    headers.find(|&header| match codec {
        "h264" => (1..=5).contains(&(header & 31)),
        _ => header >> 1 & 63 < 32,
    })
}

fn is_idr(header: u8) -> bool {
    header & 31 == 5
}

fn is_irap(header: u8) -> bool {
    (16..=21).contains(&(header >> 1 & 63))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_picture_of_a_packet_says_what_it_is() {
        let idr = [0, 0, 0, 1, 0x67, 9, 0, 0, 1, 0x68, 9, 0, 0, 1, 0x65, 1, 0, 0, 1, 0x41, 1];
        assert_eq!(first_picture(&idr, "h264"), Some(0x65));
        assert!(is_idr(0x65) && !is_idr(0x41));
        let recovery = [0, 0, 1, 0x06, 6, 0, 0, 1, 0x41, 1];
        assert_eq!(first_picture(&recovery, "h264"), Some(0x41));
        let clean = [0, 0, 1, 0x40, 1, 0, 0, 1, 0x2A, 1];
        assert_eq!(first_picture(&clean, "hevc"), Some(0x2A));
        assert!(is_irap(0x2A) && !is_irap(0x02));
        assert_eq!(first_picture(&[0, 0, 1], "h264"), None);
    }

    #[test]
    fn only_containers_that_know_the_times_of_frames_are_sought_in() {
        assert!(knows_times("mov,mp4,m4a,3gp,3g2,mj2") && knows_times("matroska,webm"));
        assert!(!knows_times("avi") && !knows_times("mpegts") && !knows_times(""));
    }
}
