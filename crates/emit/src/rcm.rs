// SPDX-License-Identifier: MIT OR Apache-2.0
//! Generates the modules of a pipelined design, and fills `rcm.v`.

use crate::sync::{self, Sync};
use crate::text::{PortLine, file, text_of};
use crate::{SourceFile, Top, banner, leaf, rpu};
use askama::Template;
use foveate_design::{PipelinedDesign, Port, PortRole};

#[derive(Template)]
#[template(path = "rcm.v")]
struct Rcm {
    banner: String,
    columns: u32,
    rows: u32,
    /// The most columns and rows of regions that the ports allow.
    widest: u32,
    highest: u32,
    ports: Vec<PortLine>,
    pins: Vec<Pin>,
    sync: Option<Sync>,
}

/// A port of the RPU, and the signal that the array connects to it.
struct Pin {
    name: String,
    connection: String,
}

/// Returns the modules of `top`; the array consists of RPUs.
pub(crate) fn modules(design: PipelinedDesign<'_>, top: Top) -> Vec<SourceFile> {
    let rpu = file(Top::Rpu.module(), rpu::render(design));
    match top {
        Top::Rpu => vec![rpu],
        Top::Rcm => {
            // `frame_sync` is part of the array and not of the RPU, so it is not among the leaves
            // of the RPU.
            let sync = design.syncs().then_some("frame_sync");
            let leaves = leaf::with_parts(sync.into_iter().collect(), |_, _| true);
            let leaves = leaves.map(|leaf| file(leaf.name, leaf.contents.to_owned()));
            let array = file(top.module(), render(design));
            leaves.chain([rpu, array]).collect()
        }
    }
}

/// Returns the range of a port that has a value per region; `None` for other ports.
fn range(port: &Port) -> Option<String> {
    match (port.per_lane, port.width) {
        (true, 1) => Some("[COLUMNS*ROWS-1:0]".to_owned()),
        (true, width) => Some(format!("[COLUMNS*ROWS*{width}-1:0]")),
        (false, _) => None,
    }
}

fn render(design: PipelinedDesign<'_>) -> String {
    let ports = design.rcm_ports();
    let pins = design.rpu_ports().iter().map(|port| pin(design, port, &ports)).collect();
    let view = Rcm {
        banner: banner(&design),
        columns: design.columns(),
        rows: design.rows(),
        widest: design.most_in_line(),
        highest: design.most_in_line(),
        ports: PortLine::all(&ports, range),
        pins,
        sync: Sync::always_open(&design, design.stream_pixels().to_string()),
    };
    text_of(&view)
}

fn pin(design: PipelinedDesign<'_>, port: &Port, rcm_ports: &[Port]) -> Pin {
    let name = port.name.clone();
    let per_lane = rcm_ports.iter().any(|outer| outer.name == name && outer.per_lane);
    let connection = match port.role {
        PortRole::Valid => sync::valid(&design).to_owned(),
        PortRole::DecisionValid => "decision_valid[REGION]".to_owned(),
        PortRole::Border => {
            "{row == ROWS - 1, row == 0, column == COLUMNS - 1, column == 0}".to_owned()
        }
        _ if !per_lane => name.clone(),
        _ if port.width == 1 => format!("{name}[REGION]"),
        _ => format!("{name}[REGION*{0}+:{0}]", port.width),
    };
    Pin { name, connection }
}
