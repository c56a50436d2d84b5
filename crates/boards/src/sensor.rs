// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sensors on DVP: the format of their pixels, and the registers of their set-up. Each sensor is
//! one file of data.

use std::path::Path;

use foveate_tools::escaping::message_excerpt;
use serde::Deserialize;

use crate::{BoardError, text_forms};

/// The sensors that come with the program: name and data.
const SENSORS: &[(&str, &str)] = &[
    ("hm01b0-4", include_str!("../sensors/hm01b0-4.toml")),
    ("hm01b0-8", include_str!("../sensors/hm01b0-8.toml")),
    ("ov7670-qvga", include_str!("../sensors/ov7670-qvga.toml")),
    ("ov7670-vga", include_str!("../sensors/ov7670-vga.toml")),
];

/// The format of a pixel on the data lines (docs/boards.md).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum PixelFormat {
    /// A pixel at each edge, on 8 lines.
    #[serde(rename = "8")]
    Byte,
    /// Two bytes, of which the first is the pixel.
    #[serde(rename = "luma-first")]
    LumaFirst,
    /// Two bytes, of which the second is the pixel.
    #[serde(rename = "luma-second")]
    LumaSecond,
    /// Two nibbles on 4 lines, the high one first.
    #[serde(rename = "4-high")]
    HighFirst,
    /// Two nibbles on 4 lines, the low one first.
    #[serde(rename = "4-low")]
    LowFirst,
}

impl PixelFormat {
    /// Returns the number of data lines.
    #[must_use]
    pub fn data_lines(self) -> usize {
        match self {
            Self::Byte | Self::LumaFirst | Self::LumaSecond => 8,
            Self::HighFirst | Self::LowFirst => 4,
        }
    }

    /// Returns the number of edges of the pixel clock per pixel.
    #[must_use]
    pub fn edges_per_pixel(self) -> u32 {
        match self {
            Self::Byte => 1,
            Self::LumaFirst | Self::LumaSecond | Self::HighFirst | Self::LowFirst => 2,
        }
    }

    /// Returns the value of the parameter `FORMAT` of `dvp_capture`.
    pub(crate) fn parameter_value(self) -> u32 {
        match self {
            Self::Byte => 0,
            Self::LumaFirst => 1,
            Self::LumaSecond => 2,
            Self::HighFirst => 3,
            Self::LowFirst => 4,
        }
    }
}

/// A logic level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogicLevel {
    /// The level 1.
    High,
    /// The level 0.
    Low,
}

/// A sensor in one of its modes.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// The full name of the sensor, for people.
    pub title: String,
    /// The number of pixels per line.
    pub width: u32,
    /// The number of lines per frame.
    pub height: u32,
    /// The number of pixels that are cropped at the left of each line.
    pub left: u32,
    /// The number of lines that are cropped at the top of each frame.
    pub top: u32,
    /// The format of a pixel.
    pub format: PixelFormat,
    /// The level of `vsync` between frames.
    pub vsync: LogicLevel,
    /// The largest ratio of the pixel clock to the clock that the sensor gets.
    pub pclk_per_xclk: f64,
    /// The lowest and the highest frequency of the clock that the sensor gets, in MHz.
    pub xclk_mhz: [f64; 2],
    /// The number of frames per second for each MHz of that clock.
    pub frames_per_mhz: f64,
    /// The access to the sensor over I2C.
    pub i2c: I2cAddress,
    /// The steps of the set-up, in order.
    #[serde(rename = "step")]
    steps: Vec<SetupStep>,
    /// The text of its file.
    #[serde(skip)]
    pub(crate) text: String,
}

/// The address of a sensor on I2C, and the size of its register addresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct I2cAddress {
    /// The address of the sensor, with 7 bits.
    pub device: u8,
    /// The number of bytes of the address of a register, 1 or 2.
    pub address_bytes: u32,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SetupStep {
    Write(Vec<RegisterValue>),
    PauseMs(u8),
}

/// The address of a register, and the value to write.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
struct RegisterValue(u16, u8);

impl Sensor {
    /// Returns the sensor with this name, or the sensor in the file with this path if the name ends
    /// in `.toml`. The path is relative to `folder`.
    ///
    /// # Errors
    /// Fails if there is no such sensor, or if it is not valid.
    pub fn find(name: &str, folder: &Path) -> Result<Self, BoardError> {
        if name.ends_with(".toml") {
            let path = folder.join(name);
            let text = foveate_tools::read_settings(&path)
                .map_err(|source| BoardError::Read { path, source })?;
            return Self::from_toml(name, &text);
        }
        match SENSORS.iter().find(|sensor| sensor.0 == name) {
            Some((name, text)) => Self::from_toml(name, text),
            None => {
                let known: Vec<_> = SENSORS.iter().map(|sensor| sensor.0).collect();
                Err(BoardError::UnknownSensor {
                    name: message_excerpt(name),
                    known: known.join(", "),
                })
            }
        }
    }

