// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `raster.v`, the top of a raster design: the core, or the core for the smallest frame.

use crate::branch::Values;
use crate::camera::{blanks, last_sent};
use crate::sync::{self, Sync};
use crate::text::{PortLine, file, text_of};
use crate::thresholds::{Constant, constants, signal, summary};
use crate::{SourceFile, Top, banner};
use askama::Template;
use foveate_design::{
    Combine, Design, FRAME_NUMBERS, FeatureKind, Filter, Neighborhood, Pipelining, Port, PortRole,
    RasterDesign, RasterTiming, SpatialFeature, Store, bits_for, index_bits,
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
    parameters: Vec<(&'static str, String)>,
    thresholds: Vec<(String, String)>,
    /// The scores of the core, and what they are connected to.
    scores: Vec<(String, String)>,
    /// The ports of the core to a frame store outside and for pixels that leave, and what they are connected to.
    streams: Vec<(&'static str, String)>,
    sync: Option<Sync>,
    valid: &'static str,
    ready: &'static str,
}

struct Unused {
    name: String,
    /// Empty where it is one bit.
    range: String,
}

/// The core, or the one for the smallest frame.
pub(crate) fn modules(design: RasterDesign<'_>, top: Top) -> Vec<SourceFile> {
    let lone = design.lone_unit();
    let view = match top {
        Top::Rpu => view(lone.on(design.own()), &design, top),
        Top::Rcm => view(design, &design, top),
    };
    vec![file(top.module(), text_of(&view))]
}

/// Parameters of a leaf that decide on its parts.
pub(crate) fn values(design: RasterDesign<'_>, leaf: &str) -> Values {
    match leaf {
        "raster_core" => {
            let grid = [
                ("COLUMNS", design.columns()),
                ("ROWS", design.rows()),
                ("FRAME_WIDTH", design.width()),
                ("FRAME_HEIGHT", design.height()),
                ("REGION_BITS", index_bits(design.regions().into())),
            ];
            let grid = grid.into_iter().map(|(name, value)| (name, value.to_string()));
            grid.chain(parameters(design, &RasterTiming::of(design))).collect()
        }
        "raster_store" => vec![("KIND", store(design).to_string())],
        _ => Vec::new(),
    }
}

/// The range of a port whose width depends on the grid.
fn range(port: &Port) -> Option<String> {
    use PortRole::{ForwardRegion, LostRegion, Region};
    let of_region = matches!(port.role, Region | ForwardRegion | LostRegion);
    of_region.then(|| "[$clog2(COLUMNS*ROWS)-1:0]".to_owned())
}

fn view(design: RasterDesign<'_>, named: &Design, top: Top) -> Raster {
    let timing = RasterTiming::of(design);
    let n = design.region_size();
    let mut unused = Vec::new();
    let mut scores = Vec::new();
    for &kind in FeatureKind::ALL {
        let port = format!("{kind}_score_o");
        let connected = match design.feature(kind) {
            Some(_) => port.clone(),
            None => {
                let range = bits(score_bits(design, kind));
                unused.push(Unused { name: kind.to_string(), range });
                format!("unused_{kind}")
            }
        };
        scores.push((port, connected));
    }
    let streams = streams(design, &mut unused);
    Raster {
        banner: banner(named),
        what: format!(
            "The camera for frames that come row by row: COLUMNS x ROWS regions of {n}x{n} {}-bit pixels.",
            design.pixel_bits()
        ),
        summary: summary(&design),
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
        constants: constants(&design),
        unused,
        parameters: parameters(design, &timing),
        thresholds: thresholds(design),
        scores,
        streams,
        sync: Sync::with_ready(&design, beats(design)),
        valid: sync::valid(&design),
        ready: sync::ready(&design),
    }
}

/// Beats of a frame in terms of the grid: words of a row that are taken, and rows.
fn beats(design: RasterDesign<'_>) -> String {
    let (n, pixels) = (design.region_size(), design.pixels_per_clock());
    let length = |regions: &str, beyond: u32| match beyond {
        0 => format!("{regions} * {n}"),
        _ => format!("({regions} * {n} - {beyond})"),
    };
    let width = length("COLUMNS", design.columns() * n - design.width());
    let height = length("ROWS", design.rows() * n - design.height());
    match pixels {
        1 => format!("{width} * {height}"),
        _ => format!("(({width} + {}) / {pixels}) * {height}", pixels - 1),
    }
}

/// The range of so many bits; nothing for one.
fn bits(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0]", width - 1) }
}

/// Connects the streams of the core to those ports that the design has.
fn streams(design: RasterDesign<'_>, unused: &mut Vec<Unused>) -> Vec<(&'static str, String)> {
    let word = design.pixels_per_clock() * design.pixel_bits();
    let has: Vec<String> = design.rcm_ports().into_iter().map(|port| port.name).collect();
    let mut list = Vec::new();
    for (port, width) in
        [("reference_valid_i", 1), ("reference_pixel_i", word), ("forward_ready_i", 1)]
    {
        let given = has.iter().any(|name| name == port);
        list.push((port, if given { port.to_owned() } else { format!("{width}'d0") }));
    }
    let (region, frame) = ("[$clog2(COLUMNS*ROWS)-1:0]".to_owned(), FRAME_NUMBERS.ilog2());
    for (name, range) in [
        ("reference_ready_o", String::new()),
        ("store_valid_o", String::new()),
        ("store_pixel_o", bits(word)),
        ("store_last_o", String::new()),
        ("underrun_o", String::new()),
        ("forward_valid_o", String::new()),
        ("forward_region_o", region.clone()),
        ("forward_position_o", bits(design.position_bits())),
        ("forward_pixel_o", bits(word)),
        ("forward_first_o", String::new()),
        ("forward_last_o", String::new()),
        ("forward_abort_o", String::new()),
        ("forward_frame_o", bits(frame)),
        ("lost_o", String::new()),
        ("lost_count_o", bits(16)),
        ("lost_valid_o", String::new()),
        ("lost_region_o", region),
        ("lost_frame_o", bits(frame)),
    ] {
        let given = has.iter().any(|port| port == name);
        let signal = if given {
            name.to_owned()
        } else {
            let name = name.trim_end_matches("_o").to_owned();
            let signal = format!("unused_{name}");
            unused.push(Unused { name, range });
            signal
        };
        list.push((name, signal));
    }
    list
}

/// Bits of a score of the core; of one that the design does not have, some.
fn score_bits(design: RasterDesign<'_>, kind: FeatureKind) -> u32 {
    design.feature(kind).map_or(design.count_bits(), SpatialFeature::score_bits)
}

fn parameters(design: RasterDesign<'_>, timing: &RasterTiming) -> Vec<(&'static str, String)> {
    let flag = |condition: bool| u32::from(condition);
    let has = |kind| flag(design.feature(kind).is_some());
    let edge_level_bits = level_bits(design, FeatureKind::Edge).expect("edge has a level");
    let mut list = vec![
        ("WIDTH", design.pixel_bits()),
        ("LANES", design.pixels_per_clock()),
        ("SIDE", design.region_size()),
        ("ISOLATED", flag(design.neighborhood() == Neighborhood::Isolated)),
        ("MEDIAN", flag(design.filter() == Filter::Median3x3)),
    ];
    list.extend(FeatureKind::ALL.iter().map(|&kind| (parameter(kind), has(kind))));
    list.extend([
        ("ALL", flag(design.combine() == Combine::All)),
        ("LAST_SENT", last_sent(&design)),
        ("BLANKS", flag(blanks(&design))),
        ("RAW", flag(design.keeps_raw())),
        ("FORWARD", flag(design.forwards())),
        ("STORE", store(design)),
        ("DEEP", flag(design.pipelining() == Pipelining::Deep)),
        ("SETTLE", timing.decision_latency),
        ("COUNT_BITS", design.count_bits()),
        ("EDGE_LEVEL_BITS", edge_level_bits),
        ("POSITION_BITS", design.position_bits()),
        ("FRAME_BITS", FRAME_NUMBERS.ilog2()),
        ("MAD_BITS", score_bits(design, FeatureKind::Mad)),
        ("VARIANCE_BITS", score_bits(design, FeatureKind::Variance)),
    ]);
    let mut wide = Vec::new();
    if design.features().iter().any(|feature| !feature.kind().has_window()) {
        list.push(("SUM_BITS", design.pixel_sum_bits()));
    }
    if let Some(mean) = design.features().iter().find_map(SpatialFeature::mean) {
        let factor = mean.reciprocal.multiplier();
        list.extend([
            ("FRACTION", mean.fraction_bits),
            ("DIVIDEND_BITS", mean.dividend_bits),
            ("MEAN_BITS", mean.mean_bits),
            ("FACTOR_BITS", bits_for(factor)),
            ("SHIFT", mean.reciprocal.shift()),
        ]);
        wide.push(("FACTOR", format!("{}'d{factor}", bits_for(factor))));
    }
    if let Some(variance) = design.features().iter().find_map(SpatialFeature::variance) {
        list.extend([
            ("SQUARE_SUM_BITS", variance.square_sum_bits),
            ("PRODUCT_BITS", variance.product_bits),
        ]);
    }
    let list = list.into_iter().map(|(name, value)| (name, value.to_string()));
    list.chain(wide).collect()
}

/// The parameter of the core that says whether it has a feature.
fn parameter(kind: FeatureKind) -> &'static str {
    match kind {
        FeatureKind::Edge => "EDGE",
        FeatureKind::Corner => "CORNER",
        FeatureKind::Mad => "MAD",
        FeatureKind::Variance => "VARIANCE",
    }
}

