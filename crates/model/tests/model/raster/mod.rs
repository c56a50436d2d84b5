// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the raster core against outputs that are computed from `docs/raster.md` and the oracle,
//! against waveforms that are computed by hand, and against the functional camera.

mod camera;
mod driver;
mod examples;
mod memory;
mod planted_faults;
mod properties;
mod raster_oracle;
mod raster_parameters;
mod readout;
mod stores;
mod streams;
mod summaries;
mod zones;
