// SPDX-License-Identifier: MIT OR Apache-2.0
//! A raster core, by `docs/raster.md`.

mod core;
mod readout;
mod staleness;

pub(crate) use self::core::RasterCore;
