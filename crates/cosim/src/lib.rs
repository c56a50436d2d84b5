// SPDX-License-Identifier: MIT OR Apache-2.0
//! Co-simulation: it feeds identical vectors to the model and to the RTL, and compares every output
//! at every clock.
//!
//! A [`Job`] is a whole co-simulation. Its [`Stimulus`] runs the cycle-level model and records
//! vectors, a simulator runs the Verilog on them, and a [`CosimReport`] says whether they agree, or
//! where the first mismatch is. A failing run leaves a folder that replays it. Everything that
//! depends on the Verilog is made from the list of ports: the byte [`Layout`] of a clock, the C++
//! harness and the replay bench.
//! the replay bench.

mod bus;
mod cells;
mod codec;
mod compare;
mod core;
mod diagram;
mod elaboration;
mod error;
mod field;
mod gate;
mod harness;
mod hierarchy;
mod job;
mod junit;
mod layout;
mod level;
mod locate;
mod mismatch;
mod moment;
mod netlist;
mod packer;
mod recording;
mod replay;
mod report;
mod shipped;
mod simulate;
mod situations;
mod stimulus;
mod summary;
#[cfg(test)]
mod testing;
mod timed;

pub use self::core::{CORE, WrittenCore, write_core};
pub use bus::BusJob;
pub use cells::{cell_models, wired_wrongly};
pub use codec::Codec;
pub use compare::Difference;
pub use diagram::timing_diagram;
pub use elaboration::{NotElaborated, not_elaborated};
pub use error::CosimError;
pub use field::Field;
pub use gate::Gate;
pub use harness::{bench_file, bench_name, cpp_harness, replay_bench};
pub use hierarchy::{NotSimulated, not_simulated, prefixes};
pub use job::{Job, Progress};
pub use junit::{junit_error, junit_xml};
pub use layout::Layout;
pub use level::Level;
pub use mismatch::{Mismatch, PortMismatch};
pub use netlist::{Netlist, NetlistRecord};
pub use packer::Packer;
pub use recording::{Recorder, Recording, Span, vectors_hex};
pub use replay::REPLAY;
pub use report::{CosimReport, Seconds};
pub use shipped::{Losses, ShippedBench, VectorTally};
pub use simulate::{Dut, Outcome, Run, Simulator};
pub use situations::{Occurrence, Occurrences};
pub use stimulus::Stimulus;
pub use summary::{FORMAT_VERSION, Left, Summary, Verdict};
pub use timed::{Agreement, Timed};
