// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line as clap sees it, and the design that its options describe.

mod analyze;
mod bench;
mod build;
mod check;
mod clocks;
mod dataset;
mod decode;
#[cfg(test)]
mod examples;
mod explain;
mod explore;
mod fit;
mod frames;
mod infer;
mod input;
mod link;
mod live;
mod outputs;
#[cfg(test)]
mod page;
mod process;
mod stress;
mod threads;
mod view;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::builder::RangedI64ValueParser;
use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};
use clap_complete::Shell;
use foveate_camera::ConfigError;
use foveate_design::{Design, DesignConfig, Preset};
use foveate_estimate::{ROUTE_DEVICES, RouteDevice};
use foveate_media::read_class_map;

use self::input::InputArgs;
use self::threads::ThreadArgs;
use crate::error::CliError;
pub(crate) use analyze::AnalyzeArgs;
pub(crate) use bench::BenchArgs;
pub(crate) use build::BuildArgs;
pub(crate) use check::{CheckArgs, ClockFrequency, FramesPerSecond};
pub(crate) use clocks::ClockArgs;
pub(crate) use dataset::DatasetArgs;
pub(crate) use decode::DecodeArgs;
pub(crate) use explain::ExplainArgs;
pub(crate) use explore::ExploreArgs;
pub(crate) use fit::FitArgs;
pub(crate) use infer::InferArgs;
pub(crate) use input::{
    check_output, refuse_second_reader, refuse_several_clips, warn_about_inputs,
};
pub(crate) use link::LinkArgs;
pub(crate) use live::LiveArgs;
pub(crate) use outputs::OutputArgs;
pub(crate) use process::ProcessArgs;
pub(crate) use stress::StressArgs;
pub(crate) use view::ViewArgs;

