// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds, checks and runs the external tools, and caches what they build.
//!
//! A [`Toolchain`] finds each [`Tool`] once, refuses versions that are too old, and runs
//! [`Invocation`]s. Builds are kept in a [`Cache`] under the hash of all their inputs. The modules
//! [`verilator`], [`iverilog`], [`yosys`] and [`nextpnr`] each run one tool; [`SynthesisJob`]
//! synthesizes with Yosys for a Xilinx device. [`text`] escapes user text in scripts.

pub mod cache;
mod error;
mod family;
mod files;
mod host;
mod interrupt;
mod invocation;
pub mod iverilog;
mod key;
mod located;
pub mod nextpnr;
mod ports;
mod process;
mod stream;
mod synthesis;
pub mod testing;
pub mod text;
mod tool;
mod toolchain;
pub mod verilator;
mod xilinx_cells;
pub mod yosys;

pub use cache::{Cache, Entry};
pub use error::ToolError;
pub use family::end_all_families;
pub use files::{Source, check_source_name};
pub use host::{Host, SystemHost};
pub use interrupt::{Interrupt, InterruptibleReader, open_interruptibly, standard_input};
pub use invocation::{Input, Invocation, Output};
pub use key::{Key, KeyBuilder, sha256_hex, sources_sha256};
pub use located::Located;
pub use ports::PortBits;
pub use stream::{Feeder, Stream};
pub use synthesis::{Synthesis, SynthesisJob, ToolRecord};
pub use tool::{Tool, Version};
pub use toolchain::Toolchain;
