// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packed records: the inputs, or the outputs, of one clock as bytes ([`RecordLayout`]).
//!
//! A record holds the ports in the order of the port list, without the clock, each as a
//! [`RecordField`]. Each port takes `ceil(bits / 8)` bytes, lowest byte first; bits above the
//! port's are 0. Lanes lie side by side as in the Verilog vector: lane i takes bits `i * width
//! ..= i * width + width - 1`. So the bytes of a port, read as one little-endian number, are
//! the value of the Verilog vector.

use crate::gate::ComparisonGate;
use foveate_design::{OutputQualifier, Port, PortDirection, PortRole};
use std::fmt::Write as _;

/// The layout of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordLayout {
    fields: Vec<RecordField>,
    bytes: usize,
}

impl RecordLayout {
    /// Returns the layout of all inputs but the clock.
    #[must_use]
    pub fn inputs(ports: &[Port]) -> Self {
        let wanted = |port: &&Port| {
            port.direction == PortDirection::Input && !matches!(port.role, PortRole::Clock)
        };
        Self::from_ports(ports.iter().filter(wanted))
    }

    /// Returns the layout of all outputs.
    #[must_use]
    pub fn outputs(ports: &[Port]) -> Self {
        Self::from_ports(ports.iter().filter(|port| port.direction == PortDirection::Output))
    }

    fn from_ports<'a>(ports: impl Iterator<Item = &'a Port>) -> Self {
        let mut offset = 0;
        let ports: Vec<_> = ports.collect();
        let place = |port: &&Port| {
            let bytes = port.bits().div_ceil(8) as usize;
            let field =
                RecordField { port: (*port).clone(), offset, bytes, gate: gate_of(port, &ports) };
            offset += bytes;
            field
        };
        let fields = ports.iter().map(place).collect();
        Self { fields, bytes: offset }
    }

    /// Returns the ports and their places.
    #[must_use]
    #[inline]
    pub fn fields(&self) -> &[RecordField] {
        &self.fields
    }

    /// Returns the number of bytes of a record.
    #[must_use]
    pub fn record_bytes(&self) -> usize {
        self.bytes
    }

    /// Returns a record of zeros.
    #[must_use]
    pub fn zero_record(&self) -> Vec<u8> {
        vec![0; self.bytes]
    }

    /// Returns true if every value is compared at every clock.
    #[must_use]
    pub fn is_ungated(&self) -> bool {
        self.fields.iter().all(|field| field.gate == ComparisonGate::Always)
    }

    /// Returns the number of values of a record that are compared: one per port and lane. If a
    /// valid bit belongs to the port, only lanes with that bit count.
    #[must_use]
    pub fn compared_values(&self, expected: &[u8]) -> u64 {
        let lanes =
            |field: &RecordField| field.gate.open_lanes(&self.fields, expected, field.port.lanes);
        self.fields.iter().map(|field| u64::from(lanes(field))).sum()
    }

    /// Returns the number of values that are compared and differ.
    #[must_use]
    pub fn differing_values(&self, expected: &[u8], got: &[u8]) -> u64 {
        let differs = |field: &&RecordField| field.bytes_in(expected) != field.bytes_in(got);
        let lanes = |field: &RecordField| {
            let unequal = |lane: &u32| field.get(expected, *lane) != field.get(got, *lane);
            self.compared_lanes(field, expected).filter(unequal).count() as u64
        };
        self.fields.iter().filter(differs).map(lanes).sum()
    }

    /// Returns the first port with a value that is compared and differs.
    #[must_use]
    pub fn first_difference(&self, expected: &[u8], got: &[u8]) -> Option<&RecordField> {
        let differs = |field: &&RecordField| {
            let unequal = |lane| field.get(expected, lane) != field.get(got, lane);
            self.compared_lanes(field, expected).any(unequal)
        };
        self.fields.iter().find(differs)
    }

    /// Returns the lanes of a port that are compared, by the valid bits of the expected record.
    pub(crate) fn compared_lanes<'a>(
        &'a self,
        field: &'a RecordField,
        expected: &'a [u8],
    ) -> impl Iterator<Item = u32> + 'a {
        let lanes = if field.gate.is_closed(&self.fields, expected) { 0 } else { field.port.lanes };
        (0..lanes).filter(|&lane| field.gate.compares_lane(&self.fields, expected, lane))
    }
}