/// Region-based event cameras: bit-accurate model, Verilog, co-simulation, area and simulation.
#[derive(Debug, Parser)]
#[command(
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 fine, 1 mismatch or failed check, 2 bad usage or input, 3 a tool is missing or failed, 130 Ctrl-C, 143 SIGTERM, 129 SIGHUP."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Check(CheckArgs),
    Generate(GenerateArgs),
    Build(BuildArgs),
    Cosim(CosimArgs),
    Estimate(EstimateArgs),
    Simulate(SimulateArgs),
    Dataset(DatasetArgs),
    Decode(DecodeArgs),
    View(ViewArgs),
    Live(LiveArgs),
    Explain(ExplainArgs),
    Analyze(AnalyzeArgs),
    Explore(ExploreArgs),
    Fit(Box<FitArgs>),
    Infer(InferArgs),
    Link(LinkArgs),
    Stress(Box<StressArgs>),
    Bench(BenchArgs),
    Presets(PresetsArgs),
    Features(FeaturesArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

/// The options that choose the design.
#[derive(Args, Debug)]
pub(crate) struct DesignArgs {
    /// Configuration file (TOML), or - for standard input
    #[arg(long, short, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// Design to start from; see `foveate presets`
    #[arg(long, short, value_name = "NAME", conflicts_with = "config")]
    pub(crate) preset: Option<String>,
    /// Change one key of the file or preset, for example region.size=16 or spatial.0.level=50
    #[arg(long = "set", value_name = "KEY=TOML_VALUE")]
    pub(crate) overrides: Vec<String>,
}

impl DesignArgs {
    /// Returns the configuration of a task: that of a file, or preset `paper`.
    pub(crate) fn task(file: Option<&Path>) -> Result<DesignConfig, CliError> {
        let preset = file.is_none().then(|| "paper".to_owned());
        Self { config: file.map(Path::to_owned), preset, overrides: Vec::new() }.config()
    }

    /// Returns the configuration with the changes of `--set`. Without a file or a preset, it starts
    /// from the defaults.
    pub(crate) fn config(&self) -> Result<DesignConfig, CliError> {
        let text = self.text()?;
        let mut config = DesignConfig::from_toml_with(&text, &self.overrides)
            .map_err(|error| self.config_error(&text, error))?;
        read_class_map(&mut config.camera, self.config.as_deref(), &self.overrides)?;
        Ok(config)
    }

    /// Returns the validated design. If the frame has no size, it is that of the paper, and classes
    /// of regions must fit it.
    pub(crate) fn design(&self) -> Result<Design, CliError> {
        let config = self.config()?;
        let (width, height) = config.camera.frame.size_or_default();
        let design = match &config.camera.zones {
            Some(_) => config.validate_for_frames(width, height),
            None => config.validate(),
        };
        design.or_else(|error| Err(self.config_error(&self.text()?, error)))
    }

    /// Returns the validated design for frames of `width` x `height` pixels.
    pub(crate) fn design_for_frames(&self, width: u32, height: u32) -> Result<Design, CliError> {
        let config = self.config()?;
        let design = config.validate_for_frames(width, height);
        design.or_else(|error| Err(self.config_error(&self.text()?, error)))
    }

    fn text(&self) -> Result<String, CliError> {
        Ok(match (&self.config, &self.preset) {
            (Some(file), _) => {
                settings(file).map_err(CliError::io("read the configuration", &named(file)))?
            }
            (None, Some(name)) => Preset::find(name)?.toml.to_owned(),
            (None, None) => String::new(),
        })
    }

    /// Returns the error for the user. It names the file if the configuration is wrong without the
    /// changes of `--set`, too.
    fn config_error(&self, text: &str, error: ConfigError) -> CliError {
        let alone = DesignConfig::from_toml(text).and_then(|mut config| {
            // The image of a map has been read, so the fault is not in it.
            config.camera.zones.iter_mut().for_each(|zones| zones.map = None);
            config.validate()
        });
        let file = self.config.as_deref().filter(|_| alone.is_err()).map(named);
        CliError::Config { file, error }
    }
}

/// Returns the name of a configuration file in messages.
fn named(file: &Path) -> PathBuf {
    if file == Path::new("-") { "standard input".into() } else { file.to_owned() }
}

/// Returns the text of a configuration file. Standard input is read once, and its text is kept.
fn settings(file: &Path) -> std::io::Result<String> {
    static STANDARD_INPUT: OnceLock<String> = OnceLock::new();
    if file != Path::new("-") {
        return foveate_tools::read_settings(file);
    }
    if let Some(text) = STANDARD_INPUT.get() {
        return Ok(text.clone());
    }
    let text = foveate_tools::settings_from(std::io::stdin().lock())?;
    Ok(STANDARD_INPUT.get_or_init(|| text).clone())
}

/// Write the Verilog of a design, with file lists, constraints, benches and a README
#[derive(Args, Debug)]
#[command(after_help = "Example: foveate generate --preset paper --set region.size=16 -o core16")]
pub(crate) struct GenerateArgs {
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write; if it exists, it must be empty
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Replace the folder if it holds a generated core
    #[arg(long)]
    pub(crate) force: bool,
    /// Put NAME_ before the names of all modules, so that several cores fit into one chip. Without
    /// a NAME, or with `auto`, the prefix is made from the fingerprint of the design
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "auto")]
    pub(crate) prefix: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Run the same vectors through model and RTL, and compare every output at every clock
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate cosim --preset bare
          foveate cosim --level rcm --grid 4x3 photo.png
          foveate cosim --full scene:street
          foveate cosim --config core/design.toml --rtl core/rtl
          foveate cosim --level rcm --grid 3x2 --netlist
          foveate cosim --config core/design.toml --rtl core/rtl clip.mp4 --packets packets.bin
          foveate cosim --preset raster --set \"hardware.interface='axi'\" clip.mp4 --end-to-end out")]
