// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options for the clock of a core and the sink of its words ([`ClockArgs`]).

use super::check::ClockFrequency;
use crate::error::CliError;
use clap::{Args, ValueEnum};
use foveate_simulator::{ClockOptions, read_stalls};
use foveate_timed::SinkPattern;
use std::path::PathBuf;

/// The options of the tables of clocks.
#[derive(Args, Debug)]
#[command(next_help_heading = "Clocks")]
pub(crate) struct ClockArgs {
    /// Write a table of the clocks at which the core decides regions, sends their words and loses
    /// them; separate several formats with commas
    #[arg(long, value_enum, value_name = "FORMATS", value_delimiter = ',', num_args = 0..=1, require_equals = true, default_missing_value = "csv")]
    pub(crate) clocks: Vec<ClockFormat>,
    /// Clock of the core, for example 100MHz: each frame comes at its time in the clip; without a
    /// clock, each frame follows the one before without a pause
    #[arg(long, value_name = "FREQUENCY", value_parser = ClockFrequency::parse, requires = "clocks")]
    pub(crate) clock: Option<ClockFrequency>,
    /// Words that the sink takes in a number of clocks, for example 1/4; a raster core waits for
    /// its sink, and loses regions that wait too long [default: 1/1]
    #[arg(long, value_name = "WORDS/CLOCKS", value_parser = parse_rate, requires = "clocks")]
    pub(crate) sink_rate: Option<SinkPattern>,
    /// CSV table of the stalls of the sink, with the columns `clock` (the first clock at which the
    /// sink takes no word) and `clocks` (the number of these clocks)
    #[arg(long, value_name = "FILE", requires = "clocks", conflicts_with = "sink_rate")]
    pub(crate) sink_stalls: Option<PathBuf>,
}

/// The file formats of the table.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum ClockFormat {
    Csv,
    Parquet,
    Npy,
}

/// Reads the rate of a sink.
fn parse_rate(text: &str) -> Result<SinkPattern, String> {
    let numbers: Option<(u32, u32)> = text
        .split_once('/')
        .and_then(|(words, clocks)| words.parse().ok().zip(clocks.parse().ok()));
    numbers
        .and_then(|(words, clocks)| SinkPattern::from_rate(words, clocks))
        .ok_or_else(|| "expected words per clocks, at most 1/1, for example 1/4".to_owned())
}

impl ClockArgs {
    /// Returns the options of the run.
    pub(crate) fn options(&self) -> Result<ClockOptions, CliError> {
        let sink = match &self.sink_stalls {
            Some(path) => SinkPattern::Stalls(read_stalls(path)?.into()),
            None => self.sink_rate.clone().unwrap_or_default(),
        };
        Ok(ClockOptions {
            csv: self.clocks.contains(&ClockFormat::Csv),
            parquet: self.clocks.contains(&ClockFormat::Parquet),
            npy: self.clocks.contains(&ClockFormat::Npy),
            clock_hz: self.clock.map(|clock| clock.0),
            sink,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_words_per_clocks() {
        assert_eq!(parse_rate("1/4"), Ok(SinkPattern::Rate { words: 1, clocks: 4 }));
        assert_eq!(parse_rate("0/1"), Ok(SinkPattern::Rate { words: 0, clocks: 1 }));
        for wrong in ["", "1", "2/1", "1/0", "-1/4", "1/4/4", "0.5/1"] {
            assert!(parse_rate(wrong).is_err(), "{wrong}");
        }
    }
}
