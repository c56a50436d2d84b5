// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the Verilog of an organization is made of; the only place that lists them here.

use crate::branch::Values;
use crate::{Prefix, SourceFile, Top, leaf, raster, rcm, readme, serial};
use foveate_design::{Design, Organization};

/// What an organization brings.
pub(crate) struct Emitter {
    /// The leaves that its generated modules instantiate themselves.
    pub(crate) leaves: fn(&Design) -> Vec<&'static str>,
    /// The parameters of a leaf on which it depends what it elaborates, with their values in the design.
    pub(crate) values: fn(&Design, &str) -> Values,
    /// The generated modules that `Top` is made of, each after those it instantiates.
    pub(crate) modules: fn(&Design, Top) -> Vec<SourceFile>,
    /// The README of the core.
    pub(crate) readme: fn(&Design, &Prefix) -> String,
}

impl Emitter {
    /// What the organization of `design` brings.
    pub(crate) fn of(design: &Design) -> Self {
        match design.organization() {
            Organization::Pipelined => Self {
                leaves: leaf::pipelined,
                values: |_, _| Vec::new(),
                modules: rcm::modules,
                readme: readme::pipelined_readme,
            },
            Organization::Serial => Self {
                leaves: |design| with_sync(design, "serial_array"),
                values: serial::values,
                modules: serial::modules,
                readme: readme::serial_readme,
            },
            Organization::Raster => Self {
                leaves: |design| with_sync(design, "raster_core"),
                values: raster::values,
                modules: raster::modules,
                readme: readme::raster_readme,
            },
        }
    }
}

/// The leaves of a top that instantiates one, and what finds its frames.
fn with_sync(design: &Design, leaf: &'static str) -> Vec<&'static str> {
    let sync = design.syncs().then_some("frame_sync");
    [leaf].into_iter().chain(sync).collect()
}
