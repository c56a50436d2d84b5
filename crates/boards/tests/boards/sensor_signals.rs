// SPDX-License-Identifier: MIT OR Apache-2.0
//! The signals of a sensor for some frames, with damage, and the frames that a core must see. Both
//! are written from `docs/boards.md` and `docs/axi.md`.

use foveate_boards::{LogicLevel, PixelFormat, Sensor};
use foveate_pixels::Frame;

/// The damage of the second frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Damage {
    None,
    /// `href` and `vsync` are wrong for one edge, in lines and between them.
    Noise,
    /// A line is missing.
    LostLine,
    /// A line ends early.
    ShortLine,
    /// `href` is 0 for two edges in the middle of a line.
    SplitLine,
    /// `vsync` comes in the middle of the frame.
    EarlyVsync,
    /// The clock stops between lines.
    Stopped,
}

/// The line of the damage, and the pixel in it.
const DAMAGE_PLACE: (u32, u32) = (17, 21);
/// The number of edges between lines.
const LINE_GAP: usize = 24;
const VSYNC: usize = 60;

/// Returns frames in which a block of noise moves before a still background.
pub(crate) fn frames(width: u32, height: u32, count: u32) -> Vec<Frame> {
    let mut random = fastrand::Rng::with_seed(11);
    let make_frame = |number: u32| {
        let mut pixel = |x: u32, y: u32| {
            let inside = x.wrapping_sub(number * 7) < 16 && y.wrapping_sub(number * 4) < 16;
            let grey = if inside { random.u32(0..256) } else { x / 8 * 37 % 200 + y / 8 * 3 };
            u16::try_from(grey).unwrap()
        };
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Frame::new(width, height, 8, places.map(|(x, y)| pixel(x, y)).collect()).unwrap()
    };
    (0..count).map(make_frame).collect()
}

/// Returns the frames that the core sees.
pub(crate) fn expected_frames(frames: &[Frame], damage: Damage) -> Vec<Frame> {
    let mut expected = frames.to_vec();
    let (line, at) = (DAMAGE_PLACE.0 as usize, DAMAGE_PLACE.1 as usize);
    let (width, height) = (frames[0].width() as usize, frames[0].height() as usize);
    let lines = |frame: &Frame| -> Vec<Vec<u16>> {
        frame.pixels().chunks(width).map(<[u16]>::to_vec).collect()
    };
    let frame_of = |lines: Vec<Vec<u16>>| {
        Frame::new(frames[0].width(), frames[0].height(), 8, lines.concat()).unwrap()
    };
    let mut second = lines(&frames[1]);
    let shortened = |line: &[u16], until: usize| {
        let mut line = line[..until].to_vec();
        line.resize(width, line[until - 1]);
        line
    };
    match damage {
        Damage::None | Damage::Noise | Damage::Stopped => return expected,
        Damage::LostLine => {
            second.remove(line);
            second.push(second.last().unwrap().clone());
        }
        Damage::ShortLine => second[line] = shortened(&second[line], at),
        Damage::SplitLine => {
            let rest = second[line][at..].to_vec();
            let rest = shortened(&rest, width - at);
            second[line] = shortened(&second[line], at);
            second.insert(line + 1, rest);
            second.truncate(height);
        }
        Damage::EarlyVsync => {
            // The core sees the lines before `vsync`, with the last of them repeated, and then a
            // frame of the lines behind it.
            let behind: Vec<_> = second[line..].to_vec();
            let fill = |mut lines: Vec<Vec<u16>>| {
                lines.resize(height, lines.last().unwrap().clone());
                frame_of(lines)
            };
            expected[1] = fill(second[..line].to_vec());
            expected.insert(2, fill(behind));
            return expected;
        }
    }
    expected[1] = frame_of(second);
    expected
}

/// The wires of a sensor, with two bytes for each edge of its clock.
pub(crate) struct SensorWires<'a> {
    sensor: &'a Sensor,
    pub(crate) bytes: Vec<u8>,
    random: fastrand::Rng,
}

impl<'a> SensorWires<'a> {
    pub(crate) fn new(sensor: &'a Sensor) -> Self {
        Self { sensor, bytes: Vec::new(), random: fastrand::Rng::with_seed(3) }
    }

