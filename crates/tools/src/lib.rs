// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds, checks and runs the external tools, and caches what they build. Reads files of strangers
//! up to a limit, and writes files and folders that are there whole or not at all.
//!
//! A [`Toolchain`] finds each [`Tool`] once, refuses versions that are too old, and runs
//! [`Invocation`]s. Builds are kept in a [`Cache`] under the hash of all their inputs. The modules
//! [`verilator`], [`iverilog`], [`yosys`] and [`nextpnr`] each run one tool; [`SynthesisJob`]
//! synthesizes with Yosys for a Xilinx device. [`escaping`] escapes user text in scripts.
//! [`read_text`], [`table_reader`] and [`LimitedReader`] read files; [`write_file`],
//! [`StagedFolder`] and [`GrowingFile`] write them.

pub mod cache;
mod cache_key;
mod error;
pub mod escaping;
mod host;
mod interrupt;
mod invocation;
pub mod iverilog;
pub mod nextpnr;
pub mod opensta;
mod port_widths;
mod process;
mod reading;
mod running_program;
mod source_files;
mod staging;
mod synthesis;
pub mod testing;
mod tool;
mod toolchain;
pub mod verilator;
pub mod yosys;

pub use cache::Cache;
pub use cache_key::{CacheKey, CacheKeyBuilder, sha256_hex, sources_sha256};
pub use error::ToolError;
pub use host::{Host, SystemHost};
pub use interrupt::{Interrupt, InterruptibleReader, open_interruptibly, standard_input};
pub use invocation::{Invocation, ProgramOutput, StandardInput};
pub use port_widths::PortBits;
pub use process::end_all_process_families;
pub use reading::{
    GZIP_MAGIC, LimitedReader, RECORD_LIMIT, SETTINGS_LIMIT, TableReader, TableRecords,
    foreign_format, open_file, read_bytes, read_settings, read_text, settings_from, table_reader,
    unpacked,
};
pub use running_program::{ProgramReader, ProgramWriter};
pub use source_files::{Source, check_source_name};
pub use staging::{
    ContinuedFolder, FolderKind, GrowingFile, ScratchFolder, SpaceReserve, StagedFolder,
    StagingError, TEMPORARY_PREFIX, check_file, has_room, is_full, write_file,
};
pub use synthesis::{SynthesisJob, SynthesisResult, ToolRecord};
pub use tool::{LocatedTool, Tool, ToolVersion};
pub use toolchain::Toolchain;
