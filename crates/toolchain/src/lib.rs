// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds, checks and runs the external tools, and caches what they build.
//!
//! A [`Toolchain`] finds each [`Tool`] once, refuses versions that are too old, and runs
//! [`Invocation`]s. Builds are kept in a [`Cache`] under the hash of all their inputs. The modules
//! [`verilator`], [`iverilog`], [`yosys`] and [`nextpnr`] each run one tool; [`SynthesisJob`]
//! synthesizes with Yosys for a Xilinx device. [`text`] escapes user text in scripts.

pub mod cache;
mod error;
mod process_family;
mod source_files;
mod host;
mod interrupt;
mod invocation;
pub mod iverilog;
mod cache_key;
mod located_tool;
pub mod nextpnr;
mod port_widths;
mod process;
mod running_program;
mod synthesis;
pub mod testing;
pub mod escaping;
mod tool;
mod toolchain;
pub mod verilator;
mod xilinx_cells;
pub mod yosys;

pub use cache::{Cache, CacheEntry};
pub use error::ToolError;
pub use process_family::end_all_process_families;
pub use source_files::{Source, check_source_name};
pub use host::{Host, SystemHost};
pub use interrupt::{Interrupt, InterruptibleReader, open_interruptibly, standard_input};
pub use invocation::{StandardInput, Invocation, ProgramOutput};
pub use cache_key::{CacheKey, CacheKeyBuilder, sha256_hex, sources_sha256};
pub use located_tool::LocatedTool;
pub use port_widths::PortBits;
pub use running_program::{ProgramWriter, ProgramReader};
pub use synthesis::{SynthesisResult, SynthesisJob, ToolRecord};
pub use tool::{Tool, ToolVersion};
pub use toolchain::Toolchain;
