// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bytes and events of the region camera, compared with a camera with pixel events and with raw
//! video.
//!
//! | camera | an event | bytes |
//! | --- | --- | --- |
//! | raw video | | W * H * P / 8 per frame |
//! | region | an active region of a frame, or one whose summary is sent | 2 bits per region and frame, those of its displacement with `flow`, and P / 8 per forwarded pixel and mean |
//! | pixel | a pixel that crossed the contrast once | 4, a 32-bit word as in EVT 2.0 |
//!
//! The bits are summed over the run and rounded up to bytes once. Everything that a receiver needs
//! is counted. The two bits give the action for every region, so no addresses are sent.

use foveate_camera::Camera;
use serde::Serialize;

/// The number of bytes of one pixel event.
pub const PIXEL_EVENT_BYTES: u64 = 4;

/// The events and bytes that one kind of camera sends. Rates are rounded to tenths, and are missing
/// if no time passes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CameraTraffic {
    /// The number of events. Raw video has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events: Option<u64>,
    /// The number of events per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events_per_second: Option<f64>,
    /// The number of bytes.
    pub bytes: u64,
    /// The number of bytes per second.
    pub bytes_per_second: Option<f64>,
}

/// The comparison of the three kinds of camera.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BandwidthComparison {
    /// The time in microseconds from the first frame to the end of the last one, whose length is
    /// taken as the mean of the others. A single frame has no duration.
    pub duration_us: Option<u64>,
    /// Raw video: every pixel of every frame.
    pub raw: CameraTraffic,
    /// The region camera.
    pub region: CameraTraffic,
    /// The camera with pixel events, if they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixel: Option<CameraTraffic>,
}

/// The sums of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TrafficSums {
    pub(super) frames: u64,
    /// The number of regions that sent pixels or means.
    pub(super) events: u64,
    /// The number of pixels and means.
    pub(super) values: u64,
    pub(super) pixel_events: Option<u64>,
    /// The times of the first and of the last frame in microseconds.
    pub(super) times: Option<(u64, u64)>,
}

impl BandwidthComparison {
    pub(super) fn of(camera: &Camera, sums: &TrafficSums) -> Self {
        let duration_us = run_duration_us(sums);
        let pixels = u64::from(camera.width()) * u64::from(camera.height());
        let depth = u64::from(camera.pixel_bits());
        let raw = (sums.frames * pixels * depth).div_ceil(8);
        let region = camera.bits_sent(sums.frames, sums.values).div_ceil(8);
        Self {
            raw: CameraTraffic::of(None, raw, duration_us),
            region: CameraTraffic::of(Some(sums.events), region, duration_us),
            pixel: sums.pixel_events.map(|events| {
                CameraTraffic::of(Some(events), events * PIXEL_EVENT_BYTES, duration_us)
            }),
            duration_us,
        }
    }
}

impl CameraTraffic {
    fn of(events: Option<u64>, bytes: u64, duration_us: Option<u64>) -> Self {
        Self {
            events,
            events_per_second: events.and_then(|events| rate_per_second(events, duration_us?)),
            bytes,
            bytes_per_second: duration_us.and_then(|duration| rate_per_second(bytes, duration)),
        }
    }
}

/// Returns the time from the first frame to the end of the last one, which is as long as the mean
/// of the other frames; `None` if this is unknown.
fn run_duration_us(sums: &TrafficSums) -> Option<u64> {
    let (first, last) = sums.times?;
    let intervals = u128::from(sums.frames.checked_sub(1).filter(|&intervals| intervals > 0)?);
    let span = u128::from(last.checked_sub(first).filter(|&span| span > 0)?);
    u64::try_from((span * (intervals + 1) + intervals / 2) / intervals).ok()
}

/// Returns the rate per second, rounded to tenths in integers, so that it is the same on every
/// machine.
fn rate_per_second(amount: u64, duration_us: u64) -> Option<f64> {
    let duration = u128::from(duration_us);
    let tenths = (u128::from(amount) * 10_000_000 + duration / 2).checked_div(duration)?;
    format!("{}.{}", tenths / 10, tenths % 10).parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_frames_at_thirty_per_second_last_one_second() {
        let sums = TrafficSums { frames: 30, times: Some((0, 966_667)), ..TrafficSums::default() };
        assert_eq!(run_duration_us(&sums), Some(1_000_000));
        assert_eq!(rate_per_second(1234, 1_000_000), Some(1234.0));
        assert_eq!(rate_per_second(1, 3_000_000), Some(0.3));
        assert_eq!(run_duration_us(&TrafficSums { frames: 1, times: Some((5, 5)), ..sums }), None);
    }
}
