// SPDX-License-Identifier: MIT OR Apache-2.0
//! Co-simulation: it feeds identical vectors to the model and to the RTL, and compares every output
//! at every clock.
//!
//! A [`CosimJob`] is a whole co-simulation. Its [`Stimulus`] runs the cycle-level model and records
//! vectors, a simulator runs the Verilog on them, and a [`CosimReport`] says whether they agree, or
//! where the first mismatch is. A failing run leaves a folder that replays it. Everything that
//! depends on the Verilog is made from the list of ports: the byte [`RecordLayout`] of a clock, the
//! C++ harness and the replay bench.
//!
//! A [`Benchmark`] compares and times all levels of a design, from the functional model to the
//! netlist.

mod benchmark;
mod bus;
mod codec;
mod core_activity;
mod diagram;
mod elaboration;
mod energy;
mod error;
mod gate;
mod harness;
mod hierarchy;
mod job;
mod layout;
mod level;
mod mismatch;
mod netlist;
mod recording;
mod replay;
mod report;
mod shipped_bench;
mod simulation;
mod situations;
mod stimulus;
#[cfg(test)]
mod testing;
mod timed_run;
mod written_core;

pub use self::written_core::{CORE, WrittenCore, write_core};
pub use benchmark::{
    BENCHMARK_FORMAT_VERSION, Benchmark, BenchmarkLevel, BenchmarkReport, ExternalTools,
    LevelMeasurement, LevelRow, random_frames,
};
pub use bus::BusJob;
pub use codec::{RecordCodec, VectorPacker};
pub use diagram::timing_diagram;
pub use elaboration::{UnelaboratedVariant, unelaborated_variants};
pub use energy::{
    ActivityClip, ENERGY_FORMAT_VERSION, EnergyError, EnergyJob, EnergyReport, PartEnergies,
    StretchEnergy, measure_energy,
};
pub use error::CosimError;
pub use gate::ComparisonGate;
pub use harness::{bench_file, bench_name, cpp_harness, replay_bench};
pub use hierarchy::{UnsimulatedModules, core_prefixes, unsimulated_modules};
pub use job::{CosimJob, CosimProgress};
pub use layout::{RecordField, RecordLayout};
pub use level::CosimLevel;
pub use mismatch::{Mismatch, PortDifference, PortMismatch};
pub use netlist::{Netlist, NetlistRecord, cell_models, has_miswired_block_ram};
pub use recording::{Recorder, Recording, RecordingSpan, vectors_hex};
pub use replay::REPLAY;
pub use report::{
    CosimReport, CosimSummary, CosimVerdict, FORMAT_VERSION, StepSeconds, UnreachedVerilog,
    junit_error, junit_xml,
};
pub use shipped_bench::{RegionLosses, ShippedBench, VectorTally};
pub use simulation::{DesignUnderTest, SimulationOutcome, SimulationRun, Simulator};
pub use situations::{Occurrence, Occurrences};
pub use stimulus::{Stimulus, UnitFrames};
pub use timed_run::{OutputAgreement, TimedRun};
