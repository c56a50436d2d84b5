// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards: device, clock, pins, sensor, and the default design. Each board is one file of data.

use std::path::{Path, PathBuf};

use foveate_design::{DesignConfig, Preset};
use foveate_tools::escaping::message_excerpt;
use serde::Deserialize;

use crate::sensor::LogicLevel;
use crate::{BoardError, Sensor, text_forms};

/// The boards that come with the program: name and data.
const BOARDS: &[(&str, &str)] = &[
    ("icebreaker", include_str!("../boards/icebreaker.toml")),
    ("icesugar", include_str!("../boards/icesugar.toml")),
    ("upduino", include_str!("../boards/upduino.toml")),
    ("tang-nano-20k", include_str!("../boards/tang-nano-20k.toml")),
    ("ulx3s", include_str!("../boards/ulx3s.toml")),
    ("vcu118", include_str!("../boards/vcu118.toml")),
];

/// The name in place of a sensor for a board with a pattern.
const PATTERN: &str = "pattern";

/// A board, as its file describes it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// The name on the command line.
    #[serde(skip)]
    pub name: String,
    /// The full name, for people.
    pub title: String,
    /// The address of a page about the board.
    pub page: String,
    /// The name of its sensor, or `pattern` for a pattern in place of a sensor.
    sensor: String,
    /// The command that loads a bitstream, without the name of the file.
    pub flash: String,
    /// The device.
    pub device: BoardDevice,
    /// The clock of the board, and that of the core.
    pub clock: BoardClock,
    /// The serial line.
    pub serial: SerialLine,
    /// The LEDs.
    pub leds: BoardLeds,
    /// The pins of the sensor; `None` for a pattern.
    pub pins: Option<SensorPins>,
    design: DefaultDesign,
    /// The text of its file.
    #[serde(skip)]
    pub(crate) text: String,
    #[serde(skip)]
    folder: PathBuf,
}

/// A device, as its tools name it.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoardDevice {
    /// The family of the device.
    pub family: DeviceFamily,
    /// The name of the part for its tool.
    pub part: String,
    /// The package; for Gowin, the die.
    pub package: String,
    /// The speed grade, for ECP5 only.
    pub speed: Option<u32>,
}

/// A family of devices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DeviceFamily {
    /// Lattice iCE40 UltraPlus.
    Ice40,
    /// Lattice ECP5.
    Ecp5,
    /// Gowin GW2A and related devices.
    Gowin,
    /// Devices for which only Vivado makes bitstreams.
    Vivado,
}

impl DeviceFamily {
    /// Returns the part names of a family for which nextpnr has an option per part.
    fn part_names(self) -> &'static [&'static str] {
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

    /// Returns the extension of the file that is loaded into a device.
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
pub struct BoardClock {
    /// The pin of the clock, or both pins of a differential pair.
    pub pins: Vec<String>,
    /// The I/O standard, if the tool needs it.
    pub standard: Option<String>,
    /// The frequency in MHz.
    pub mhz: u32,
    /// The frequency of the core in MHz.
    pub core_mhz: u32,
    /// True if the PLL takes its clock directly from that pin (iCE40).
    #[serde(default)]
    pub pll_pad: bool,
}

/// The serial line, with directions as the device sees them.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SerialLine {
    /// The pin of the line to the host.
    pub tx: String,
    /// The pin of the line from the host.
    pub rx: String,
    /// The I/O standard, if the tool needs it.
    pub standard: Option<String>,
    /// The rate in bits per second.
    pub baud: u32,
}

/// The LEDs. The first blinks with the frames, and the second reports an error. With a pattern, a
/// third one reports that all sums were right.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoardLeds {
    /// The pins of the LEDs.
    pub pins: Vec<String>,
    /// The I/O standard, if the tool needs it.
    pub standard: Option<String>,
    /// The level that lights an LED.
    #[serde(rename = "lit")]
    pub lit_level: LogicLevel,
}

/// The pins of a sensor.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorPins {
    /// The clock for the sensor.
    pub xclk: String,
    /// The clock of the sensor's pixels.
    pub pclk: String,
    /// The signal between frames.
    pub vsync: String,
    /// The signal within a line.
    pub href: String,
    /// The clock of I2C.
    pub scl: String,
    /// The data of I2C.
    pub sda: String,
    /// The reset of the sensor, active low.
    pub reset_n: Option<String>,
    /// The power-down of the sensor, active high.
    pub power_down: Option<String>,
    /// The data lines, the lowest first.
    pub data: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
