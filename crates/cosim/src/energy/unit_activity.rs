// SPDX-License-Identifier: MIT OR Apache-2.0
//! The activity of a unit that takes the vectors of a recording, whose outputs are compared with
//! those of the model.

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::{CosimError, RecordField, RecordLayout, Recording};
use foveate_tools::ToolError;

use crate::energy::activity::{ActivityCounter, NetActivity};
use crate::energy::error::EnergyError;
use crate::energy::gate_simulation::GateSimulation;
use crate::energy::simulated_netlist::SimulatedNetlist;

/// The number of sequences that are simulated at once.
const LANES: usize = 64;

/// A sequence of a recording: one region, or the regions of one lane, in all frames.
struct UnitSequence {
    /// Its clocks in the recording.
    clocks: Range<usize>,
    /// The clocks that are counted.
    counted: Range<usize>,
}

/// Simulates all sequences of a recording, and counts the activity in these frames of each. Stops
/// with an error as soon as `cancel` is set.
pub(crate) fn unit_activity(
    netlist: &SimulatedNetlist<'_>,
    recording: &Recording,
    frames: &Range<u64>,
    cancel: &AtomicBool,
) -> Result<NetActivity, EnergyError> {
    let read = |path: PathBuf| {
        fs::read(&path)
            .map_err(|source| EnergyError::from(CosimError::Io { action: "read", path, source }))
    };
    let records = RecordedUnit {
        netlist,
        recording,
        inputs: read(recording.inputs_path())?,
        outputs: read(recording.expected_path())?,
        input_bits: port_bits(recording.inputs().fields(), netlist.inputs)?,
        output_bits: port_bits(recording.outputs().fields(), netlist.outputs)?,
    };
    let mut counter = ActivityCounter::new(netlist);
    for batch in sequences(recording, frames).chunks(LANES) {
        records.simulate(batch, &mut counter, cancel)?;
    }
    Ok(counter.finish())
}

fn sequences(recording: &Recording, frames: &Range<u64>) -> Vec<UnitSequence> {
    let place = |clock: u64| usize::try_from(clock).expect("the records are in memory");
    let spans = recording.spans();
    let starts: Vec<usize> = (0..spans.len()).filter(|&at| spans[at].frame == 0).collect();
    let ends = starts.iter().skip(1).copied().chain([spans.len()]);
    let sequence = |(start, end): (&usize, usize)| {
        let own = &spans[*start..end];
        let after = spans.get(end).map_or(recording.clocks(), |span| span.first_clock);
        let first_of = |frame: u64| {
            own.iter().find(|span| span.frame == frame).map_or(after, |span| span.first_clock)
        };
        UnitSequence {
            clocks: place(own[0].first_clock)..place(after),
            counted: place(first_of(frames.start))..place(first_of(frames.end)),
        }
    };
    starts.iter().zip(ends).map(sequence).collect()
}

/// A bit of a record, and its net.
struct PortBit {
    byte: usize,
    shift: usize,
    net: usize,
}

fn port_bits(
    fields: &[RecordField],
    ports: &BTreeMap<String, Vec<usize>>,
) -> Result<Vec<PortBit>, EnergyError> {
    let mut bits = Vec::new();
    for field in fields {
        let wanted = field.port.bits() as usize;
        let nets = ports.get(&field.port.name).filter(|nets| nets.len() == wanted);
        let nets = nets.ok_or_else(|| EnergyError::Netlist {
            reason: format!("it has no port `{}` of {wanted} bits", field.port.name),
        })?;
        let bit = |(bit, &net): (usize, &usize)| PortBit {
            byte: field.offset + bit / 8,
            shift: bit % 8,
            net,
        };
        bits.extend(nets.iter().enumerate().map(bit));
    }
    Ok(bits)
}

/// The records of a unit in memory.
struct RecordedUnit<'a> {
    netlist: &'a SimulatedNetlist<'a>,
    recording: &'a Recording,
    inputs: Vec<u8>,
    outputs: Vec<u8>,
    input_bits: Vec<PortBit>,
    output_bits: Vec<PortBit>,
}

