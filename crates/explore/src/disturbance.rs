// SPDX-License-Identifier: MIT OR Apache-2.0
//! Disturbances of a clip, which cameras see while the ideal camera sees the clip itself. They act
//! on the frames at the depth of the task, and are the same on every machine.

use std::fmt;
use std::str::FromStr;

use foveate_inference::GaussianNoise;
use foveate_pixels::{ByteFrame, FrameError, convert_depth};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageFormat};

use crate::ExploreError;

/// The frames of a period of flicker, and of one rise or fall of the gain.
const FLICKER_PERIOD: f64 = 6.0;
const GAIN_FRAMES: u64 = 60;

/// A disturbance of a clip. Levels are grey levels of 8 bits, and scaled to other depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// Gaussian noise with this standard deviation, above 0; each frame has its own, as with
    /// `foveate infer --noise`.
    Noise(f64),
    /// Compression as JPEG at this quality, 1..=100.
    Jpeg(u8),
    /// The light flickers: all pixels rise and fall by so many levels, as a sine of six frames.
    Flicker(f64),
    /// A gain that rises by so many percent over 60 frames, and falls again over the next 60.
    Gain(f64),
    /// All pixels are multiplied by this factor, and clipped at white.
    Saturation(f64),
    /// Every frame is moved by up to so many pixels in both directions; pixels of the border are
    /// repeated.
    Shake(u8),
    /// The first frame again and again, with noise of this standard deviation, 0 for none. The
    /// ideal camera sees the still picture without noise.
    Still(f64),
}

impl Disturbance {
    /// The disturbances that `foveate stress` shows a design.
    pub const STANDARD: [Self; 9] = [
        Self::Noise(3.0),
        Self::Noise(8.0),
        Self::Jpeg(30),
        Self::Flicker(8.0),
        Self::Gain(50.0),
        Self::Saturation(2.0),
        Self::Shake(1),
        Self::Still(0.0),
        Self::Still(3.0),
    ];
}

impl fmt::Display for Disturbance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Noise(levels) => write!(f, "noise={levels}"),
            Self::Jpeg(quality) => write!(f, "jpeg={quality}"),
            Self::Flicker(levels) => write!(f, "flicker={levels}"),
            Self::Gain(percent) => write!(f, "gain={percent}"),
            Self::Saturation(factor) => write!(f, "saturation={factor}"),
            Self::Shake(pixels) => write!(f, "shake={pixels}"),
            Self::Still(levels) => write!(f, "still={levels}"),
        }
    }
}

impl FromStr for Disturbance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').unwrap_or((text, ""));
        let number = |range: std::ops::RangeInclusive<f64>| {
            let number = value.parse::<f64>().ok().filter(|number| range.contains(number));
            number.ok_or_else(|| {
                let (least, most) = range.into_inner();
                format!("`{name}` needs a number from {least} to {most}, for example {name}={most}")
            })
        };
        let whole = |most: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range")]
            number(1.0..=most).map(|number| number as u8)
        };
        match name {
            "noise" => number(0.1..=255.0).map(Self::Noise),
            "jpeg" => whole(100.0).map(Self::Jpeg),
            "flicker" => number(0.0..=255.0).map(Self::Flicker),
            "gain" => number(0.0..=400.0).map(Self::Gain),
            "saturation" => number(1.0..=16.0).map(Self::Saturation),
            "shake" => whole(64.0).map(Self::Shake),
            "still" => number(0.0..=255.0).map(Self::Still),
            _ => Err("expected noise=LEVELS, jpeg=QUALITY, flicker=LEVELS, gain=PERCENT, saturation=FACTOR, shake=PIXELS or \
                      still=LEVELS"
                .to_owned()),
        }
    }
}

/// The frames that the ideal camera and the other cameras see in place of a frame; `None` is the
/// frame itself.
#[derive(Debug, Default)]
pub(crate) struct FrameDisturbance {
    pub(crate) truth: Option<ByteFrame>,
    pub(crate) shown: Option<ByteFrame>,
}

pub(crate) struct ClipDisturbance {
    disturbance: Option<Disturbance>,
    clip: u64,
    first: Option<ByteFrame>,
}

impl ClipDisturbance {
    pub(crate) fn new(disturbance: Option<Disturbance>, clip: usize) -> Self {
        Self { disturbance, clip: clip as u64, first: None }
    }