pub(crate) struct CosimArgs {
    /// Frames to run in addition to the directed and random ones: images, folders, globs,
    /// scene:NAME
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Part to simulate: `rpu` is one RPU that gets every region in turn, `rcm` an array, and `axi`
    /// a core on AXI, whose packets are compared. The default is `rpu`, together with `axi` if the
    /// design is a core on AXI. With --rtl the default also covers the array and, for serial and
    /// raster designs, the whole frame; a file, or a module with parameter values, that none of
    /// these parts contains is then an error
    #[arg(long, value_enum)]
    pub(crate) level: Option<DesignPart>,
    /// Regions of the array for --level rcm, columns x rows. The default is 3x2, or more if two
    /// lanes need more regions, but at most the grid of the frame
    #[arg(long, value_name = "CxR", value_parser = parse_grid)]
    pub(crate) grid: Option<(u32, u32)>,
    /// Simulate the whole array of the design
    #[arg(long, conflicts_with_all = ["level", "grid"])]
    pub(crate) full: bool,
    /// Simulator to run
    #[arg(long, value_enum, default_value_t = SimulatorChoice::Verilator)]
    pub(crate) simulator: SimulatorChoice,
    /// Simulate the netlist that Yosys makes of the Verilog, the one that `estimate` counts, in
    /// Icarus
    #[arg(long, conflicts_with = "simulator")]
    pub(crate) netlist: bool,
    /// Check the Verilog files of this folder instead of freshly generated ones
    #[arg(long, value_name = "DIR")]
    pub(crate) rtl: Option<PathBuf>,
    /// Choose the core of this prefix, if the folder of --rtl has several; a single one is found
    /// without it
    #[arg(long, value_name = "NAME", requires = "rtl")]
    pub(crate) prefix: Option<String>,
    /// Seed of the random vectors
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Take at most this many frames of the inputs
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = at_least_one())]
    pub(crate) frames: u32,
    /// Number of runs of the directed sequences, each with different data; 0 runs only the frames
    /// of the inputs. The default is 3 for one RPU and 1 for all other parts
    #[arg(long, value_name = "N")]
    pub(crate) rounds: Option<u32>,
    /// Write the packets that leave a core on AXI while the frames of the inputs enter it, for
    /// `foveate decode`
    #[arg(long, value_name = "FILE", requires = "inputs")]
    pub(crate) packets: Option<PathBuf>,
    /// Write the packets of a core on AXI into this folder as packets.bin, together with the frames
    /// that `decode` makes of them and the results of `simulate` for the same frames, and compare
    /// the two
    #[arg(long, value_name = "DIR", requires = "inputs", conflicts_with = "packets")]
    pub(crate) end_to_end: Option<PathBuf>,
    /// Folder to write if a run fails; its script repeats the mismatch. An earlier replay folder is
    /// replaced if nothing was added to it or changed in it
    #[arg(long, value_name = "DIR", default_value = "foveate-replay")]
    pub(crate) replay: PathBuf,
    /// Record waves (FST) of a failing run in its replay folder
    #[arg(long)]
    pub(crate) trace: bool,
    /// Write the results as JUnit XML, for a CI server
    #[arg(long, value_name = "FILE")]
    pub(crate) junit: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress, and print only runs with a mismatch
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// The part of a design that is simulated or placed.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum DesignPart {
    Rpu,
    Rcm,
    Axi,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum SimulatorChoice {
    Verilator,
    Iverilog,
}

/// The library of Debian's package `qflow-tech-osu018`.
pub(crate) const DEFAULT_LIBERTY: &str = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib";

/// Synthesize a design with Yosys, and print its area and logic levels beside the paper's
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate estimate --preset bare
          foveate estimate --compare --markdown
          foveate estimate --preset bare --place-and-route ecp5-85k,up5k
          foveate estimate --preset bare --liberty
          foveate estimate --preset bare --liberty --activity street.mp4 --clock 1")]
pub(crate) struct EstimateArgs {
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Print one table of variants instead: the design in each organization, with each feature with
    /// and without the median, and with edge and each other filter
    #[arg(long)]
    pub(crate) compare: bool,
    /// List the modules of an RPU, a lane or a core, too, each synthesized apart. The JSON always
    /// has them
    #[arg(long, conflicts_with_all = ["compare", "place_and_route"])]
    pub(crate) modules: bool,
    /// Place and route the design with nextpnr instead, and print its use of these devices and the
    /// clock that it reaches
    #[arg(long, value_name = "DEVICE", value_delimiter = ',', value_parser = parse_device, conflicts_with = "compare")]
    pub(crate) place_and_route: Vec<&'static RouteDevice>,
    /// Number of placements, each with another seed
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = at_least_one(), requires = "place_and_route")]
    pub(crate) seeds: u32,
    /// Part to place: `rpu` is one RPU (for `serial` and `raster`, the smallest array), `rcm` the
    /// whole array, and `axi` a core on AXI. The default is `axi` if the design is a core on AXI,
    /// and `rpu` otherwise
    #[arg(long, value_enum, requires = "place_and_route")]
    pub(crate) level: Option<DesignPart>,
    /// Place the same Verilog for every device: for an ECP5, without the memories of that family
    /// (`FOVEATE_ECP5`)
    #[arg(long, requires = "place_and_route")]
    pub(crate) portable: bool,
    /// Map the design to the cells of a liberty file, plain or gzipped, and print its area on
    /// silicon, its longest path and its leakage. Without a file, the cells are those of Debian's
    /// package `qflow-tech-osu018`, of 0.18 um. Each further --liberty makes a further report
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = DEFAULT_LIBERTY, conflicts_with_all = ["compare", "place_and_route"])]
    pub(crate) liberty: Vec<PathBuf>,
    /// Liberty files of memory macros of the same voltage, for memories that are too large for
    /// flip-flops
    #[arg(long, value_name = "FILE", num_args = 1.., requires = "liberty")]
    pub(crate) macros: Vec<PathBuf>,
    /// Write the netlist, too, as Verilog with models of its cells. In a folder of its own,
    /// `foveate cosim --rtl` simulates it
    #[arg(long, value_name = "FILE", requires = "liberty")]
    pub(crate) netlist: Option<PathBuf>,
    /// Measure the energy, too: simulate the gates of one RPU or lane on the frames of this clip,
    /// and add up the energies of the library over all changes. The design takes the size of the
    /// clip
    #[arg(long, value_name = "CLIP", requires = "liberty")]
    pub(crate) activity: Option<PathBuf>,
    /// Take at most this many frames of the clip of --activity
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = at_least_one(), requires = "activity")]
    pub(crate) max_frames: u32,
    /// Frames per second for the power with --activity
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = at_least_one(), requires = "activity")]
    pub(crate) fps: u32,
    /// Largest memory in bits that becomes flip-flops
    #[arg(long, value_name = "BITS", default_value_t = 4096, requires = "liberty")]
    pub(crate) memory_limit: u64,
    /// Clock of the design in MHz, for frame rates, and for the power of a clock that runs always;
    /// without it, the clock that is estimated from the netlist is used
    #[arg(long, value_name = "MHZ", value_parser = at_least_one(), conflicts_with = "place_and_route")]
    pub(crate) clock: Option<u32>,
    /// Print JSON
    #[arg(long, conflicts_with = "markdown")]
    pub(crate) json: bool,
    /// Print Markdown tables
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