impl RecordedUnit<'_> {
    /// Simulates up to 64 sequences at once.
    fn simulate(
        &self,
        batch: &[UnitSequence],
        counter: &mut ActivityCounter<'_>,
        cancel: &AtomicBool,
    ) -> Result<(), EnergyError> {
        let mut simulation = GateSimulation::new(self.netlist);
        let clocks = batch.iter().map(|sequence| sequence.clocks.len()).max().unwrap_or(0);
        // A net changes once in a clock: from its value before an edge to that before the next.
        let mut before = simulation.values().to_vec();
        for clock in 0..clocks {
            if cancel.load(Ordering::Relaxed) {
                return Err(EnergyError::Silicon(ToolError::Interrupted.into()));
            }
            self.apply_inputs(batch, clock, &mut simulation);
            simulation.settle();
            let counted =
                mask(batch, |sequence| sequence.counted.contains(&(sequence.clocks.start + clock)));
            counter.count(&simulation, &before, counted);
            before.copy_from_slice(simulation.values());
            simulation.clock();
            simulation.settle();
            self.check_outputs(batch, clock, &simulation)?;
        }
        Ok(())
    }

    fn apply_inputs(
        &self,
        batch: &[UnitSequence],
        clock: usize,
        simulation: &mut GateSimulation<'_>,
    ) {
        for bit in &self.input_bits {
            let value = self.lanes_of_bit(&self.inputs, self.recording.inputs(), bit, batch, clock);
            simulation.set_net(bit.net, value);
        }
    }

    /// Returns the recorded values of a bit, one sequence per bit of the result. A sequence that
    /// has ended keeps its last value.
    fn lanes_of_bit(
        &self,
        records: &[u8],
        layout: &RecordLayout,
        bit: &PortBit,
        batch: &[UnitSequence],
        clock: usize,
    ) -> u64 {
        let bytes = layout.record_bytes();
        let mut value = 0;
        for (lane, sequence) in batch.iter().enumerate() {
            let record = (sequence.clocks.start + clock).min(sequence.clocks.end - 1);
            value |= u64::from(records[record * bytes + bit.byte] >> bit.shift & 1) << lane;
        }
        value
    }

    /// Compares the outputs after an edge with those of the model.
    fn check_outputs(
        &self,
        batch: &[UnitSequence],
        clock: usize,
        simulation: &GateSimulation<'_>,
    ) -> Result<(), EnergyError> {
        let layout = self.recording.outputs();
        let mut differing = 0;
        for bit in &self.output_bits {
            let expected = self.lanes_of_bit(&self.outputs, layout, bit, batch, clock);
            differing |= simulation.values()[bit.net] ^ expected;
        }
        differing &= mask(batch, |sequence| clock < sequence.clocks.len());
        let bytes = layout.record_bytes();
        let mut got = vec![0; bytes];
        for (lane, sequence) in batch.iter().enumerate() {
            // A difference may be in a field that does not count at this edge.
            if differing >> lane & 1 == 0 {
                continue;
            }
            got.fill(0);
            for bit in &self.output_bits {
                let value = simulation.values()[bit.net] >> lane & 1;
                got[bit.byte] |= u8::from(value == 1) << bit.shift;
            }
            let start = (sequence.clocks.start + clock) * bytes;
            let expected = &self.outputs[start..start + bytes];
            if let Some(field) = layout.first_difference(expected, &got) {
                let span = self.recording.span((sequence.clocks.start + clock) as u64);
                return Err(EnergyError::Mismatch {
                    region: span.and_then(|span| span.region).unwrap_or_default(),
                    frame: span.map_or(0, |span| span.frame),
                    port: field.port.name.clone(),
                    expected: field.hex(expected),
                    found: field.hex(&got),
                });
            }
        }
        Ok(())
    }
}

/// Returns a bit for each sequence.
fn mask(batch: &[UnitSequence], is_set: impl Fn(&UnitSequence) -> bool) -> u64 {
    batch
        .iter()
        .enumerate()
        .fold(0, |mask, (lane, sequence)| mask | u64::from(is_set(sequence)) << lane)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use crate::{UnitFrames, random_frames};
    use foveate_design::DesignConfig;
    use foveate_estimate::{FlatNetlist, LibertyLibrary, map_unit};
    use foveate_pixels::Frame;
    use foveate_tools::{Cache, Tool, Toolchain, testing::require_tools};

    use super::*;
    use crate::energy::testing::{OSU018, has_library};

    /// Every mapped gate that is another one is noticed, unless it decides nothing in these frames.
    #[test]
    fn a_netlist_that_differs_from_the_model_has_no_activity() {
        if !require_tools(&[Tool::Yosys]) || !has_library() {
            return;
        }
        let toml = "frame = { width = 8, height = 8, pixel_bits = 4 }\nregion.size = 4\n";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let library = LibertyLibrary::read(OSU018.as_ref()).unwrap();
        let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
        let flat = map_unit(&toolchain, &cache, &design, (&library, 4096)).unwrap();
        let frames = random_frames(&design, 1, 6).unwrap();
        let vectors = UnitFrames { frames: &frames, max_parts: 100 };
        let recording = vectors.record(&design, &AtomicBool::new(false)).unwrap();
        let few = UnitFrames { max_parts: 3, ..vectors.clone() };
        assert_eq!(few.record(&design, &AtomicBool::new(false)).unwrap().sequences(), 3);
        let other = [Frame::new(4, 4, 4, vec![0; 16]).unwrap()];
        let wrong = UnitFrames { frames: &other, max_parts: 3 };
        let message = wrong.record(&design, &AtomicBool::new(false)).unwrap_err().to_string();
        assert!(message.contains("4x4 pixels") && message.contains("8x8 pixels"), "{message}");
        let run = |flat: &FlatNetlist| {
            let cells: BTreeSet<&str> = flat.gates.iter().map(|gate| gate.cell.as_str()).collect();
            let models = library.cell_models(cells).unwrap();
            let netlist = SimulatedNetlist::new(flat, &models).unwrap();
            unit_activity(&netlist, &recording, &(2..5), &AtomicBool::new(false))
        };
        let activity = run(&flat).unwrap();
        let clocks =
            4.0 * 3.0 * f64::from(u32::try_from(design.timing().clocks_per_frame()).unwrap());
        assert_eq!(activity.clocks, clocks);
        assert!(activity.nets.iter().any(|[rises, falls]| (rises - falls).abs() > 0.0));
        assert!(activity.nets.iter().all(|[rises, falls]| (rises - falls).abs() <= 4.0));

        let places: Vec<usize> =
            (0..flat.gates.len()).filter(|&gate| flat.gates[gate].cell == "NAND2X1").collect();
        assert!(places.len() > 20, "{}", places.len());
        let is_noticed = |&&place: &&usize| {
            let mut other = flat.clone();
            "NOR2X1".clone_into(&mut other.gates[place].cell);
            matches!(run(&other), Err(EnergyError::Mismatch { .. }))
        };
        let noticed = places.iter().filter(is_noticed).count();
        assert!(noticed * 10 >= places.len() * 9, "{noticed} of {}", places.len());
    }
}
