// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera on a board, as a project. With a sensor, a core on AXI and a serial line, open tools
//! make a bitstream of it. With a pattern in place of the sensor, before such a core or an array of
//! RPUs, Vivado makes it.
//!
//! A [`Board`] and a [`Sensor`] are files of data. A [`BoardProject`] is a design on a board:
//! Verilog, pins, and the script that [`build`](fn@build) runs. `docs/boards.md` describes the
//! modules around the core. [`view`] shows what a board sends.

mod array;
mod board;
mod build;
mod clock;
mod constraints;
mod error;
mod files;
mod pattern;
mod project;
mod sensor;
mod text_forms;
mod top;
pub mod view;

pub use board::{Board, BoardClock, BoardDevice, BoardLeds, DeviceFamily, SensorPins, SerialLine};
pub use build::{BuildResult, CellUse, PROJECT_FOLDER, build, write_project};
pub use error::BoardError;
pub use project::BoardProject;
pub use sensor::{I2cAddress, LogicLevel, PixelFormat, Sensor};
