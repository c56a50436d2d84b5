// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks of a core in the two forms that are stored: as records of its inputs and outputs
//! ([`RecordCodec`]), and as text for a replay bench ([`VectorPacker`]). A line of the text has
//! only the values that change, and a stretch of equal clocks is one line.

use super::layout::RecordField;
use crate::layout::RecordLayout;
use foveate_camera::FeatureKind;
use foveate_design::{Design, PortRole};
use foveate_model::{CoreInput, CycleModel};
use std::fmt::Write as _;
use std::io::{self, Write};

/// A converter of the inputs of a core, and of the outputs of its model, to records.
#[derive(Clone, Debug)]
pub struct RecordCodec {
    /// The features of the design, in their order.
    kinds: Vec<FeatureKind>,
    /// The values of one port.
    values: Vec<u64>,
}

impl RecordCodec {
    /// Creates the codec of a design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        Self { kinds: design.feature_kinds(), values: Vec::new() }
    }

    /// Writes the inputs at an edge into a record.
    pub fn encode_inputs(
        &mut self,
        layout: &RecordLayout,
        input: &CoreInput<'_>,
        record: &mut [u8],
    ) {
        for field in layout.fields() {
            self.values.clear();
            self.push_input_values(field.port.role, input);
            field.set_values(record, &self.values);
        }
    }

    /// Writes the outputs after an edge into a record.
    pub fn encode_outputs(
        &mut self,
        layout: &RecordLayout,
        model: &dyn CycleModel,
        record: &mut [u8],
    ) {
        for field in layout.fields() {
            self.values.clear();
            model.append_output(field.port.role, &mut self.values);
            field.set_values(record, &self.values);
        }
    }

    /// Appends the values of the input with this role.
    fn push_input_values(&mut self, role: PortRole, input: &CoreInput<'_>) {
        let place = |kind| {
            let place = self.kinds.iter().position(|&own| own == kind);
            place.expect("a port is of a feature of the design")
        };
        let thresholds = input.thresholds;
        let keen = input.zones.map_or(thresholds, |zones| zones.keen);
        let map = input.class_map();
        let value = match role {
            PortRole::Reset => input.reset.into(),
            PortRole::Valid => input.valid.into(),
            PortRole::StartOfFrame => input.sof.into(),
            PortRole::Border => input.border.into(),
            PortRole::ReferenceValid => input.reference_valid.into(),
            PortRole::ForwardReady => input.forward_ready.into(),
            PortRole::Level(kind) => thresholds.level[place(kind)].into(),
            PortRole::MinScore(kind) => thresholds.min_score[place(kind)],
            PortRole::TemporalLevel => thresholds.temporal_level.into(),
            PortRole::TemporalMinCount => thresholds.temporal_min_count.into(),
            PortRole::SummaryLevel => thresholds.summary_level.into(),
            PortRole::KeenLevel(kind) => keen.level[place(kind)].into(),
            PortRole::KeenMinScore(kind) => keen.min_score[place(kind)],
            PortRole::KeenTemporalLevel => keen.temporal_level.into(),
            PortRole::KeenTemporalMinCount => keen.temporal_min_count.into(),
            PortRole::KeenSummaryLevel => keen.summary_level.into(),
            PortRole::OffSummaryLevel => {
                input.zones.map_or(thresholds.summary_level, |zones| zones.off_summary_level).into()
            }
            PortRole::RegionClass => return self.push_classes(input),
            PortRole::ClassWrite => map.write.into(),
            PortRole::ClassAddress => map.address.into(),
            PortRole::ClassWord => map.word.into(),
            PortRole::ClassCommit => map.commit.into(),
            PortRole::Pixel => return self.push_pixels(input.pixels),
            PortRole::ReferencePixel => return self.push_pixels(input.reference_pixels),
            // The role is an output, or the clock, which is in no record.
            _ => return,
        };
        self.values.push(value);
    }

    /// Appends the codes of the classes of all lanes. There are as many lanes as pixels.
    fn push_classes(&mut self, input: &CoreInput<'_>) {
        match input.zones {
            Some(zones) => {
                self.values.extend(zones.classes.iter().map(|class| u64::from(class.code())));
            }
            None => self.values.extend(input.pixels.iter().map(|_| 0)),
        }
    }

    fn push_pixels(&mut self, pixels: &[u16]) {
        self.values.extend(pixels.iter().map(|&pixel| u64::from(pixel)));
    }
}

/// The largest number of clocks of a line; the bench counts them in 32 bits.
const MAX_CLOCKS_PER_LINE: u64 = u32::MAX as u64;

/// A writer of vectors, as the lines that [`crate::replay_bench`] reads.
///
/// The first number of a line has a bit for each value that differs from the line before: first the
/// inputs, then the expected outputs, each in the order of their layout. The changed values follow.
/// The bit above all of these says that the number of clocks for which the line holds comes before
/// the values; without it the line holds for one clock. A line `0` ends the vectors. All numbers
/// are hexadecimal.
#[derive(Debug)]
pub struct VectorPacker<W: Write> {
    out: W,
    inputs: RecordLayout,
    outputs: RecordLayout,
    /// The values of the last line that was written.
    last_written: Option<PackedClock>,
    /// The values of the next line, and its number of equal clocks.
    pending: Option<(PackedClock, u64)>,
    line: String,
}

/// The inputs and the expected outputs of a clock.
#[derive(Clone, Debug, PartialEq, Eq)]
struct PackedClock {
    input: Vec<u8>,
    expected: Vec<u8>,
}

