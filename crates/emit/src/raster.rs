// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `raster.v`, the top of a raster design: the core, or the core for the smallest frame.

use crate::text::{PortLine, file, text_of};
use crate::thresholds::{Constant, constants, signal, summary};
use crate::{SourceFile, Top, banner};
use askama::Template;
use foveate_design::{
    Combine, Design, FeatureKind, Filter, Irrelevant, Neighborhood, Pipelining, Port, PortRole,
    RasterTiming, Reference,
};

#[derive(Template)]
#[template(path = "raster.v")]
struct Raster {
    banner: String,
    what: String,
    summary: String,
    lanes: u32,
    pipelining: &'static str,
    clocks: String,
    module: &'static str,
    columns: u32,
    rows: u32,
    n: u32,
    pad_columns: u32,
    pad_rows: u32,
    ports: Vec<PortLine>,
    constants: Vec<Constant>,
    /// Outputs of the core that the design does not have.
    unused: Vec<Unused>,
    parameters: Vec<(&'static str, u32)>,
    thresholds: Vec<(&'static str, String)>,
    edge_score: String,
    corner_score: String,
}

struct Unused {
    name: &'static str,
    width: u32,
}

/// The core, or the one for the smallest frame.
pub(crate) fn modules(design: &Design, top: Top) -> Vec<SourceFile> {
    let view = match top {
        Top::Rpu => view(&design.lone_unit(), design, top),
        Top::Rcm => view(design, design, top),
    };
    vec![file(top.module(), text_of(&view))]
}

/// The range of a port whose width depends on the grid.
fn range(port: &Port) -> Option<String> {
    let of_region = matches!(port.role, PortRole::Region | PortRole::ForwardRegion);
    of_region.then(|| "[$clog2(COLUMNS*ROWS)-1:0]".to_owned())
}

fn view(design: &Design, named: &Design, top: Top) -> Raster {
    let timing = RasterTiming::of(design);
    let n = design.region_size();
    let count_bits = design.count_bits();
    let mut unused = Vec::new();
    let mut score = |kind, port: &'static str, name| match design.feature(kind) {
        Some(_) => port.to_owned(),
        None => {
            unused.push(Unused { name, width: count_bits });
            format!("unused_{name}")
        }
    };
    let edge_score = score(FeatureKind::Edge, "edge_score_o", "edges");
    let corner_score = score(FeatureKind::Corner, "corner_score_o", "corners");
    Raster {
        banner: banner(named),
        what: format!(
            "The camera for frames that come row by row: COLUMNS x ROWS regions of {n}x{n} {}-bit pixels.",
            design.pixel_bits()
        ),
        summary: summary(design),
        lanes: design.pixels_per_clock(),
        pipelining: design.pipelining().name(),
        clocks: format!("{} clocks, with the grid above", timing.clocks_per_frame()),
        module: top.module(),
        columns: design.columns(),
        rows: design.rows(),
        n,
        pad_columns: design.columns() * n - design.width(),
        pad_rows: design.rows() * n - design.height(),
        ports: PortLine::all(&top.ports(named), range),
        constants: constants(design),
        unused,
        parameters: parameters(design, &timing),
        thresholds: thresholds(design),
        edge_score,
        corner_score,
    }
}

fn parameters(design: &Design, timing: &RasterTiming) -> Vec<(&'static str, u32)> {
    let flag = |condition: bool| u32::from(condition);
    let has = |kind| flag(design.feature(kind).is_some());
    let edge_level = design.feature(FeatureKind::Edge);
    vec![
        ("WIDTH", design.pixel_bits()),
        ("LANES", design.pixels_per_clock()),
        ("SIDE", design.region_size()),
        ("ISOLATED", flag(design.neighborhood() == Neighborhood::Isolated)),
        ("MEDIAN", flag(design.filter() == Filter::Median3x3)),
        ("EDGE", has(FeatureKind::Edge)),
        ("CORNER", has(FeatureKind::Corner)),
        ("ALL", flag(design.combine() == Combine::All)),
        ("LAST_SENT", flag(design.temporal().reference == Reference::LastSent)),
        ("BLANKS", flag(design.irrelevant() == Irrelevant::Zero)),
        ("RAW", flag(design.keeps_raw())),
        ("DEEP", flag(design.pipelining() == Pipelining::Deep)),
        ("SETTLE", timing.decision_latency),
        ("COUNT_BITS", design.count_bits()),
        ("EDGE_LEVEL_BITS", edge_level.map_or(design.pixel_bits() + 3, |edge| edge.level_bits())),
        ("POSITION_BITS", design.position_bits()),
    ]
}

/// What is connected to the threshold inputs of the core.
fn thresholds(design: &Design) -> Vec<(&'static str, String)> {
    let of = |role, kind, width: u32| match design.feature(kind) {
        Some(_) => signal(design, role),
        None => format!("{width}'d0"),
    };
    let (edge, corner) = (FeatureKind::Edge, FeatureKind::Corner);
    let (pixel, count) = (design.pixel_bits(), design.count_bits());
    vec![
        ("edge_level_i", of(PortRole::Level(edge), edge, pixel + 3)),
        ("corner_level_i", of(PortRole::Level(corner), corner, pixel)),
        ("temporal_level_i", signal(design, PortRole::TemporalLevel)),
        ("edge_min_i", of(PortRole::MinScore(edge), edge, count)),
        ("corner_min_i", of(PortRole::MinScore(corner), corner, count)),
        ("temporal_min_i", signal(design, PortRole::TemporalMinCount)),
    ]
}