struct DefaultDesign {
    preset: String,
    set: Vec<String>,
}

impl Board {
    /// Returns every board that comes with the program.
    pub fn all() -> impl Iterator<Item = Self> {
        BOARDS.iter().map(|(name, text)| {
            Self::from_toml(name, text).unwrap_or_else(|error| unreachable!("{error}"))
        })
    }

    /// Returns the board with this name, or the board in the file with this path if the name ends
    /// in `.toml`.
    ///
    /// # Errors
    /// Fails if there is no such board, or if it is not valid.
    pub fn find(name: &str) -> Result<Self, BoardError> {
        let path = Path::new(name);
        if path.extension().is_some_and(|extension| extension == "toml") {
            let text = foveate_tools::read_settings(path)
                .map_err(|source| BoardError::Read { path: path.to_owned(), source })?;
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            return Self::read(&stem, &text, path.parent().unwrap_or(Path::new("")));
        }
        match BOARDS.iter().find(|board| board.0 == name) {
            Some((name, text)) => Self::from_toml(name, text),
            None => {
                let known: Vec<_> = BOARDS.iter().map(|board| board.0).collect();
                Err(BoardError::UnknownBoard {
                    name: message_excerpt(name),
                    known: known.join(", "),
                })
            }
        }
    }

    /// Reads a board and checks it.
    ///
    /// # Errors
    /// Fails if the board is not valid.
    pub fn from_toml(name: &str, text: &str) -> Result<Self, BoardError> {
        Self::read(name, text, Path::new(""))
    }

    fn read(name: &str, text: &str, folder: &Path) -> Result<Self, BoardError> {
        let invalid = |reason: String| BoardError::Invalid { name: message_excerpt(name), reason };
        text_forms::check_name(name).map_err(invalid)?;
        let invalid_toml =
            |error: toml::de::Error| invalid(error.to_string().trim_end().to_owned());
        text_forms::check_texts(&text.parse().map_err(invalid_toml)?).map_err(invalid)?;
        let mut board: Self = toml::from_str(text).map_err(invalid_toml)?;
        name.clone_into(&mut board.name);
        text.clone_into(&mut board.text);
        folder.clone_into(&mut board.folder);
        board.check().map_err(invalid)?;
        Ok(board)
    }

