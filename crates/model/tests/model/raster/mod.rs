// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the raster core against outputs that are computed from `docs/raster.md` and the oracle,
//! and against waveforms that are computed by hand.

mod driver;
mod examples;
mod matrix;
mod memory;
mod properties;
mod raster_oracle;
mod raster_parameters;
mod readout;
mod stores;
mod streams;