    fn edge(&mut self, between_frames: bool, href: bool, data: u8) {
        let vsync = between_frames == (self.sensor.vsync == LogicLevel::High);
        self.bytes.extend([u8::from(vsync) | u8::from(href) << 1, data]);
    }

    /// Adds edges without a pixel; their data is random.
    fn pause(&mut self, between_frames: bool, edges: usize) {
        for _ in 0..edges {
            let data = self.random.u8(..);
            self.edge(between_frames, false, data);
        }
    }

    fn pixel(&mut self, value: u8) {
        let other = self.random.u8(..);
        let parts = match self.sensor.format {
            PixelFormat::Byte => vec![value],
            PixelFormat::LumaFirst => vec![value, other],
            PixelFormat::LumaSecond => vec![other, value],
            PixelFormat::HighFirst => vec![value >> 4, value & 15],
            PixelFormat::LowFirst => vec![value & 15, value >> 4],
        };
        for part in parts {
            self.edge(false, true, part);
        }
    }

    /// Adds a line, with the pixels that are cropped on both sides.
    fn line(&mut self, pixels: &[u16], until: usize) {
        for _ in 0..self.sensor.left {
            self.pixel(0xAA);
        }
        for &pixel in &pixels[..until] {
            self.pixel(u8::try_from(pixel).unwrap());
        }
        if until == pixels.len() {
            (0..5).for_each(|_| self.pixel(0x55));
        }
        self.pause(false, LINE_GAP);
    }

    /// Adds a frame, with the lines that are cropped above and below it, and the gap to the next
    /// frame.
    pub(crate) fn frame(&mut self, frame: &Frame, damage: Damage, gap: usize) {
        let width = frame.width() as usize;
        let (line, at) = (DAMAGE_PLACE.0 as usize, DAMAGE_PLACE.1 as usize);
        let start = self.bytes.len();
        self.pause(true, VSYNC);
        self.pause(false, LINE_GAP);
        for _ in 0..self.sensor.top {
            self.line(&vec![0x99; width], width);
        }
        for (number, pixels) in frame.pixels().chunks(width).enumerate() {
            match damage {
                Damage::LostLine if number == line => {}
                Damage::ShortLine if number == line => self.line(pixels, at),
                Damage::SplitLine if number == line => {
                    self.line(pixels, at);
                    // Only two edges are between the parts.
                    self.bytes.truncate(self.bytes.len() - 2 * (LINE_GAP - 2));
                    self.split(&pixels[at..]);
                }
                Damage::EarlyVsync if number == line => {
                    self.pause(true, VSYNC);
                    self.pause(false, LINE_GAP);
                    for _ in 0..self.sensor.top {
                        self.line(&vec![0x99; width], width);
                    }
                    self.line(pixels, width);
                }
                Damage::Stopped if number == line => {
                    self.bytes.extend([4, 0].repeat(2000));
                    self.line(pixels, width);
                }
                _ => self.line(pixels, width),
            }
        }
        // The cropped lines below the frame would replace missing lines, and so are left out.
        if !matches!(damage, Damage::LostLine | Damage::EarlyVsync) {
            self.line(&vec![0x77; width], width);
        }
        self.pause(false, gap);
        if damage == Damage::Noise {
            self.noise(start);
        }
    }

    /// Adds the rest of a line that was cut.
    fn split(&mut self, rest: &[u16]) {
        // The second part is a line of its own, which loses the pixels that are cropped at its
        // left.
        for _ in 0..self.sensor.left {
            self.pixel(0xAA);
        }
        for &pixel in rest {
            self.pixel(u8::try_from(pixel).unwrap());
        }
        self.pause(false, LINE_GAP);
    }

    /// Makes single edges of `href` and `vsync` wrong, far apart from each other.
    fn noise(&mut self, start: usize) {
        let mut at = start + 2 * (VSYNC + 40);
        while at + 2 < self.bytes.len() {
            let bit = if self.random.bool() { 1 } else { 2 };
            // An edge next to a change is left alone, because a wrong value there would move the
            // change.
            let neighbors = [at - 4, at - 2, at, at + 2, at + 4];
            let is_constant = neighbors.iter().all(|&at| {
                self.bytes.get(at).is_some_and(|wires| wires & 3 == self.bytes[neighbors[2]] & 3)
            });
            if is_constant {
                self.bytes[at] ^= bit;
            }
            at += 2 * self.random.usize(20..120);
        }
    }
}