    pub(crate) fn disturb(
        &mut self,
        frame: &ByteFrame,
        number: u64,
    ) -> Result<FrameDisturbance, ExploreError> {
        let Some(disturbance) = self.disturbance else { return Ok(FrameDisturbance::default()) };
        let pixels = PixelLevels::of(frame);
        let seed = unrelated_seed((self.clip << 40) ^ number);
        let shown = match disturbance {
            Disturbance::Noise(levels) => pixels.with_noise(levels, seed),
            Disturbance::Jpeg(quality) => pixels.compressed(quality)?,
            Disturbance::Flicker(levels) => {
                let phase = std::f64::consts::TAU * as_f64(number) / FLICKER_PERIOD;
                let added = levels * f64::from(pixels.max) / 255.0 * phase.sin();
                pixels.map(|pixel| pixel + added)
            }
            Disturbance::Gain(percent) => {
                let (rise, part) = (number / GAIN_FRAMES, as_f64(number % GAIN_FRAMES));
                let part = part / as_f64(GAIN_FRAMES);
                let part = if rise.is_multiple_of(2) { part } else { 1.0 - part };
                pixels.map(|pixel| pixel * (1.0 + percent / 100.0 * part))
            }
            Disturbance::Saturation(factor) => pixels.map(|pixel| pixel * factor),
            Disturbance::Shake(most) => pixels.moved(most.into(), seed),
            Disturbance::Still(levels) => {
                let first = self.first.get_or_insert_with(|| frame.clone()).clone();
                let noisy = match levels > 0.0 {
                    true => Some(PixelLevels::of(&first).with_noise(levels, seed).into_frame()?),
                    false => None,
                };
                let shown = Some(noisy.unwrap_or_else(|| first.clone()));
                return Ok(FrameDisturbance { truth: Some(first), shown });
            }
        };
        Ok(FrameDisturbance { truth: None, shown: Some(shown.into_frame()?) })
    }
}

/// The pixels of a frame.
struct PixelLevels {
    width: u32,
    height: u32,
    bits: u32,
    max: u16,
    values: Vec<u16>,
}

impl PixelLevels {
    fn of(frame: &ByteFrame) -> Self {
        let (width, height, bits) = (frame.width(), frame.height(), frame.bits());
        let max = u16::try_from((1_u32 << bits) - 1).expect("a pixel has at most 16 bits");
        Self { width, height, bits, max, values: frame.borrowed_pixels().to_words() }
    }

    fn into_frame(self) -> Result<ByteFrame, FrameError> {
        ByteFrame::from_words(self.width, self.height, self.bits, self.values)
    }

    fn with_noise(self, levels: f64, seed: u64) -> Self {
        let mut values = Vec::new();
        GaussianNoise::new(levels, self.max.into()).add(&self.values, seed, &mut values);
        Self { values, ..self }
    }

    /// Computes every pixel anew, rounded to the nearest level between black and white.
    fn map(mut self, change: impl Fn(f64) -> f64) -> Self {
        let level = |pixel: u16| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range")]
            let level = change(pixel.into()).round().clamp(0.0, self.max.into()) as u16;
            level
        };
        self.values.iter_mut().for_each(|pixel| *pixel = level(*pixel));
        self
    }

    fn moved(self, most: i64, seed: u64) -> Self {
        let mut chance = fastrand::Rng::with_seed(seed);
        let [right, down] = [0, 1].map(|_| chance.i64(-most..=most));
        let from = |at: u32, by: i64, size: u32| {
            let at = (i64::from(at) - by).clamp(0, i64::from(size) - 1);
            usize::try_from(at).expect("it is in the frame")
        };
        let width = self.width as usize;
        let pixel =
            |(x, y)| self.values[from(y, down, self.height) * width + from(x, right, self.width)];
        let places = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let values = places.map(pixel).collect();
        Self { values, ..self }
    }

    /// Compresses the frame as JPEG of 8 bits.
    fn compressed(mut self, quality: u8) -> Result<Self, ExploreError> {
        let bytes: Vec<u8> = self
            .values
            .iter()
            .map(|&pixel| u8::try_from(convert_depth(pixel, self.bits, 8)).unwrap_or(u8::MAX))
            .collect();
        let mut file = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut file, quality);
        let written = image::ImageEncoder::write_image(
            encoder,
            &bytes,
            self.width,
            self.height,
            ExtendedColorType::L8,
        );
        let read = written
            .and_then(|()| image::load_from_memory_with_format(&file, ImageFormat::Jpeg))
            .map_err(|error| ExploreError::Jpeg { reason: error.to_string() })?;
        let bits = self.bits;
        let levels = read.to_luma8().into_raw().into_iter();
        self.values = levels.map(|level| convert_depth(level.into(), 8, bits)).collect();
        Ok(self)
    }
}

