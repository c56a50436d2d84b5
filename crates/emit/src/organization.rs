// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the Verilog of an organization is made of; the only place that lists them here.

use crate::branch::Values;
use crate::{Prefix, SourceFile, Top, branch, leaf, raster, rcm, readme, serial};
use foveate_design::{Design, Hardware, PipelinedDesign, RasterDesign, SerialDesign};

/// What a design on some hardware brings.
pub(crate) trait Emitter {
    /// The leaves that its generated modules instantiate themselves.
    fn leaves(&self) -> Vec<&'static str>;
    /// Whether `leaf` has `part` inside, with the parameters that it has in the design.
    fn is_taken(&self, leaf: &str, part: &str) -> bool;
    /// The parameters of a leaf on which it depends what it elaborates, with their values in the design.
    fn values(&self, leaf: &str) -> Values;
    /// The generated modules that `top` is made of, each after those it instantiates.
    fn modules(&self, top: Top) -> Vec<SourceFile>;
    /// The README of the core.
    fn readme(&self, prefix: &Prefix) -> String;
}

/// What `design` brings.
pub(crate) fn emitter(design: &Design) -> Box<dyn Emitter + '_> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(design.on(own)),
        Hardware::Serial(own) => Box::new(design.on(own)),
        Hardware::Raster(own) => Box::new(design.on(own)),
    }
}

impl Emitter for PipelinedDesign<'_> {
    fn leaves(&self) -> Vec<&'static str> {
        leaf::pipelined(self)
    }

    fn is_taken(&self, _: &str, _: &str) -> bool {
        true
    }

    fn values(&self, _: &str) -> Values {
        Vec::new()
    }

    fn modules(&self, top: Top) -> Vec<SourceFile> {
        rcm::modules(*self, top)
    }

    fn readme(&self, prefix: &Prefix) -> String {
        readme::pipelined_readme(*self, prefix)
    }
}

impl Emitter for SerialDesign<'_> {
    fn leaves(&self) -> Vec<&'static str> {
        with_sync(self, "serial_array")
    }

    fn is_taken(&self, leaf: &str, part: &str) -> bool {
        branch::of_serial(*self, leaf, part)
    }

    fn values(&self, leaf: &str) -> Values {
        serial::values(*self, leaf)
    }

    fn modules(&self, top: Top) -> Vec<SourceFile> {
        serial::modules(*self, top)
    }

    fn readme(&self, prefix: &Prefix) -> String {
        readme::serial_readme(*self, prefix)
    }
}

impl Emitter for RasterDesign<'_> {
    fn leaves(&self) -> Vec<&'static str> {
        with_sync(self, "raster_core")
    }

    fn is_taken(&self, leaf: &str, part: &str) -> bool {
        branch::of_raster(*self, leaf, part)
    }

    fn values(&self, leaf: &str) -> Values {
        raster::values(*self, leaf)
    }

    fn modules(&self, top: Top) -> Vec<SourceFile> {
        raster::modules(*self, top)
    }

    fn readme(&self, prefix: &Prefix) -> String {
        readme::raster_readme(*self, prefix)
    }
}

/// The leaves of a top that instantiates one, and what finds its frames.
fn with_sync(design: &Design, leaf: &'static str) -> Vec<&'static str> {
    let sync = design.syncs().then_some("frame_sync");
    [leaf].into_iter().chain(sync).collect()
}
