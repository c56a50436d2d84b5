// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the README of a core says of lost pixels.

use askama::Template;
use foveate_design::{Design, PortRole};

use crate::text::text_of;

#[derive(Template)]
#[template(path = "core_sync.md")]
struct Sync {
    syncs: bool,
    /// Beats of a frame, and what one is called.
    beats: u64,
    beat: &'static str,
    /// Of what there is one at each.
    of: &'static str,
    has_ready: bool,
}

/// The section on where frames start, and on what is lost; `beat` is what is taken at one edge, as
/// often as `of` says.
pub(crate) fn section(design: &Design, beat: &'static str, of: &'static str) -> String {
    let view = Sync {
        syncs: design.syncs(),
        beats: design.timing().pixels_per_frame(),
        beat,
        of,
        has_ready: design.rcm_ports().iter().any(|port| port.role == PortRole::Ready),
    };
    text_of(&view).trim().to_owned()
}
