// SPDX-License-Identifier: MIT OR Apache-2.0
//! The raster organization: one core for all regions, K pixels at every clock; the numbers behind
//! `docs/raster.md`.

mod feature;
mod hardware;
mod memory;
mod ports;
mod rules;
mod stream;
mod timing;

pub use hardware::Raster;
pub use memory::RasterMemory;
pub use ports::FRAME_NUMBERS;
pub use stream::{RasterStream, RowDeparture};
pub use timing::{RasterTiming, SecondPass};

#[cfg(test)]
mod tests;
