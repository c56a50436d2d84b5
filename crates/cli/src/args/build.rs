// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate build`.

use std::path::PathBuf;

use clap::Args;

use super::at_least_one;

/// Make a bitstream of a camera on a board: sensor, core and serial line
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate build --list
          foveate build --board icebreaker -o out
          foveate build --board ulx3s -o out --seeds 5 --set periphery.level=8
          foveate build --board vcu118 -o out --project
          foveate build --board vcu118 --preset paper -o out")]
pub(crate) struct BuildArgs {
    /// Board to build for: the name of a board that comes with the program, or a file (.toml)
    #[arg(long, value_name = "NAME", required_unless_present = "list")]
    pub(crate) board: Option<String>,
    /// List the boards that come with the program
    #[arg(long, conflicts_with_all = ["board", "output", "config", "preset", "overrides", "seeds", "project", "force"])]
    pub(crate) list: bool,
    /// Configuration file (TOML) that replaces the one of the board. It describes a core on AXI,
    /// or, for a board with a pattern in place of a sensor (vcu118), an array of RPUs
    #[arg(long, short, value_name = "FILE", conflicts_with = "preset")]
    pub(crate) config: Option<PathBuf>,
    /// Preset that replaces the configuration of the board, for example paper, an array of RPUs
    #[arg(long, value_name = "NAME")]
    pub(crate) preset: Option<String>,
    /// Change one key of the configuration, for example periphery.level=8
    #[arg(long = "set", value_name = "KEY=TOML_VALUE")]
    pub(crate) overrides: Vec<String>,
    /// Folder to write
    #[arg(long, short, value_name = "DIR", required_unless_present = "list")]
    pub(crate) output: Option<PathBuf>,
    /// Replace the folder if it holds a project of a board
    #[arg(long)]
    pub(crate) force: bool,
    /// Write the project only, and run no tool
    #[arg(long, conflicts_with = "seeds")]
    pub(crate) project: bool,
    /// Number of placements, each with another seed; the fastest is packed
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = at_least_one())]
    pub(crate) seeds: u32,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress, and print no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
}
