// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards: device, clock, pins, sensor, and the design that stands there by default. One file of data each.

use std::path::{Path, PathBuf};

use foveate_design::{Config, Preset};
use foveate_toolchain::text::shown;
use serde::Deserialize;

use crate::sensor::Level;
use crate::{BoardError, Sensor, words};

/// The boards that come with the program: name and data.
const BOARDS: &[(&str, &str)] = &[
    ("icebreaker", include_str!("../boards/icebreaker.toml")),
    ("icesugar", include_str!("../boards/icesugar.toml")),
    ("upduino", include_str!("../boards/upduino.toml")),
    ("tang-nano-20k", include_str!("../boards/tang-nano-20k.toml")),
    ("ulx3s", include_str!("../boards/ulx3s.toml")),
    ("vcu118", include_str!("../boards/vcu118.toml")),
];

/// What takes the place of a sensor.
const PATTERN: &str = "pattern";

/// A board as its file says.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// What it is called on the command line.
    #[serde(skip)]
    pub name: String,
    /// What it is, for people.
    pub title: String,
    /// Where one reads about it.
    pub page: String,
    /// The name of its sensor; `pattern` for none.
    sensor: String,
    /// The command that loads a bitstream, before its file.
    pub flash: String,
    /// The device.
    pub device: Device,
    /// Its clock.
    pub clock: Clock,
    /// The serial line.
    pub serial: Serial,
    /// Lights.
    pub leds: Leds,
    /// Where the sensor is.
    pub pins: Option<SensorPins>,
    /// What stands there by default.
    design: Default,
    /// Its file, and the folder from which it names others.
    #[serde(skip)]
    pub(crate) text: String,
    #[serde(skip)]
    folder: PathBuf,
}

/// A device, and the tools that it needs.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// Its family.
    pub family: Family,
    /// The part, as its tool is told.
    pub part: String,
    /// The package (of Gowin, the die).
    pub package: String,
    /// The speed grade, of ECP5.
    pub speed: Option<u32>,
}

/// A family of devices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// Lattice iCE40 UltraPlus.
    Ice40,
    /// Lattice ECP5.
    Ecp5,
    /// Gowin GW2A and its kin.
    Gowin,
    /// What only Vivado knows.
    Vivado,
}

impl Family {
    /// The parts, of a family of which nextpnr has an option for each.
    fn parts(self) -> &'static [&'static str] {
        match self {
            Self::Ice40 => &[
                "lp384", "lp1k", "lp4k", "lp8k", "hx1k", "hx4k", "hx8k", "up3k", "up5k", "u1k",
                "u2k", "u4k",
            ],
            Self::Ecp5 => &[
                "12k", "25k", "45k", "85k", "um-25k", "um-45k", "um-85k", "um5g-25k", "um5g-45k",
                "um5g-85k",
            ],
            Self::Gowin | Self::Vivado => &[],
        }
    }

    /// How the file is called that is loaded into a device.
    pub(crate) fn extension(self) -> &'static str {
        match self {
            Self::Ice40 => "bin",
            Self::Ecp5 | Self::Vivado => "bit",
            Self::Gowin => "fs",
        }
    }
}

/// The clock of a board, and that of the core.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clock {
    /// Its pin, or both of a pair.
    pub pins: Vec<String>,
    /// The levels there, where the tool needs to know.
    pub standard: Option<String>,
    /// Its frequency.
    pub mhz: u32,
    /// The frequency of the core.
    pub core_mhz: u32,
    /// Whether the PLL takes its clock from that pin (iCE40).
    #[serde(default)]
    pub pll_pad: bool,
}

/// The serial line, seen from the device.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Serial {
    /// To the host.
    pub tx: String,
    /// From the host.
    pub rx: String,
    /// The levels there, where the tool needs to know.
    pub standard: Option<String>,
    /// Bits in a second.
    pub baud: u32,
}

/// Lights: the first blinks with frames, the second says that something is wrong.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leds {
    /// Their pins.
    pub pins: Vec<String>,
    /// The levels there, where the tool needs to know.
    pub standard: Option<String>,
    /// What lights them.
    pub lit: Level,
}

/// Pins of a sensor.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorPins {
    /// The clock that the sensor gets.
    pub xclk: String,
    /// The clock of its pixels.
    pub pclk: String,
    /// Between frames.
    pub vsync: String,
    /// Within a line.
    pub href: String,
    /// Clock of I2C.
    pub scl: String,
    /// Data of I2C.
    pub sda: String,
    /// Its reset, 0 resets.
    pub reset_n: Option<String>,
    /// 1 switches it off.
    pub power_down: Option<String>,
    /// Data lines, the lowest first.
    pub data: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Default {
    preset: String,
    set: Vec<String>,
}

