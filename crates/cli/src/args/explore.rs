// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate explore`.

use std::path::PathBuf;

use clap::Args;
use foveate_explore::Disturbance;

use super::check::FramesPerSecond;
use super::input::InputArgs;
use super::process::ProcessArgs;
use super::threads::ThreadArgs;

/// Measure many designs over clips: error against the ideal camera, area, speed, Pareto fronts
///
/// Writes points.csv, points.parquet, clips.csv, a configuration for every point and report.html:
/// first when the errors are known, and again as areas arrive. Finished results stay in the folder:
/// if you run the same command again after an interrupt, or with a larger space, it computes only
/// what is missing.
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate explore approximations scene:street -o out
          foveate explore space.toml street.mp4 bus.mp4 -o out --resize 640x360
          foveate explore designs street.mp4 -o out --max-frames 60 --no-area
          foveate explore designs street.mp4 -o out --energy 30 --liberty
          foveate explore space.toml street.mp4 -o out --plan > plan.jsonl
          foveate explore --list
          foveate explore approximations --print > space.toml")]
pub(crate) struct ExploreArgs {
    /// File that describes the space of designs, or the name of a space that comes with the program
    #[arg(value_name = "SPACE", required_unless_present = "list")]
    pub(crate) space: Option<PathBuf>,
    /// Clips or sets, as for `foveate simulate`; several scenes are allowed
    #[arg(value_name = "INPUT", required_unless_present_any = ["list", "print"])]
    pub(crate) inputs: Vec<PathBuf>,
    /// Folder to write, or to continue
    #[arg(long, short, value_name = "DIR", required_unless_present_any = ["list", "print"])]
    pub(crate) output: Option<PathBuf>,
    /// Show the designs a disturbed clip, while the ideal camera sees the clip as it is:
    /// noise=LEVELS, jpeg=QUALITY, flicker=LEVELS, gain=PERCENT, saturation=FACTOR, shake=PIXELS or
    /// still=LEVELS (the first frame, with noise)
    #[arg(long, value_name = "KIND=VALUE")]
    pub(crate) disturb: Option<Disturbance>,
    /// Skip synthesis; Yosys is then not needed
    #[arg(long, conflicts_with = "liberty")]
    pub(crate) no_area: bool,
    /// Print the units of work as JSON lines, for machines that share the folder, and measure
    /// nothing. A line has the name of the unit, its inputs, and the file that exists when the unit
    /// is done
    #[arg(long, conflicts_with_all = ["only", "list", "print", "json", "markdown", "liberty"])]
    pub(crate) plan: bool,
    /// Do one unit of --plan, given by its name or its whole line; only the inputs of that unit are
    /// needed. Without --only, the command does the missing units and writes the tables
    #[arg(long, value_name = "UNIT", conflicts_with_all = ["list", "print", "markdown", "liberty"])]
    pub(crate) only: Option<String>,
    /// List the spaces that come with the program
    #[arg(long, conflicts_with_all = ["space", "print", "json", "markdown", "liberty"])]
    pub(crate) list: bool,
    /// Print the file of a space that comes with the program
    #[arg(long, requires = "space", conflicts_with_all = ["json", "markdown", "liberty"])]
    pub(crate) print: bool,
    /// Print all points as JSON; with --only, print the unit
    #[arg(long, conflicts_with = "markdown")]
    pub(crate) json: bool,
    /// Print all points as a Markdown table
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Show no progress and no report; --json and --markdown still print
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) process: ProcessArgs,
    /// Measure the energy in the cells of --liberty, too, and the power at this frame rate. The
    /// gates of each design are simulated on the clips, which takes half a minute for a design of
    /// 784 RPUs
    #[arg(long, value_name = "RATE", value_parser = FramesPerSecond::parse, requires = "liberty", help_heading = "Silicon")]
    pub(crate) energy: Option<FramesPerSecond>,
    #[command(flatten)]
    pub(crate) input: InputArgs,
}
