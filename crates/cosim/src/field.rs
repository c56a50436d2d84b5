// SPDX-License-Identifier: MIT OR Apache-2.0
//! One port in a record.

use crate::gate::Gate;
use foveate_design::Port;
use std::fmt::Write as _;

/// Where one port lies in a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// The port.
    pub port: Port,
    /// Its first byte.
    pub offset: usize,
    /// How many bytes it takes.
    pub bytes: usize,
    /// When it is compared.
    pub gate: Gate,
}

impl Field {
    /// Writes one lane; bits of `value` above the lane's width are dropped.
    pub fn set(&self, record: &mut [u8], lane: u32, value: u64) {
        let (start, shift) = self.place(lane);
        let mask = u128::from(mask(self.port.width));
        let (mask, value) = (mask << shift, (u128::from(value) & mask) << shift);
        let masks = mask.to_le_bytes().into_iter().zip(value.to_le_bytes());
        for (byte, (mask, value)) in record[start..self.end()].iter_mut().zip(masks) {
            *byte = (*byte & !mask) | value;
        }
    }

    /// Writes every lane, lane 0 first; faster than one after the other.
    pub(crate) fn set_all(&self, record: &mut [u8], values: impl Iterator<Item = u64>) {
        let end = self.end();
        let mut bytes = record[self.offset..end].iter_mut();
        let (mut waiting, mut bits) = (0u128, 0);
        for value in values.take(self.port.lanes as usize) {
            waiting |= u128::from(value & mask(self.port.width)) << bits;
            bits += self.port.width;
            while bits >= 8 {
                if let Some(byte) = bytes.next() {
                    *byte = waiting.to_le_bytes()[0];
                }
                waiting >>= 8;
                bits -= 8;
            }
        }
        if let (Some(byte), true) = (bytes.next(), bits > 0) {
            *byte = waiting.to_le_bytes()[0];
        }
    }

    /// Writes every lane, each with as many values as it holds: one, or the pixels of a word, the first in the lowest
    /// bits.
    ///
    /// # Panics
    /// When there is not a value for each place: who should know the port does not.
    pub(crate) fn set_values(&self, record: &mut [u8], values: &[u64]) {
        let (held, bits) = self.word(values.len());
        let lanes = self.port.lanes as usize;
        assert_eq!(values.len(), lanes * held, "{}: a value for each place", self.port.name);
        let word = |values: &[u64]| values.iter().rev().fold(0, |word, value| word << bits | value);
        self.set_all(record, values.chunks(held).map(word));
    }

    /// Reads every lane, as `set_values` has written so many pixels.
    pub fn words(&self, record: &[u8], count: usize) -> impl Iterator<Item = u64> {
        let (held, bits) = self.word(count);
        let lanes = (0..self.port.lanes).map(|lane| self.get(record, lane));
        let pixels = move |word: u64| {
            let next = move |left: &mut u64, _| {
                let pixel = *left & mask(bits);
                *left = left.checked_shr(bits).unwrap_or(0);
                Some(pixel)
            };
            (0..held).scan(word, next)
        };
        lanes.flat_map(pixels)
    }

    /// Pixels of a lane, and bits of a pixel, where all lanes have so many pixels.
    fn word(&self, pixels: usize) -> (usize, u32) {
        let held = (pixels / self.port.lanes as usize).max(1);
        (held, self.port.width / u32::try_from(held).unwrap_or(u32::MAX))
    }

    /// Reads one lane.
    #[must_use]
    pub fn get(&self, record: &[u8], lane: u32) -> u64 {
        let (start, shift) = self.place(lane);
        let mut word = [0; 16];
        for (to, from) in word.iter_mut().zip(&record[start..self.end()]) {
            *to = *from;
        }
        let value = (u128::from_le_bytes(word) >> shift) & u128::from(mask(self.port.width));
        u64::try_from(value).expect("the mask has 64 bits")
    }

    /// Its bytes.
    #[must_use]
    pub fn slice<'a>(&self, record: &'a [u8]) -> &'a [u8] {
        &record[self.offset..self.end()]
    }

    /// The whole port as one hexadecimal number, as many digits as its bits need.
    #[must_use]
    pub fn hex(&self, record: &[u8]) -> String {
        let mut digits = String::with_capacity(2 * self.bytes);
        for byte in self.slice(record).iter().rev() {
            // Writing to a string cannot fail.
            let _ = write!(digits, "{byte:02x}");
        }
        let wanted = self.port.bits().div_ceil(4) as usize;
        digits.split_off(digits.len() - wanted)
    }

    fn end(&self) -> usize {
        self.offset + self.bytes
    }

    /// First byte of a lane, and its first bit in that byte.
    fn place(&self, lane: u32) -> (usize, u32) {
        let bit = lane * self.port.width;
        (self.offset + (bit / 8) as usize, bit % 8)
    }
}

impl Gate {
    /// Whether no lane of a value is compared at this clock.
    pub(crate) fn is_shut(self, fields: &[Field], expected: &[u8]) -> bool {
        match self {
            Self::Always => false,
            Self::SameLane(valid) | Self::AnyLane(valid) => {
                fields[valid].slice(expected).iter().all(|&byte| byte == 0)
            }
        }
    }

    /// Whether a lane is compared at a clock at which the gate is not shut.
    pub(crate) fn lets_pass(self, fields: &[Field], expected: &[u8], lane: u32) -> bool {
        match self {
            Self::Always | Self::AnyLane(_) => true,
            Self::SameLane(valid) => fields[valid].get(expected, lane) == 1,
        }
    }
}

/// Ones in the lowest bits.
pub(crate) fn mask(width: u32) -> u64 {
    u64::MAX.checked_shr(u64::BITS.saturating_sub(width)).unwrap_or(0)
}