/// Returns a seed whose random numbers are independent of those of neighboring numbers
/// (`SplitMix64`). With neighboring seeds the generator gives correlated numbers, and so frames
/// would have correlated noise.
fn unrelated_seed(number: u64) -> u64 {
    let sum = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (sum ^ (sum >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

#[allow(clippy::cast_precision_loss, reason = "a number of frames")]
fn as_f64(number: u64) -> f64 {
    number as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(bits: u32) -> ByteFrame {
        let pixel = |at: u32| u16::try_from((at % 16 + at / 16) * ((1 << bits) - 1) / 31).unwrap();
        ByteFrame::from_words(16, 16, bits, (0..256).map(pixel).collect()).unwrap()
    }

    /// Returns the frames that cameras see of a clip of equal frames.
    fn shown(disturbance: Disturbance, bits: u32, frames: u64) -> Vec<Vec<u16>> {
        let mut clip = ClipDisturbance::new(Some(disturbance), 0);
        let frame = |number| clip.disturb(&ramp(bits), number).unwrap().shown.unwrap();
        (0..frames).map(frame).map(|frame| frame.borrowed_pixels().to_words()).collect()
    }

    #[test]
    fn every_disturbance_is_read_as_it_is_written() {
        for disturbance in Disturbance::STANDARD {
            assert_eq!(disturbance.to_string().parse(), Ok(disturbance));
        }
        for (text, part) in
            [("noise", "noise=255"), ("jpeg=0", "1 to 100"), ("rain=3", "shake=PIXELS")]
        {
            let refused = text.parse::<Disturbance>().unwrap_err();
            assert!(refused.contains(part), "{text}: {refused}");
        }
    }

    #[test]
    fn levels_follow_from_the_amplitudes() {
        let clip = ramp(8).borrowed_pixels().to_words();
        // The sine of six frames is 0, 0.87, 0.87, 0, -0.87, -0.87.
        let flicker = shown(Disturbance::Flicker(8.0), 8, 5);
        assert_eq!((&flicker[0], &flicker[3]), (&clip, &clip));
        assert_eq!(flicker[1][0] + 7 - clip[0], 14);
        assert_eq!((clip[255], flicker[4][0], flicker[4][255]), (246, 0, 239));
        let gain = shown(Disturbance::Gain(50.0), 8, 121);
        assert_eq!((&gain[0], &gain[120]), (&clip, &clip));
        assert_eq!((clip[17], gain[60][17], gain[30][17]), (16, 24, 20));
        let bright = shown(Disturbance::Saturation(2.0), 8, 1);
        assert_eq!((bright[0][17], bright[0][255]), (32, 255));
        // At 4 bits a flicker of 17 levels is one level.
        let coarse = shown(Disturbance::Flicker(17.0), 4, 2);
        assert_eq!(coarse[1][0], 1);
    }

    #[test]
    fn shake_moves_whole_frames_and_repeats_the_border() {
        let clip = ramp(8).borrowed_pixels().to_words();
        let frames = shown(Disturbance::Shake(1), 8, 12);
        let at =
            |x: i64, y: i64| clip[usize::try_from(y.clamp(0, 15) * 16 + x.clamp(0, 15)).unwrap()];
        let mut moves = Vec::new();
        for frame in &frames {
            let moved = |(right, down): &(i64, i64)| {
                (0..256_i64).all(|place| {
                    frame[usize::try_from(place).unwrap()]
                        == at(place % 16 - right, place / 16 - down)
                })
            };
            let all = (-1..=1).flat_map(|right| (-1..=1).map(move |down| (right, down)));
            moves.push(all.into_iter().find(moved).expect("it is a move by up to a pixel"));
        }
        moves.sort_unstable();
        moves.dedup();
        assert!(moves.len() > 3, "{moves:?}");
    }

    #[test]
    fn a_still_picture_is_the_first_frame_for_both() {
        let mut clip = ClipDisturbance::new(Some(Disturbance::Still(0.0)), 0);
        let other = ByteFrame::from_words(16, 16, 8, vec![9; 256]).unwrap();
        for (number, frame) in [ramp(8), other].iter().enumerate() {
            let seen = clip.disturb(frame, number as u64).unwrap();
            for frame in [seen.truth, seen.shown] {
                let words = frame.unwrap().borrowed_pixels().to_words();
                assert_eq!(words, ramp(8).borrowed_pixels().to_words());
            }
        }
    }

    /// Cameras compare neighboring frames, so their noise must be independent.
    #[test]
    fn the_noise_of_neighboring_frames_is_independent() {
        let grey = ByteFrame::from_words(128, 128, 8, vec![128; 128 * 128]).unwrap();
        let mut clip = ClipDisturbance::new(Some(Disturbance::Noise(8.0)), 0);
        let mut noise = |number| -> Vec<f64> {
            let frame = clip.disturb(&grey, number).unwrap().shown.unwrap();
            frame.borrowed_pixels().to_words().iter().map(|&p| f64::from(p) - 128.0).collect()
        };
        let frames: Vec<Vec<f64>> = (0..4).map(&mut noise).collect();
        for (one, other) in frames.iter().zip(&frames[1..]) {
            let product: f64 = one.iter().zip(other).map(|(one, other)| one * other).sum();
            let correlation = product / (128.0 * 128.0 * 64.0);
            // The standard deviation of the correlation of 16,384 pixels is 0.008.
            assert!(correlation.abs() < 0.04, "{correlation}");
        }
    }

    #[test]
    fn jpeg_keeps_depth_and_rough_levels() {
        for bits in [4, 8, 12] {
            let clip = ramp(bits).borrowed_pixels().to_words();
            let frame = &shown(Disturbance::Jpeg(30), bits, 1)[0];
            assert_ne!((frame, bits), (&clip, 8));
            let far = clip.iter().zip(frame).map(|(one, other)| one.abs_diff(*other)).max();
            assert!(far.unwrap() <= (1 << bits) / 8, "{bits}: {far:?}");
        }
    }
}