/// Bits of a level of the core, of a feature that the design does not have, too; none of one without a level.
fn level_bits(design: RasterDesign<'_>, kind: FeatureKind) -> Option<u32> {
    let most = match kind {
        FeatureKind::Edge => design.pixel_bits() + 3,
        FeatureKind::Corner => design.pixel_bits(),
        FeatureKind::Mad | FeatureKind::Variance => return None,
    };
    Some(design.feature(kind).map_or(most, SpatialFeature::level_bits))
}

/// The number of its store in the core.
fn store(design: RasterDesign<'_>) -> u32 {
    match design.store() {
        Store::Block => 0,
        Store::Ultra => 1,
        Store::SinglePort => 2,
        Store::External => 3,
    }
}

/// What is connected to the threshold inputs of the core.
fn thresholds(design: RasterDesign<'_>) -> Vec<(String, String)> {
    let mut list = vec![
        ("temporal_level_i".to_owned(), signal(&design, PortRole::TemporalLevel)),
        ("temporal_min_i".to_owned(), signal(&design, PortRole::TemporalMinCount)),
    ];
    let mut add = |name: String, role, kind, width: u32| {
        let given = design.feature(kind).map(|_| signal(&design, role));
        list.push((name, given.unwrap_or_else(|| format!("{width}'d0"))));
    };
    for &kind in FeatureKind::ALL {
        if let Some(width) = level_bits(design, kind) {
            add(format!("{kind}_level_i"), PortRole::Level(kind), kind, width);
        }
    }
    for &kind in FeatureKind::ALL {
        add(format!("{kind}_min_i"), PortRole::MinScore(kind), kind, score_bits(design, kind));
    }
    list
}
