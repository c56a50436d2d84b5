// SPDX-License-Identifier: MIT OR Apache-2.0
//! The place of one port in a record.

use crate::gate::ComparisonGate;
use foveate_design::Port;
use std::fmt::Write as _;

/// The number of bytes that are read at once.
const WORD: usize = size_of::<u128>();

/// The place of one port in a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordField {
    /// The port.
    pub port: Port,
    /// The offset of its first byte.
    pub offset: usize,
    /// The number of its bytes.
    pub bytes: usize,
    /// The condition under which it is compared.
    pub gate: ComparisonGate,
}

impl RecordField {
    /// Writes one lane; bits of `value` above the lane's width are dropped.
    #[inline]
    pub fn set(&self, record: &mut [u8], lane: u32, value: u64) {
        let (start, shift) = self.bit_position(lane);
        let mask = u128::from(low_bits_mask(self.port.width));
        let word = word_at(record, start) & !(mask << shift);
        let word = word | (u128::from(value) & mask) << shift;
        let rest = &mut record[start..];
        let bytes = rest.len().min(WORD);
        rest[..bytes].copy_from_slice(&word.to_le_bytes()[..bytes]);
    }

    /// Writes every lane, lane 0 first; this is faster than one lane at a time.
    #[inline]
    pub(crate) fn set_all(&self, record: &mut [u8], values: impl Iterator<Item = u64>) {
        const STEP: usize = size_of::<u64>();
        let mut rest = &mut record[self.offset..self.end()];
        let (mut waiting, mut bits) = (0u128, 0);
        for value in values.take(self.port.lanes as usize) {
            waiting |= u128::from(value & low_bits_mask(self.port.width)) << bits;
            bits += self.port.width;
            if bits >= u64::BITS {
                let (step, more) = rest.split_at_mut(STEP);
                step.copy_from_slice(&waiting.to_le_bytes()[..STEP]);
                (rest, waiting, bits) = (more, waiting >> u64::BITS, bits - u64::BITS);
            }
        }
        let bytes = (bits as usize).div_ceil(8);
        rest[..bytes].copy_from_slice(&waiting.to_le_bytes()[..bytes]);
    }

    /// Writes every lane. Each lane holds one value, or the pixels of a word with the first pixel
    /// in the lowest bits.
    ///
    /// # Panics
    /// Panics if the number of values does not fit, because the model then does not support the
    /// port.
    #[inline]
    pub(crate) fn set_values(&self, record: &mut [u8], values: &[u64]) {
        let (held, bits) = self.lane_shape(values.len());
        let lanes = self.port.lanes as usize;
        assert_eq!(values.len(), lanes * held, "{}: a value for each place", self.port.name);
        let word = |values: &[u64]| values.iter().rev().fold(0, |word, value| word << bits | value);
        self.set_all(record, values.chunks(held).map(word));
    }

    /// Reads the `count` pixels of all lanes, as `set_values` has written them.
    pub fn lane_pixels(&self, record: &[u8], count: usize) -> impl Iterator<Item = u64> {
        let (held, bits) = self.lane_shape(count);
        let lanes = (0..self.port.lanes).map(|lane| self.get(record, lane));
        let pixels = move |word: u64| {
            let next = move |left: &mut u64, _| {
                let pixel = *left & low_bits_mask(bits);
                *left = left.checked_shr(bits).unwrap_or(0);
                Some(pixel)
            };
            (0..held).scan(word, next)
        };
        lanes.flat_map(pixels)
    }

    /// Returns the number of pixels of a lane and of bits of a pixel, if all lanes together have
    /// `pixels` pixels.
    #[inline]
    fn lane_shape(&self, pixels: usize) -> (usize, u32) {
        let held = (pixels / self.port.lanes as usize).max(1);
        (held, self.port.width / u32::try_from(held).unwrap_or(u32::MAX))
    }

    /// Reads one lane.
    #[must_use]
    #[inline]
    pub fn get(&self, record: &[u8], lane: u32) -> u64 {
        let (start, shift) = self.bit_position(lane);
        let value = (word_at(record, start) >> shift) & u128::from(low_bits_mask(self.port.width));
        u64::try_from(value).expect("the mask has 64 bits")
    }

    /// Returns the bytes of the port.
    #[must_use]
    #[inline]
    pub fn bytes_in<'a>(&self, record: &'a [u8]) -> &'a [u8] {
        &record[self.offset..self.end()]
    }

    /// Returns the whole port as one hexadecimal number, with as many digits as its bits need.
    #[must_use]
    pub fn hex(&self, record: &[u8]) -> String {
        let mut digits = String::with_capacity(2 * self.bytes);
        for byte in self.bytes_in(record).iter().rev() {
            // Writing to a string cannot fail.
            let _ = write!(digits, "{byte:02x}");
        }
        let wanted = self.port.bits().div_ceil(4) as usize;
        digits.split_off(digits.len() - wanted)
    }

    #[inline]
    fn end(&self) -> usize {
        self.offset + self.bytes
    }

    /// Returns the first byte of a lane, and its first bit in that byte.
    #[inline]
    fn bit_position(&self, lane: u32) -> (usize, u32) {
        debug_assert!(lane < self.port.lanes, "lane {lane} of {}", self.port.name);
        let bit = lane * self.port.width;
        (self.offset + (bit / 8) as usize, bit % 8)
    }
}

impl ComparisonGate {
    /// Returns true if no lane of a value is compared at this clock.
    #[inline]
    pub(crate) fn is_closed(self, fields: &[RecordField], expected: &[u8]) -> bool {
        match self {
            Self::Always => false,
            Self::SameLane(valid) | Self::AnyLane(valid) => {
                fields[valid].bytes_in(expected).iter().all(|&byte| byte == 0)
            }
        }
    }

    /// Returns the number of lanes of a value that are compared at this clock.
    #[inline]
    pub(crate) fn open_lanes(self, fields: &[RecordField], expected: &[u8], all: u32) -> u32 {
        match self {
            // The valid field has one bit for each lane.
            Self::SameLane(valid) => {
                fields[valid].bytes_in(expected).iter().map(|byte| byte.count_ones()).sum()
            }
            Self::Always | Self::AnyLane(_) if self.is_closed(fields, expected) => 0,
            Self::Always | Self::AnyLane(_) => all,
        }
    }

    /// Returns true if a lane is compared at a clock at which the gate is not shut.
    #[inline]
    pub(crate) fn compares_lane(self, fields: &[RecordField], expected: &[u8], lane: u32) -> bool {
        match self {
            Self::Always | Self::AnyLane(_) => true,
            Self::SameLane(valid) => fields[valid].get(expected, lane) == 1,
        }
    }
}

/// Returns the bytes from `start` on as a number, with zeros behind the end of the record. A lane
/// of up to 64 bits fits into it, at whichever bit of its first byte it begins.
#[inline]
fn word_at(record: &[u8], start: usize) -> u128 {
    let rest = &record[start..];
    rest.first_chunk().map_or_else(
        || {
            let mut word = [0; WORD];
            word[..rest.len()].copy_from_slice(rest);
            u128::from_le_bytes(word)
        },
        |word| u128::from_le_bytes(*word),
    )
}

/// Returns a mask with ones in the lowest `width` bits.
#[inline]
pub(crate) fn low_bits_mask(width: u32) -> u64 {
    u64::MAX.checked_shr(u64::BITS.saturating_sub(width)).unwrap_or(0)
}