impl<W: Write> VectorPacker<W> {
    /// Creates a writer for records of these layouts.
    pub fn new(inputs: &RecordLayout, outputs: &RecordLayout, out: W) -> Self {
        let (inputs, outputs) = (inputs.clone(), outputs.clone());
        Self { out, inputs, outputs, last_written: None, pending: None, line: String::new() }
    }

    /// Adds `clocks` clocks with the same inputs and expected outputs.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn push(&mut self, input: &[u8], expected: &[u8], clocks: u64) -> io::Result<()> {
        let mut expected = expected.to_vec();
        if let Some((waiting, run)) = &mut self.pending {
            keep_uncompared(&self.outputs, &waiting.expected, &mut expected);
            if waiting.input == input
                && waiting.expected == expected
                && *run + clocks <= MAX_CLOCKS_PER_LINE
            {
                *run += clocks;
                return Ok(());
            }
        }
        self.flush()?;
        self.pending = Some((PackedClock { input: input.to_vec(), expected }, clocks));
        Ok(())
    }

    /// Ends the vectors.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn finish(mut self) -> io::Result<W> {
        self.flush()?;
        self.out.write_all(b"0\n")?;
        self.out.flush()?;
        Ok(self.out)
    }

    /// Writes the waiting line. A line without changes always has its number of clocks.
    fn flush(&mut self) -> io::Result<()> {
        let Some((clock, run)) = self.pending.take() else { return Ok(()) };
        let before = self.last_written.as_ref();
        let inputs = changed_values(&self.inputs, &clock.input, before.map(|clock| &clock.input));
        let outputs =
            changed_values(&self.outputs, &clock.expected, before.map(|clock| &clock.expected));
        let columns = self.inputs.fields().len() + self.outputs.fields().len();
        let numbered = inputs.into_iter().chain(outputs).enumerate();
        let (mut changes, mut values) = (0u128, String::new());
        for (column, value) in numbered {
            if let Some(value) = value {
                changes |= 1 << column;
                values.push(' ');
                values.push_str(&value);
            }
        }
        self.line.clear();
        // Writing to a string cannot fail.
        let _ = if run > 1 || changes == 0 {
            write!(self.line, "{:x} {run:x}", changes | 1 << columns)
        } else {
            write!(self.line, "{changes:x}")
        };
        self.line.push_str(&values);
        self.line.push('\n');
        self.last_written = Some(clock);
        self.out.write_all(self.line.as_bytes())
    }
}

/// Returns the values of a record that differ from those before, as hexadecimal numbers.
fn changed_values(
    layout: &RecordLayout,
    record: &[u8],
    before: Option<&Vec<u8>>,
) -> Vec<Option<String>> {
    let differs = |field: &RecordField| {
        before.is_none_or(|old| field.bytes_in(old) != field.bytes_in(record))
    };
    let value =
        |field: &RecordField| differs(field).then(|| without_leading_zeros(&field.hex(record)));
    layout.fields().iter().map(value).collect()
}

fn without_leading_zeros(hex: &str) -> String {
    let digits = hex.trim_start_matches('0');
    if digits.is_empty() { "0".to_owned() } else { digits.to_owned() }
}

/// Keeps the last value of each output that is not compared in this clock, so that it needs no
/// text.
fn keep_uncompared(layout: &RecordLayout, before: &[u8], record: &mut [u8]) {
    for field in layout.fields() {
        if field.gate.is_closed(layout.fields(), record) {
            let place = field.offset..field.offset + field.bytes;
            record[place.clone()].copy_from_slice(&before[place]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::port;
    use foveate_design::{DesignConfig, OutputQualifier, Port, PortDirection, PortRole};
    use foveate_model::rcm_model;

    fn design(organization: &str) -> Design {
        let toml = format!("[hardware]\norganization = \"{organization}\"\n");
        DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
    }

    /// A port that the model does not know must not be taken for a port that is 0.
    #[test]
    #[should_panic(expected = "ready_o: a value for each place")]
    fn a_port_that_the_model_does_not_answer_is_noticed() {
        let layout = RecordLayout::outputs(&design("serial").rcm_ports());
        let core = rcm_model(&design("pipelined"));
        RecordCodec::new(&design("serial")).encode_outputs(
            &layout,
            &*core,
            &mut layout.zero_record(),
        );
    }

    #[test]
    fn only_changes_are_written_and_stretches_are_one_line() {
        let ports = [
            port("a_i", PortDirection::Input, 12, 1),
            Port { role: PortRole::ScoreValid, ..port("v_o", PortDirection::Output, 1, 1) },
            Port {
                qualifier: OutputQualifier::WhileSet(PortRole::ScoreValid),
                ..port("b_o", PortDirection::Output, 8, 1)
            },
        ];
        let (inputs, outputs) = (RecordLayout::inputs(&ports), RecordLayout::outputs(&ports));
        let mut packer = VectorPacker::new(&inputs, &outputs, Vec::new());
        for (input, expected, clocks) in [
            ([0xff, 0], [1, 7], 1),
            ([0xff, 0], [1, 7], 1),
            ([0xfe, 0], [1, 7], 1),
            // Without its valid bit a value is not written.
            ([0xfe, 0], [0, 9], 1000),
            ([0xfe, 0], [0, 3], 24),
            ([0xfe, 3], [1, 3], 1),
            ([0xfe, 3], [1, 3], u64::from(u32::MAX)),
        ] {
            packer.push(&input, &expected, clocks).unwrap();
        }
        let text = String::from_utf8(packer.finish().unwrap()).unwrap();
        let lines: Vec<_> = text.lines().collect();
        let wanted = ["f 2 ff 1 7", "1 fe", "a 400 0", "7 3fe 1 3", "8 ffffffff", "0"];
        assert_eq!(lines, wanted);
    }
}