fn parse_device(name: &str) -> Result<&'static RouteDevice, String> {
    let names = || ROUTE_DEVICES.iter().map(|device| device.name).collect::<Vec<_>>().join(", ");
    RouteDevice::by_name(name).ok_or_else(|| format!("the devices are {}", names()))
}

/// Run a design over video or images, and write scores, decisions and rendered frames
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate simulate street.mp4 -o out --overlay
          foveate simulate scene:street -o out
          foveate simulate frames/ -o out --preset steady --events parquet
          foveate simulate clips/ -o out --input-fps 10 --resize 640x360
          foveate simulate train-images-idx3-ubyte.gz -o out --max-frames 1000
          ffmpeg -i street.mp4 -f yuv4mpegpipe - | foveate simulate - -o out")]
pub(crate) struct SimulateArgs {
    /// Video, images, folders, globs, IDX or CIFAR files, scene:NAME, v4l2:/dev/video0 or
    /// rtsp://HOST/PATH for a camera, - for YUV4MPEG2 on standard input. Several videos, or a
    /// folder of them, run as a batch
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Replace the folder if it holds a simulation
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    // The flattened groups are last, because clap lists later options under the heading of the last
    // group.
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    pub(crate) outputs: OutputArgs,
    #[command(flatten)]
    pub(crate) clocks: ClockArgs,
}

/// List the designs that come with the program, or print one as a file
#[derive(Args, Debug)]
#[command(after_help = "Example: foveate presets steady > camera.toml")]
pub(crate) struct PresetsArgs {
    /// Print this preset with every key
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// List the synthetic scenes instead
    #[arg(long, conflicts_with = "name")]
    pub(crate) scenes: bool,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// List the spatial features with their units, defaults and organizations
#[derive(Args, Debug)]
#[command(after_help = "Example: foveate features --json")]
pub(crate) struct FeaturesArgs {
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Print a completion script for a shell
#[derive(Args, Debug)]
#[command(after_help = "Example: foveate completions bash > /etc/bash_completion.d/foveate")]
pub(crate) struct CompletionsArgs {
    /// Shell that the script is for
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

/// Write the manual pages, one for each command
#[derive(Args, Debug)]
#[command(after_help = "Example: foveate man -o man/man1")]
pub(crate) struct ManArgs {
    /// Folder to write `foveate.1`, `foveate-check.1` ... into; pages of these names are replaced
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

fn at_least_one() -> RangedI64ValueParser<u32> {
    value_parser!(u32).range(1..)
}

fn parse_grid(text: &str) -> Result<(u32, u32), String> {
    let side = |part: &str| part.parse::<u32>().ok().filter(|&side| (1..=256).contains(&side));
    text.split_once('x')
        .and_then(|(columns, rows)| Some((side(columns)?, side(rows)?)))
        .ok_or_else(|| "expected COLUMNSxROWS, each 1 to 256, for example 4x3".to_owned())
}