impl Board {
    /// Every board that comes with the program.
    pub fn all() -> impl Iterator<Item = Self> {
        BOARDS.iter().map(|(name, text)| {
            Self::from_toml(name, text).unwrap_or_else(|error| unreachable!("{error}"))
        })
    }

    /// The board of that name, or in that file if the name ends in `.toml`.
    ///
    /// # Errors
    /// When there is none, or it is not valid.
    pub fn find(name: &str) -> Result<Self, BoardError> {
        let path = Path::new(name);
        if path.extension().is_some_and(|extension| extension == "toml") {
            let text = foveate_reading::settings(path)
                .map_err(|source| BoardError::Read { path: path.to_owned(), source })?;
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            return Self::read(&stem, &text, path.parent().unwrap_or(Path::new("")));
        }
        match BOARDS.iter().find(|board| board.0 == name) {
            Some((name, text)) => Self::from_toml(name, text),
            None => {
                let known: Vec<_> = BOARDS.iter().map(|board| board.0).collect();
                Err(BoardError::Board { name: shown(name), known: known.join(", ") })
            }
        }
    }

    /// Reads a board and checks it.
    ///
    /// # Errors
    /// When it is not valid.
    pub fn from_toml(name: &str, text: &str) -> Result<Self, BoardError> {
        Self::read(name, text, Path::new(""))
    }

    fn read(name: &str, text: &str, folder: &Path) -> Result<Self, BoardError> {
        let invalid = |reason: String| BoardError::Invalid { name: shown(name), reason };
        words::check_name(name).map_err(invalid)?;
        let no_board = |error: toml::de::Error| invalid(error.to_string().trim_end().to_owned());
        words::check(&text.parse().map_err(no_board)?).map_err(invalid)?;
        let mut board: Self = toml::from_str(text).map_err(no_board)?;
        name.clone_into(&mut board.name);
        text.clone_into(&mut board.text);
        folder.clone_into(&mut board.folder);
        board.check().map_err(invalid)?;
        Ok(board)
    }

    /// The sensor and its pins; nothing where a pattern takes its place.
    ///
    /// # Errors
    /// When there is no such sensor, or it has no pins.
    pub fn eye(&self) -> Result<Option<(Sensor, SensorPins)>, BoardError> {
        if self.sensor == PATTERN {
            return Ok(None);
        }
        let sensor = Sensor::find(&self.sensor, &self.folder)?;
        let pins = self.pins.clone().ok_or_else(|| BoardError::Invalid {
            name: self.name.clone(),
            reason: format!("`{}` needs [pins]", self.sensor),
        })?;
        Ok(Some((sensor, pins)))
    }

    /// The configuration that stands there by default.
    ///
    /// # Errors
    /// When it is none.
    pub fn config(&self) -> Result<Config, BoardError> {
        let mut set = vec!["hardware.interface='axi'".to_owned()];
        set.extend(self.design.set.iter().cloned());
        let preset = Preset::find(&self.design.preset)?;
        Ok(Config::from_toml_with(preset.toml, &set)?)
    }

    /// Clocks of a bit on the serial line.
    pub(crate) fn divisor(&self) -> u32 {
        (self.clock.core_mhz * 1_000_000 + self.serial.baud / 2) / self.serial.baud
    }

    fn check(&self) -> Result<(), String> {
        self.check_part()?;
        Preset::find(&self.design.preset).map_err(|error| format!("design.preset: {error}"))?;
        let design = self.config().map_err(|error| format!("design.set: {error}"))?;
        design.validate().map_err(|error| format!("design.set: {error}"))?;
        let eye = self.eye().map_err(|error| error.to_string())?;
        if let Some((sensor, pins)) = &eye {
            self.check_sensor(sensor, pins)?;
        }
        let lights = if eye.is_some() { 2 } else { 3 };
        if self.leds.pins.len() < lights {
            return Err(format!(
                "leds.pins has {} pins; {lights} are needed",
                self.leds.pins.len()
            ));
        }
        let is_closed = self.device.family == Family::Vivado;
        if is_closed && eye.is_some() {
            return Err(format!("device.family = vivado takes sensor = \"{PATTERN}\" alone"));
        }
        let wires = if is_closed { 2 } else { 1 };
        if self.clock.pins.len() != wires {
            let pins = self.clock.pins.len();
            return Err(format!("clock.pins has {pins} pins; {wires} are needed"));
        }
        if (self.device.family == Family::Ecp5) != self.device.speed.is_some() {
            return Err("device.speed is for ECP5, which needs it".to_owned());
        }
        if !(1..=1000).contains(&self.clock.core_mhz) || !(1..=1000).contains(&self.clock.mhz) {
            return Err("clocks are 1 to 1000 MHz".to_owned());
        }
        self.check_baud()
    }

