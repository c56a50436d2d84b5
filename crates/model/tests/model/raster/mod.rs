// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the raster core against outputs that are computed from `docs/raster.md` and the oracle,
//! against waveforms that are computed by hand, and against the functional camera.

mod camera;
mod controls;
mod departure;
mod driver;
mod examples;
mod expected;
mod memory;
mod properties;
mod reading;
mod recipe;
mod stores;
mod streams;
mod summaries;