/// Returns the gate of a port among the ports of a layout: the valid bit of its lane if there is
/// one per lane, or else the valid bit of any lane.
fn gate_of(port: &Port, ports: &[&Port]) -> ComparisonGate {
    let valid = |role| ports.iter().position(|other| other.role == role);
    let valid = match port.qualifier {
        OutputQualifier::Always => None,
        OutputQualifier::WhileSet(role) => valid(role),
    };
    match valid {
        None => ComparisonGate::Always,
        Some(valid) if ports[valid].per_lane == port.per_lane => ComparisonGate::SameLane(valid),
        Some(valid) => ComparisonGate::AnyLane(valid),
    }
}

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

#[cfg(test)]
mod tests {
    use super::{low_bits_mask, *};
    use crate::testing::port;
    use proptest::prelude::*;

    #[test]
    fn bytes_are_those_of_the_verilog_vector() {
        let ports = [
            port("clk_i", PortDirection::Input, 1, 1),
            port("a_i", PortDirection::Input, 1, 1),
            port("b_i", PortDirection::Input, 12, 3),
            port("c_o", PortDirection::Output, 54, 1),
        ];
        let layout = RecordLayout::inputs(&ports);
        assert_eq!(layout.record_bytes(), 1 + 5);
        let mut record = layout.zero_record();
        layout.fields()[0].set(&mut record, 0, 1);
        for (lane, value) in [(0, 0xabc), (1, 0xdef), (2, 0x123)] {
            layout.fields()[1].set(&mut record, lane, value);
        }
        assert_eq!(record, [1, 0xbc, 0xfa, 0xde, 0x23, 0x01]);
        let hex: Vec<_> = layout.fields().iter().map(|field| field.hex(&record)).collect();
        assert_eq!(hex, ["1", "123defabc"]);
        assert_eq!(RecordLayout::outputs(&ports).record_bytes(), 7);
    }

    proptest! {
        #[test]
        fn what_is_set_is_read_and_nothing_else_changes(
            shapes in prop::collection::vec((1u32..=64, 1u32..=9), 1..6),
            values in prop::collection::vec(any::<u64>(), 64),
            again in any::<u64>(),
        ) {
            let ports: Vec<_> = shapes
                .iter()
                .map(|&(width, lanes)| port("p_o", PortDirection::Output, width, lanes))
                .collect();
            let layout = RecordLayout::outputs(&ports);
            let mut record = layout.zero_record();
            let lanes = |layout: &RecordLayout| -> Vec<(usize, u32)> {
                let fields = layout.fields().iter().enumerate();
                fields.flat_map(|(i, f)| (0..f.port.lanes).map(move |lane| (i, lane))).collect()
            };
            let mut expected = Vec::new();
            for ((index, lane), value) in lanes(&layout).into_iter().zip(values.iter().cycle()) {
                let field = &layout.fields()[index];
                field.set(&mut record, lane, *value);
                expected.push((index, lane, value & low_bits_mask(field.port.width)));
            }
            let chosen = usize::try_from(again % expected.len() as u64).unwrap();
            let (index, lane, value) = &mut expected[chosen];
            let field = &layout.fields()[*index];
            field.set(&mut record, *lane, again);
            *value = again & low_bits_mask(field.port.width);
            for (index, lane, value) in expected {
                prop_assert_eq!(layout.fields()[index].get(&record, lane), value);
            }
            let mut at_once = layout.zero_record();
            for field in layout.fields() {
                let lanes = 0..field.port.lanes;
                field.set_all(&mut at_once, lanes.map(|lane| field.get(&record, lane)));
            }
            prop_assert_eq!(at_once, record);
        }
    }
}
