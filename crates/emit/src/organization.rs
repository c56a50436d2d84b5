// SPDX-License-Identifier: MIT OR Apache-2.0
//! The trait that each organization implements to be emitted. No other place of this crate lists
//! the organizations.

use crate::{Prefix, SourceFile, Top, leaf, raster, rcm, readme, serial};
use foveate_design::{Design, Hardware, PipelinedDesign, RasterDesign, SerialDesign};

/// The parts of a core that depend on the organization of its design.
pub(crate) trait Emitter {
    /// Returns the leaves that the generated modules of the design instantiate directly.
    fn direct_leaves(&self) -> Vec<&'static str>;
    /// Returns the generated modules of `top`, each after those it instantiates.
    fn modules(&self, top: Top) -> Vec<SourceFile>;
    /// Returns the README of the core.
    fn readme(&self, prefix: &Prefix) -> String;
}

pub(crate) fn emitter(design: &Design) -> Box<dyn Emitter + '_> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(design.with_hardware(own)),
        Hardware::Serial(own) => Box::new(design.with_hardware(own)),
        Hardware::Raster(own) => Box::new(design.with_hardware(own)),
    }
}

impl Emitter for PipelinedDesign<'_> {
    fn direct_leaves(&self) -> Vec<&'static str> {
        leaf::pipelined_leaves(self)
    }

    fn modules(&self, top: Top) -> Vec<SourceFile> {
        rcm::modules(*self, top)
    }

    fn readme(&self, prefix: &Prefix) -> String {
        readme::pipelined_readme(*self, prefix)
    }
}

impl Emitter for SerialDesign<'_> {
    fn direct_leaves(&self) -> Vec<&'static str> {
        leaves_with_sync(self, "serial_array")
    }

    fn modules(&self, top: Top) -> Vec<SourceFile> {
        serial::modules(*self, top)
    }

    fn readme(&self, prefix: &Prefix) -> String {
        readme::serial_readme(*self, prefix)
    }
}

impl Emitter for RasterDesign<'_> {
    fn direct_leaves(&self) -> Vec<&'static str> {
        leaves_with_sync(self, "raster_core")
    }

    fn modules(&self, top: Top) -> Vec<SourceFile> {
        raster::modules(*self, top)
    }

    fn readme(&self, prefix: &Prefix) -> String {
        readme::raster_readme(*self, prefix)
    }
}

/// Returns the leaves of a top that instantiates `leaf`, including `frame_sync` if the design has
/// it.
fn leaves_with_sync(design: &Design, leaf: &'static str) -> Vec<&'static str> {
    let sync = design.has_frame_sync().then_some("frame_sync");
    [leaf].into_iter().chain(sync).collect()
}