    /// A part is an option of nextpnr where that knows a family by its parts: no other option may take its place.
    fn check_part(&self) -> Result<(), String> {
        let (known, part) = (self.device.family.parts(), &self.device.part);
        if known.is_empty() || known.contains(&part.as_str()) {
            return Ok(());
        }
        Err(format!("device.part = \"{part}\": this family has {}", known.join(", ")))
    }

    /// Its pins must be those of the sensor, its clock within limits, and the core fast enough.
    fn check_sensor(&self, sensor: &Sensor, pins: &SensorPins) -> Result<(), String> {
        let name = &self.sensor;
        let (lines, pins) = (sensor.format.lines(), pins.data.len());
        if pins != lines {
            return Err(format!("pins.data has {pins} pins; `{name}` has {lines} data lines"));
        }
        let (xclk, [least, most]) = (f64::from(self.clock.mhz), sensor.xclk_mhz);
        if !(least..=most).contains(&xclk) {
            return Err(format!("clock.mhz = {xclk}: `{name}` takes {least} to {most} MHz"));
        }
        let pixels = xclk * sensor.pclk_per_xclk / f64::from(sensor.format.edges());
        if pixels > f64::from(self.clock.core_mhz) {
            let core = self.clock.core_mhz;
            return Err(format!(
                "clock.core_mhz = {core}: `{name}` sends up to {pixels} million pixels in a second"
            ));
        }
        Ok(())
    }

    /// The rate must come out of the clock: a receiver takes the middle of ten bits.
    fn check_baud(&self) -> Result<(), String> {
        let baud = self.serial.baud;
        let clock = self.clock.core_mhz * 1_000_000;
        if baud == 0 || baud > clock / 4 {
            return Err(format!("serial.baud = {baud}: 1 to {} can be made", clock / 4));
        }
        let divisor = self.divisor();
        let off = (f64::from(clock) / f64::from(divisor) / f64::from(baud) - 1.0).abs();
        if off > 0.02 {
            let near = clock / divisor;
            return Err(format!(
                "serial.baud = {baud}: {clock} Hz / {divisor} is {near}, more than 2 % off"
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_board_is_valid_and_has_a_design_on_axi() {
        for board in Board::all() {
            let design = board.config().unwrap().validate().unwrap();
            assert!(design.is_on_axi(), "{}", board.name);
        }
    }

    #[test]
    fn what_is_wrong_with_a_board_is_said() {
        let good = BOARDS[0].1;
        for (from, to, said) in [
            ("\"28\"]", "]", "8 data lines"),
            ("core_mhz = 24", "core_mhz = 2", "million pixels"),
            ("core_mhz = 24", "core_mhz = 10", "serial.baud"),
            ("baud = 3_000_000", "baud = 2_500_000", "more than 2 % off"),
            ("mhz = 12\n", "mhz = 60\n", "takes 10 to 48 MHz"),
            ("mhz = 12\n", "mhz = 48\n", ""),
            ("pins = [\"35\"]", "pins = []", "1 are needed"),
            ("[\"37\", \"11\"]", "[\"37\"]", "2 are needed"),
            ("family = \"ice40\"", "family = \"ice41\"", "unknown variant `ice41`"),
            ("package = \"sg48\"", "package = \"sg48\"\nspeed = 6", "device.speed"),
            ("sensor = \"ov7670-qvga\"", "sensor = \"ov7671\"", "no sensor `ov7671`"),
            ("family = \"ice40\"", "family = \"vivado\"", "\"pattern\" alone"),
            ("xclk = \"47\"", "xlck = \"47\"", "unknown field `xlck`"),
        ] {
            assert!(good.contains(from), "{from}");
            let text = good.replace(from, to);
            match Board::from_toml("mine", &text) {
                Ok(_) => assert!(said.is_empty(), "{to} is taken"),
                Err(error) => {
                    let error = error.to_string();
                    assert!(!said.is_empty() && error.contains(said), "{to}: {error}");
                }
            }
        }
        let error = Board::find("nexys").unwrap_err().to_string();
        assert!(error.contains("icebreaker"), "{error}");
    }
}
