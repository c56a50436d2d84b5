// SPDX-License-Identifier: MIT OR Apache-2.0
//! The section of a core's README on lost pixels.

use askama::Template;
use foveate_design::{Design, PortRole};

use crate::verilog_text::rendered_text;

#[derive(Template)]
#[template(path = "core_sync.md")]
struct SyncSection {
    syncs: bool,
    beats: u64,
    beat: &'static str,
    /// The unit that gets a beat at each edge, as words that follow `beat`; empty for the whole
    /// core.
    unit: &'static str,
    has_ready: bool,
}

/// Returns the section on where frames start and on lost pixels. `beat` is the name of what is
/// taken at one edge, and `of` says for which unit.
pub(crate) fn sync_section(design: &Design, beat: &'static str, of: &'static str) -> String {
    let view = SyncSection {
        syncs: design.has_frame_sync(),
        beats: design.timing().pixels_per_frame(),
        beat,
        unit: of,
        has_ready: design.rcm_ports().iter().any(|port| port.role == PortRole::Ready),
    };
    rendered_text(&view).trim().to_owned()
}