    fn from_toml(name: &str, text: &str) -> Result<Self, BoardError> {
        let invalid = |reason: String| BoardError::Invalid { name: name.to_owned(), reason };
        let invalid_toml =
            |error: toml::de::Error| invalid(error.to_string().trim_end().to_owned());
        text_forms::check_texts(&text.parse().map_err(invalid_toml)?).map_err(invalid)?;
        let mut sensor: Self = toml::from_str(text).map_err(invalid_toml)?;
        text.clone_into(&mut sensor.text);
        sensor.check().map_err(invalid)?;
        Ok(sensor)
    }

    fn check(&self) -> Result<(), String> {
        let I2cAddress { device, address_bytes } = self.i2c;
        if device > 0x7F {
            return Err(format!("i2c.device = {device}: an address of I2C has 7 bits"));
        }
        if !(1..=2).contains(&address_bytes) {
            return Err(format!(
                "i2c.address_bytes = {address_bytes}: the address of a register has 1 or 2 bytes"
            ));
        }
        let most = if address_bytes == 1 { 0xFF } else { 0xFFFF };
        if let Some((address, _)) = self.writes().find(|(address, _)| *address > most) {
            return Err(format!("a step writes register {address:#X}, but the last is {most:#X}"));
        }
        if self.setup_words().len() < 2 {
            return Err("a sensor needs at least two steps".to_owned());
        }
        if self.left >= self.width || self.top >= self.height {
            return Err(
                "left and top leave nothing of the frame; they must be below width and height"
                    .to_owned(),
            );
        }
        let [least, largest] = self.xclk_mhz;
        let rates = [self.pclk_per_xclk, self.frames_per_mhz, least, largest];
        if rates.iter().any(|rate| !rate.is_finite() || *rate <= 0.0) || least > largest {
            return Err(
                "clocks and rates must be above 0, and the smallest clock must not exceed the largest".to_owned()
            );
        }
        Ok(())
    }

    /// Returns the address and value of every write, without the pauses.
    pub fn writes(&self) -> impl Iterator<Item = (u16, u8)> {
        let pairs = self.steps.iter().flat_map(|step| match step {
            SetupStep::Write(pairs) => pairs.as_slice(),
            SetupStep::PauseMs(_) => &[],
        });
        pairs.map(|&RegisterValue(address, value)| (address, value))
    }

    /// Returns the number of bits of a word of `i2c_setup`.
    pub(crate) fn setup_word_bits(&self) -> u32 {
        8 * self.i2c.address_bytes + 9
    }

    /// Returns the words of `i2c_setup`: pause, address and value of each step.
    pub(crate) fn setup_words(&self) -> Vec<u32> {
        let address_bits = 8 * self.i2c.address_bytes;
        let word = |step: &SetupStep| match step {
            SetupStep::PauseMs(time) => vec![1 << (address_bits + 8) | u32::from(*time)],
            SetupStep::Write(pairs) => pairs
                .iter()
                .map(|&RegisterValue(address, value)| u32::from(address) << 8 | u32::from(value))
                .collect(),
        };
        self.steps.iter().flat_map(word).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensors_have_registers_that_fit_their_bus() {
        let find = |name| Sensor::find(name, Path::new("."));
        for (name, _) in SENSORS {
            let words = find(name).unwrap().setup_words();
            assert!(words.len() > 5 && words.len() < 256, "{name}");
        }
        let error = find("ov7671").unwrap_err().to_string();
        assert!(error.contains("`ov7671`") && error.contains("ov7670-vga"), "{error}");
        let error = find("ov7671.toml").unwrap_err().to_string();
        assert!(error.contains("./ov7671.toml"), "{error}");
        let good = SENSORS[2].1;
        for (from, to, expected) in [
            ("device = 0x21", "device = 0x84", "7 bits"),
            ("address_bytes = 1", "address_bytes = 3", "1 or 2"),
            ("[0x12, 0x80]", "[0x112, 0x80]", "the last is 0xFF"),
            ("left = 0", "left = 320", "leave nothing"),
            ("xclk_mhz = [10.0", "xclk_mhz = [50.0", "must not exceed"),
            ("frames_per_mhz = 1.25", "frames_per_mhz = nan", "above 0"),
            ("[0x12, 0x80]", "[0x12, 0x180]", "invalid"),
            ("luma-first", "luma", "unknown variant `luma`"),
        ] {
            assert!(good.contains(from), "{from}");
            let error = Sensor::from_toml("mine", &good.replace(from, to)).unwrap_err().to_string();
            assert!(error.contains(expected), "{to}: {error}");
        }
    }
}
