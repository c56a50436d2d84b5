// SPDX-License-Identifier: MIT OR Apache-2.0
//! The raster organization: one core for all regions, which takes K pixels per clock. The numbers
//! are those of `docs/raster.md`.

mod hardware;
mod memory;
mod ports;
mod rules;
mod timing;

pub use hardware::RasterHardware;
pub use memory::RasterMemory;
pub use ports::FRAME_NUMBERS;
pub use timing::{RasterTiming, SecondPassTiming};

#[cfg(test)]
mod tests;
