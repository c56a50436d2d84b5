// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate check`, and the parsing of clocks and frame rates.

use std::fmt;
use std::path::PathBuf;

use clap::Args;
use foveate_camera::Decimal;
use foveate_explore::link::LinkRate;

use super::DesignArgs;
use super::input::InputArgs;

/// Check a configuration and print the design that it describes: grid, widths, clocks, ports
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate check camera.toml
          foveate check --preset serial --min-fps 1000 --clock 50MHz
          foveate check --preset raster --clip scene:street --frames 30 --link 10Mbit",
    mut_group("InputArgs", |group| group.requires("clip")))]
pub(crate) struct CheckArgs {
    /// Configuration file (TOML), or - for standard input; the same as --config
    #[arg(value_name = "FILE", conflicts_with_all = ["config", "preset"])]
    pub(crate) file: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Clock of the design, for example 100MHz or 1.5GHz, for frame rates and for --clip. Without
    /// it, the clock that a frame rate needs is printed; `foveate estimate` says what clock to
    /// expect
    #[arg(long, value_name = "FREQUENCY", value_parser = ClockFrequency::parse)]
    pub(crate) clock: Option<ClockFrequency>,
    /// With --clock, check that the design reaches this many frames per second; the exit code is 1
    /// if it does not. For a serial design, also propose the largest fold that reaches it. Without
    /// --clock, print the clock that this rate needs
    #[arg(long, value_name = "RATE", value_parser = FramesPerSecond::parse)]
    pub(crate) min_fps: Option<FramesPerSecond>,
    /// Clip that the design is for, as one input of `foveate simulate`. Print which clock keeps up
    /// with it, and the latency and the buffer in front of a link; for a raster design also the
    /// regions that are lost without that buffer. With --clock, the exit code is 1 if it does not
    /// keep up; without it, times leave out the array's clocks, whose number is printed
    #[arg(long, value_name = "INPUT")]
    pub(crate) clip: Option<PathBuf>,
    /// Rate of the link behind the design in bits per second, for example 100Mbit or 1.5Gbit
    #[arg(long, value_name = "RATE", default_value = "100Mbit", value_parser = LinkRate::parse, requires = "clip")]
    pub(crate) link: LinkRate,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print only errors; the exit code says whether the design is valid, and at --clock whether it
    /// is fast enough for --min-fps and for --clip
    #[arg(long, short, conflicts_with = "json")]
    pub(crate) quiet: bool,
    /// The options for reading the clip. They are last, because clap lists later options under
    /// their heading.
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

/// The frequency of a clock in Hz, 1..=10^12.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClockFrequency(pub(crate) u64);

/// The names of the units, largest first, with their values in Hz.
const FREQUENCY_UNITS: [(&str, u64); 4] =
    [("GHz", 1_000_000_000), ("MHz", 1_000_000), ("kHz", 1000), ("Hz", 1)];

impl ClockFrequency {
    const MAX: u64 = 1_000_000_000_000;

    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (number, unit) = text.split_at(split);
        let unit = match unit {
            "" => Some(1),
            unit => FREQUENCY_UNITS
                .iter()
                .find(|(name, _)| unit.eq_ignore_ascii_case(name))
                .map(|u| u.1),
        };
        let hertz = unit.and_then(|unit| Some(parse_decimal_or_none(number)?.ceil_times(unit)));
        hertz
            .and_then(|hertz| u64::try_from(hertz).ok())
            .filter(|hertz| (1..=Self::MAX).contains(hertz))
            .map(Self)
            .ok_or_else(|| "expected 1Hz to 1000GHz, for example 100MHz".to_owned())
    }
}

impl fmt::Display for ClockFrequency {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, unit) =
            FREQUENCY_UNITS.iter().find(|(_, unit)| self.0 >= *unit).unwrap_or(&("Hz", 1));
        let fraction = format!("{:09}", self.0 % unit * (1_000_000_000 / unit));
        let fraction = fraction.trim_end_matches('0');
        let point = if fraction.is_empty() { "" } else { "." };
        write!(f, "{}{point}{fraction} {name}", self.0 / unit)
    }
}

/// A frame rate in frames per second, above 0 and at most 10^9.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FramesPerSecond(pub(crate) Decimal);

impl FramesPerSecond {
    const NANO: u64 = 1_000_000_000;

    pub(super) fn parse(text: &str) -> Result<Self, String> {
        parse_decimal_or_none(text)
            .filter(|rate| (1..=1_000_000_000).contains(&rate.ceil_times(1)))
            .map(Self)
            .ok_or_else(|| "expected frames per second above 0, for example 1000".to_owned())
    }

    /// Returns the frames per second as a floating-point number.
    pub(crate) fn per_second(self) -> f64 {
        self.0.to_string().parse().expect("a decimal is written as a number")
    }

    /// Returns the slowest clock at which frames of `clocks` clocks each reach this rate.
    pub(crate) fn required_clock(self, clocks: u64) -> ClockFrequency {
        ClockFrequency(u64::try_from(self.0.ceil_times(clocks)).unwrap_or(u64::MAX))
    }

    /// Returns the largest number of clocks that a frame may take.
    pub(crate) fn max_clocks(self, clock: ClockFrequency) -> u64 {
        let clocks = u128::from(clock.0) * u128::from(Self::NANO) / self.0.ceil_times(Self::NANO);
        u64::try_from(clocks).unwrap_or(u64::MAX)
    }
}

fn parse_decimal_or_none(text: &str) -> Option<Decimal> {
    text.trim().parse().ok().and_then(Decimal::from_f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_are_read_and_shown() {
        for (text, hertz, shown) in [
            ("250MHz", 250_000_000, "250 MHz"),
            ("1.5GHz", 1_500_000_000, "1.5 GHz"),
            ("48 kHz", 48_000, "48 kHz"),
            ("100000000", 100_000_000, "100 MHz"),
            ("33.333333mhz", 33_333_333, "33.333333 MHz"),
            ("7Hz", 7, "7 Hz"),
        ] {
            let clock = ClockFrequency::parse(text).unwrap();
            assert_eq!((clock.0, clock.to_string().as_str()), (hertz, shown));
        }
        for text in ["", "MHz", "0", "-1MHz", "5 megahertz", "nan", "1e30", "2000GHz"] {
            assert!(ClockFrequency::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_clock_that_a_rate_needs_is_the_slowest_that_reaches_it() {
        for (rate, clocks, needed) in
            [("1000", 64, 64_000), ("29.97", 7905, 236_913), ("0.001", 7, 1), ("3", 1, 3)]
        {
            let rate = FramesPerSecond::parse(rate).unwrap();
            assert_eq!(rate.required_clock(clocks).0, needed);
            assert!(rate.max_clocks(rate.required_clock(clocks)) >= clocks);
            assert!(rate.max_clocks(ClockFrequency(needed - 1)) < clocks);
        }
    }

    #[test]
    fn a_rate_allows_whole_clocks() {
        let clocks =
            |rate| FramesPerSecond::parse(rate).unwrap().max_clocks(ClockFrequency(250_000_000));
        assert_eq!(
            (clocks("1000"), clocks("3"), clocks("29.97")),
            (250_000, 83_333_333, 8_341_675)
        );
        for text in ["0", "-1", "inf", "many", "1e10"] {
            assert!(FramesPerSecond::parse(text).is_err(), "{text}");
        }
    }
}
