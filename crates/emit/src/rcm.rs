// SPDX-License-Identifier: MIT OR Apache-2.0
//! Generates the modules of a pipelined design, and fills `rcm.v`.

use super::top::{self, FrameSync};
use crate::leaf_files::leaf_files;
use crate::verilog_text::{PortLine, module_file, rendered_text};
use crate::{SourceFile, Top, banner, rpu};
use askama::Template;
use foveate_design::{PipelinedDesign, Port, PortRole};

#[derive(Template)]
#[template(path = "rcm.v")]
struct RcmModule {
    banner: String,
    columns: u32,
    rows: u32,
    /// The most columns and rows of regions that the ports allow.
    widest: u32,
    highest: u32,
    ports: Vec<PortLine>,
    pins: Vec<PortConnection>,
    sync: Option<FrameSync>,
}

/// A port of the RPU, and the signal that the array connects to it.
struct PortConnection {
    name: String,
    connection: String,
}

/// Returns the modules of `top`; the array consists of RPUs.
pub(crate) fn modules(design: PipelinedDesign<'_>, top: Top) -> Vec<SourceFile> {
    let rpu = module_file(Top::Rpu.module(), rpu::render(design));
    match top {
        Top::Rpu => vec![rpu],
        Top::Rcm => {
            // `frame_sync` is part of the array and not of the RPU, so it is not among the leaves
            // of the RPU.
            let sync = design.has_frame_sync().then_some("frame_sync");
            let leaves = leaf_files(sync.into_iter().collect());
            let array = module_file(top.module(), render(design));
            leaves.chain([rpu, array]).collect()
        }
    }
}

/// Returns the range of a port that has a value per region; `None` for other ports.
fn port_range(port: &Port) -> Option<String> {
    match (port.per_lane, port.width) {
        (true, 1) => Some("[COLUMNS*ROWS-1:0]".to_owned()),
        (true, width) => Some(format!("[COLUMNS*ROWS*{width}-1:0]")),
        (false, _) => None,
    }
}

fn render(design: PipelinedDesign<'_>) -> String {
    let ports = design.rcm_ports();
    let pins =
        design.rpu_ports().iter().map(|port| port_connection(design, port, &ports)).collect();
    let view = RcmModule {
        banner: banner(&design),
        columns: design.columns(),
        rows: design.rows(),
        widest: design.max_regions_per_line(),
        highest: design.max_regions_per_line(),
        ports: PortLine::aligned(&ports, port_range),
        pins,
        sync: FrameSync::without_ready(&design, design.stream_pixels().to_string()),
    };
    rendered_text(&view)
}

fn port_connection(design: PipelinedDesign<'_>, port: &Port, rcm_ports: &[Port]) -> PortConnection {
    let name = port.name.clone();
    let per_lane = rcm_ports.iter().any(|outer| outer.name == name && outer.per_lane);
    let connection = match port.role {
        PortRole::Valid => top::valid_signal(&design).to_owned(),
        PortRole::DecisionValid => "decision_valid[REGION]".to_owned(),
        PortRole::Border => {
            "{row == ROWS - 1, row == 0, column == COLUMNS - 1, column == 0}".to_owned()
        }
        _ if !per_lane => name.clone(),
        _ if port.width == 1 => format!("{name}[REGION]"),
        _ => format!("{name}[REGION*{0}+:{0}]", port.width),
    };
    PortConnection { name, connection }
}
