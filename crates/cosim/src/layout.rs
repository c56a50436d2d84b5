// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packed records: the inputs, or the outputs, of one clock as bytes.
//!
//! A record holds the ports in the order of the port list, the clock left out. Each port takes
//! `ceil(bits / 8)` bytes, lowest byte first; bits above the port's are 0. Lanes lie side by side
//! as in the Verilog vector: lane i takes bits `i * width ..= i * width + width - 1`. So a port's
//! bytes, read as one little-endian number, are the value of the Verilog vector.

use foveate_spec::{Direction, Port, PortRole};
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
}

/// The layout of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    fields: Vec<Field>,
    bytes: usize,
}

impl Layout {
    /// The record of all inputs but the clock.
    #[must_use]
    pub fn inputs(ports: &[Port]) -> Self {
        let wanted = |port: &&Port| {
            port.direction == Direction::Input && !matches!(port.role, PortRole::Clock)
        };
        Self::of(ports.iter().filter(wanted))
    }

    /// The record of all outputs.
    #[must_use]
    pub fn outputs(ports: &[Port]) -> Self {
        Self::of(ports.iter().filter(|port| port.direction == Direction::Output))
    }

    fn of<'a>(ports: impl Iterator<Item = &'a Port>) -> Self {
        let mut offset = 0;
        let place = |port: &Port| {
            let bytes = port.bits().div_ceil(8) as usize;
            let field = Field { port: port.clone(), offset, bytes };
            offset += bytes;
            field
        };
        let fields = ports.map(place).collect();
        Self { fields, bytes: offset }
    }

    /// The ports and their places.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Bytes of a record.
    #[must_use]
    pub fn record_bytes(&self) -> usize {
        self.bytes
    }

    /// A record of zeros.
    #[must_use]
    pub fn record(&self) -> Vec<u8> {
        vec![0; self.bytes]
    }

    /// Values that are compared per record: one per port and lane.
    #[must_use]
    pub fn values(&self) -> u64 {
        self.fields.iter().map(|field| u64::from(field.port.lanes)).sum()
    }

    /// Appends a record as a line's worth of hexadecimal numbers, one per port.
    pub fn write_hex(&self, record: &[u8], line: &mut String) {
        for field in &self.fields {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&field.hex(record));
        }
    }
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

    /// Reads one lane.
    #[must_use]
    pub fn get(&self, record: &[u8], lane: u32) -> u64 {
        let (start, shift) = self.place(lane);
        let mut word = [0; 16];
        for (to, from) in word.iter_mut().zip(&record[start..self.end()]) {
            *to = *from;
        }
        let value = (u128::from_le_bytes(word) >> shift) & u128::from(mask(self.port.width));
        u64::try_from(value).unwrap_or(u64::MAX)
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

fn mask(width: u32) -> u64 {
    u64::MAX.checked_shr(u64::BITS.saturating_sub(width)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::port;
    use proptest::prelude::*;

    #[test]
    fn bytes_are_those_of_the_verilog_vector() {
        let ports = [
            port("clk_i", Direction::Input, 1, 1),
            port("a_i", Direction::Input, 1, 1),
            port("b_i", Direction::Input, 12, 3),
            port("c_o", Direction::Output, 54, 1),
        ];
        let layout = Layout::inputs(&ports);
        assert_eq!(layout.record_bytes(), 1 + 5);
        let mut record = layout.record();
        layout.fields()[0].set(&mut record, 0, 1);
        for (lane, value) in [(0, 0xabc), (1, 0xdef), (2, 0x123)] {
            layout.fields()[1].set(&mut record, lane, value);
        }
        assert_eq!(record, [1, 0xbc, 0xfa, 0xde, 0x23, 0x01]);
        let mut line = String::new();
        layout.write_hex(&record, &mut line);
        assert_eq!(line, "1 123defabc");
        assert_eq!(Layout::outputs(&ports).record_bytes(), 7);
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
                .map(|&(width, lanes)| port("p_o", Direction::Output, width, lanes))
                .collect();
            let layout = Layout::outputs(&ports);
            let mut record = layout.record();
            let lanes = |layout: &Layout| -> Vec<(usize, u32)> {
                let fields = layout.fields().iter().enumerate();
                fields.flat_map(|(i, f)| (0..f.port.lanes).map(move |lane| (i, lane))).collect()
            };
            let mut expected = Vec::new();
            for ((index, lane), value) in lanes(&layout).into_iter().zip(values.iter().cycle()) {
                let field = &layout.fields()[index];
                field.set(&mut record, lane, *value);
                expected.push((index, lane, value & mask(field.port.width)));
            }
            let chosen = usize::try_from(again % expected.len() as u64).unwrap();
            let (index, lane, value) = &mut expected[chosen];
            let field = &layout.fields()[*index];
            field.set(&mut record, *lane, again);
            *value = again & mask(field.port.width);
            for (index, lane, value) in expected {
                prop_assert_eq!(layout.fields()[index].get(&record, lane), value);
            }
        }
    }
}
