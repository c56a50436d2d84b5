// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `analyze`.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use foveate_explore::studies::Study;

use super::DesignArgs;
use super::input::InputArgs;
use super::threads::ThreadArgs;

/// Run one of the paper's studies over clips or sets, and write its table and charts
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate analyze temporal street.mp4 bus.mp4 -o out
          foveate analyze size clips/ -o out --max-frames 60 --resize 640x360
          foveate analyze redundancy photos/ -o out --images set --resize 224x224
          foveate analyze sensor frames/ -o out --rate 25 --sensor-events events.csv.gz --sensor-start 1000
          foveate analyze recall frames/ -o out --boxes gt.txt")]
pub(crate) struct AnalyzeArgs {
    /// Study to run
    #[arg(value_enum, value_name = "STUDY")]
    pub(crate) study: StudyChoice,
    /// Clips or sets, as for `foveate simulate`; several scenes are allowed. Each input becomes a
    /// line of the chart or a row of the table
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Replace the folder if it holds a study
    #[arg(long)]
    pub(crate) force: bool,
    /// For `sensor`: the sensor's own events, as CSV with the columns t_us, x, y, as .raw in EVT
    /// 2.0 or EVT 3.0, or as .aedat4; plain or gzipped
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor_events: Option<PathBuf>,
    /// For `sensor`: the time of the first frame on the clock of the events, in microseconds (0)
    #[arg(long, value_name = "T_US", requires = "sensor_events")]
    pub(crate) sensor_start: Option<u64>,
    /// Ground-truth boxes for `recall`: a gt.txt of MOT, JSON of COCO, CSV with the columns file,
    /// x0, y0, x1, y1, or a folder of YOLO files. Give one for all inputs, or one for each input in
    /// their order. A path that does not exist is looked for in the folder of every clip, and in
    /// the folder above it
    #[arg(long, value_name = "FILE")]
    pub(crate) boxes: Vec<PathBuf>,
    /// Print the table as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

/// A study as a value of the command line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StudyChoice(pub(crate) Study);

impl ValueEnum for StudyChoice {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [StudyChoice; Study::ALL.len()] = {
            let mut all = [StudyChoice(Study::Activity); Study::ALL.len()];
            let mut at = 0;
            while at < all.len() {
                all[at] = StudyChoice(Study::ALL[at]);
                at += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self.0 {
            Study::Activity => "Active, SRS and TRS share over time, one line per clip",
            Study::Temporal => "Active, SRS and TRS share of whole clips",
            Study::Redundancy => "Share of regions with SRS = 0, per set and feature",
            Study::MadHistogram => "Histogram of the mean absolute deviation of regions",
            Study::Size => "Active share against region sizes 4, 8, 16 and 32",
            Study::Threshold => "Active share against each threshold",
            Study::Sensor => "Rank correlation with the events of a real sensor, over regions",
            Study::Recall => {
                "Share of ground-truth objects whose regions are active, against bytes"
            }
        };
        Some(PossibleValue::new(self.0.name()).help(help))
    }
}
