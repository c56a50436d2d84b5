// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the raster core against outputs that are computed from `docs/raster.md` and the oracle,
//! against waveforms that are computed by hand, and against the functional camera.

mod camera;
mod planted_faults;
mod departure;
mod driver;
mod examples;
mod raster_oracle;
mod memory;
mod properties;
mod readout;
mod raster_parameters;
mod stores;
mod streams;
mod summaries;