    /// Returns the sensor and its pins; `None` for a pattern.
    ///
    /// # Errors
    /// Fails if there is no such sensor, or if the board has no pins for it.
    pub fn sensor_with_pins(&self) -> Result<Option<(Sensor, SensorPins)>, BoardError> {
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

    /// Returns the default configuration of the board.
    ///
    /// # Errors
    /// Fails if the configuration is not valid.
    pub fn config(&self) -> Result<DesignConfig, BoardError> {
        let mut set = vec!["hardware.interface='axi'".to_owned()];
        set.extend(self.design.set.iter().cloned());
        let preset = Preset::find(&self.design.preset)?;
        Ok(DesignConfig::from_toml_with(preset.toml, &set)?)
    }

    /// Returns the number of clocks per bit on the serial line.
    pub(crate) fn baud_divisor(&self) -> u32 {
        (self.clock.core_mhz * 1_000_000 + self.serial.baud / 2) / self.serial.baud
    }

    fn check(&self) -> Result<(), String> {
        self.check_part()?;
        Preset::find(&self.design.preset).map_err(|error| format!("design.preset: {error}"))?;
        let design = self.config().map_err(|error| format!("design.set: {error}"))?;
        design.validate().map_err(|error| format!("design.set: {error}"))?;
        let sensor_and_pins = self.sensor_with_pins().map_err(|error| error.to_string())?;
        if let Some((sensor, pins)) = &sensor_and_pins {
            self.check_sensor(sensor, pins)?;
        }
        let needed_leds = if sensor_and_pins.is_some() { 2 } else { 3 };
        if self.leds.pins.len() < needed_leds {
            return Err(format!(
                "leds.pins has {} pins; {needed_leds} are needed",
                self.leds.pins.len()
            ));
        }
        let is_closed = self.device.family == DeviceFamily::Vivado;
        if is_closed && sensor_and_pins.is_some() {
            return Err(format!("device.family = vivado works only with sensor = \"{PATTERN}\""));
        }
        let needed_pins = if is_closed { 2 } else { 1 };
        if self.clock.pins.len() != needed_pins {
            let pins = self.clock.pins.len();
            return Err(format!("clock.pins has {pins} pins; {needed_pins} are needed"));
        }
        if (self.device.family == DeviceFamily::Ecp5) != self.device.speed.is_some() {
            return Err(
                "device.speed must be given for the family ecp5, and only for it".to_owned()
            );
        }
        if !(1..=1000).contains(&self.clock.core_mhz) || !(1..=1000).contains(&self.clock.mhz) {
            return Err("clock.mhz and clock.core_mhz must be 1 to 1000".to_owned());
        }
        self.check_baud()
    }

    /// Checks the name of the part. nextpnr selects a part of some families by an option with this
    /// name, so that any other text could be another option of nextpnr.
    fn check_part(&self) -> Result<(), String> {
        let (known, part) = (self.device.family.part_names(), &self.device.part);
        if known.is_empty() || known.contains(&part.as_str()) {
            return Ok(());
        }
        Err(format!(
            "device.part = \"{part}\" is not a part of this family; its parts are {}",
            known.join(", ")
        ))
    }

    /// Checks that the data pins are as many as those of the sensor, that the sensor may get the
    /// clock, and that the core is fast enough.
    fn check_sensor(&self, sensor: &Sensor, pins: &SensorPins) -> Result<(), String> {
        let name = &self.sensor;
        let (lines, pins) = (sensor.format.data_lines(), pins.data.len());
        if pins != lines {
            return Err(format!("pins.data has {pins} pins; `{name}` has {lines} data lines"));
        }
        let (xclk, [least, most]) = (f64::from(self.clock.mhz), sensor.xclk_mhz);
        if !(least..=most).contains(&xclk) {
            return Err(format!("clock.mhz = {xclk}: `{name}` takes {least} to {most} MHz"));
        }
        let pixels = xclk * sensor.pclk_per_xclk / f64::from(sensor.format.edges_per_pixel());
        if pixels > f64::from(self.clock.core_mhz) {
            let core = self.clock.core_mhz;
            return Err(format!(
                "clock.core_mhz = {core} is too slow: `{name}` sends up to {pixels} million pixels per second"
            ));
        }
        Ok(())
    }

    /// Checks that the rate can be made from the clock within 2 %, because a receiver samples the
    /// middle of ten bits.
    fn check_baud(&self) -> Result<(), String> {
        let baud = self.serial.baud;
        let clock = self.clock.core_mhz * 1_000_000;
        if baud == 0 || baud > clock / 4 {
            return Err(format!(
                "serial.baud = {baud} cannot be made from the clock; the valid range is 1 to {}",
                clock / 4
            ));
        }
        let divisor = self.baud_divisor();
        let deviation = (f64::from(clock) / f64::from(divisor) / f64::from(baud) - 1.0).abs();
        if deviation > 0.02 {
            let actual_rate = clock / divisor;
            return Err(format!(
                "serial.baud = {baud}: {clock} Hz / {divisor} is {actual_rate}, more than 2 % off"
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
    fn an_error_names_the_fault_of_a_board() {
        let good = BOARDS[0].1;
        for (from, to, expected) in [
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
            ("sensor = \"ov7670-qvga\"", "sensor = \"ov7671\"", "unknown sensor `ov7671`"),
            ("family = \"ice40\"", "family = \"vivado\"", "works only with sensor = \"pattern\""),
            ("xclk = \"47\"", "xlck = \"47\"", "unknown field `xlck`"),
        ] {
            assert!(good.contains(from), "{from}");
            let text = good.replace(from, to);
            match Board::from_toml("mine", &text) {
                Ok(_) => assert!(expected.is_empty(), "{to} is taken"),
                Err(error) => {
                    let error = error.to_string();
                    assert!(!expected.is_empty() && error.contains(expected), "{to}: {error}");
                }
            }
        }
        let error = Board::find("nexys").unwrap_err().to_string();
        assert!(error.contains("icebreaker"), "{error}");
    }
}
