// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decides which parts of a leaf a design elaborates.
//!
//! A leaf instantiates some of its parts in a branch of a `generate` that not every design takes. A
//! part that no taken branch needs is not shipped. A part that is not listed here is in no such
//! branch.
//!
//! Two tools also examine branches that are not taken, so the text of a leaf that lacks parts is
//! adapted. Yosys uses the default values of parameters when it reads a file, so the defaults
//! become the values of the design. Verilator reports a parameter as unused if its only use is an
//! instance of a missing module, so this warning is turned off in the file.

use crate::Leaf;
use foveate_design::{
    DenoiseFilter, Design, FeatureKind, FrameStoreKind, LaneMemoryKind, Pipelining, PixelFeed,
    RasterDesign, RasterTiming, ReferencePolicy, ReferenceWriteTime, SerialDesign,
};

/// Returns whether a leaf of a serial array contains `part`.
pub(crate) fn serial_leaf_has_part(design: SerialDesign<'_>, leaf: &str, part: &str) -> bool {
    match (leaf, part) {
        ("serial_array", "serial_raster_feed") => design.feed() == PixelFeed::Raster,
        ("serial_array", "serial_parallel_feed") => design.feed() == PixelFeed::Parallel,
        ("serial_array", "serial_sides") => design.needs_border() && design.fold() > 1,
        ("serial_array", "serial_summary") => design.periphery().is_some(),
        ("serial_raster_feed", _) => design.halo() > 0,
        ("serial_memory", "frame_store") => {
            design.lane_memory().kind == LaneMemoryKind::Distributed
        }
        ("serial_decision", "frame_store") => has_region_marks(&design),
        _ => true,
    }
}

/// Returns whether a leaf of a raster core contains `part`.
pub(crate) fn raster_leaf_has_part(design: RasterDesign<'_>, leaf: &str, part: &str) -> bool {
    let scored = || design.features().iter().any(|f| score_parts(f.kind()).contains(&part));
    let median = || design.filter() == DenoiseFilter::Median3x3;
    let window = || design.has_feature_window();
    match (leaf, part) {
        ("raster_core", "raster_window") => median() || window(),
        ("raster_core", "median_columns") => median(),
        ("raster_core", "raster_repeat") => !median() && !window() && is_padded_below(&design),
        ("raster_core", "raster_external") => design.store() == FrameStoreKind::External,
        ("raster_core", "raster_store") => design.store() != FrameStoreKind::External,
        ("raster_core", "raster_ring") => design.has_forwarding() || scored(),
        ("raster_core", "raster_forward") => design.has_forwarding(),
        ("raster_core", "raster_line") => {
            design.has_forwarding() && design.has_separate_raw_pixels() && window()
        }
        ("raster_core", "raster_summary") => design.periphery().is_some(),
        ("raster_decision", "raster_valid") => has_region_marks(&design),
        ("raster_store", "raster_pairs") => design.store() == FrameStoreKind::SinglePort,
        ("raster_store", "raster_ring") => design.store() != FrameStoreKind::SinglePort,
        ("raster_store", "raster_banks") => has_banks(design),
        ("raster_store", "raster_memory") => {
            design.store() != FrameStoreKind::SinglePort && !has_banks(design)
        }
        ("raster_core" | "raster_moments", part) if is_score_part(part) => scored(),
        _ => true,
    }
}

/// Returns the parts of a raster core that compute the score of a feature; a core without the
/// feature need not have them.
fn score_parts(kind: FeatureKind) -> &'static [&'static str] {
    match kind {
        FeatureKind::Edge => &["raster_edge"],
        FeatureKind::Corner => &["raster_corner"],
        FeatureKind::Mad => &["raster_moments", "raster_ring", "raster_deviation"],
        FeatureKind::Variance => &["raster_moments", "raster_variance"],
    }
}

/// Returns whether a part of a raster core computes the score of some feature.
fn is_score_part(part: &str) -> bool {
    FeatureKind::ALL.iter().any(|&kind| score_parts(kind).contains(&part))
}

/// Returns whether a memory records which regions have a reference.
fn has_region_marks(design: &Design) -> bool {
    design.temporal().reference.bits_per_region() > 0
}

/// Returns whether references are written in the order of the frame.
fn is_in_order(reference: ReferencePolicy) -> bool {
    match reference.write_time() {
        ReferenceWriteTime::EveryFrame => true,
        ReferenceWriteTime::WhenSent => false,
    }
}

/// Returns whether the frame ends inside a row of regions, so that its last row is repeated.
fn is_padded_below(design: &Design) -> bool {
    !design.height().is_multiple_of(design.region_size())
}

/// The words of a bank of the store, as in `raster_core`.
const BANK_WORDS: u64 = 1 << 14;

/// Returns whether the frame store consists of groups of banks. This is a large store that must be
/// fast, and whose references come in order and can be requested early enough.
fn has_banks(design: RasterDesign<'_>) -> bool {
    design.pipelining() == Pipelining::Deep
        && design.store() == FrameStoreKind::Block
        && is_in_order(design.temporal().reference)
        && RasterTiming::from_design(design).words() > BANK_WORDS
        && (design.filter() != DenoiseFilter::None || design.has_feature_window())
}

/// The parameters of a leaf and their values.
pub(crate) type ParameterValues = Vec<(&'static str, String)>;

/// Returns the text of a leaf as a design ships it. The parameters of the leaf have these `values`
/// in the design. `is_whole` says whether the design elaborates all parts of the leaf.
pub(crate) fn shipped_text(leaf: &Leaf, values: &[(&str, String)], is_whole: bool) -> String {
    let plain = leaf.contents.to_owned();
    let text = values.iter().fold(plain, |text, (name, value)| with_default(&text, name, value));
    if is_whole {
        return text;
    }
    let parts = "// Parts that the design does not elaborate are left out, so some parameters have no use.\n\
                 // verilator lint_off UNUSEDPARAM\n";
    let end = "// verilator lint_on UNUSEDPARAM\n";
    text.replacen("`default_nettype none\n", &format!("`default_nettype none\n\n{parts}"), 1)
        .replacen("`default_nettype wire", &format!("{end}\n`default_nettype wire"), 1)
}

/// Returns the text of a module with another default of a parameter. A comment on that line keeps
/// its column if there is room.
fn with_default(text: &str, name: &str, value: &str) -> String {
    let start = format!(" {name} = ");
    let is_declared =
        |line: &&str| line.trim_start().starts_with("parameter ") && line.contains(&start);
    let Some(line) = text.lines().find(is_declared) else { return text.to_owned() };
    let (before, after) = line.split_once(&start).unwrap_or((line, ""));
    let end = after.find([',', ' ']).unwrap_or(after.len());
    let comment = after.find("//").unwrap_or(after.len());
    let declared = format!("{before}{start}{value}{}", after[end..comment].trim_end());
    let column = line.len() - (after.len() - comment);
    let width = column.max(declared.len() + 2);
    text.replacen(line, &format!("{declared:width$}{}", &after[comment..]), 1)
}

#[cfg(test)]
mod tests {
    use super::with_default;

    #[test]
    fn a_default_is_replaced_and_its_comment_stays_where_it_is() {
        let text = "module m #(\n    parameter A = 12,           // an A\n    \
                    parameter [A-1:0] LONG_A = 1,  // more\n    parameter B = 3             // a B\n) (\n";
        let changed = with_default(text, "A", "4096");
        assert_eq!(changed, text.replace("A = 12,           //", "A = 4096,         //"));
        let changed = with_default(text, "LONG_A", "12'd375000000");
        assert_eq!(changed, text.replace("= 1,  //", "= 12'd375000000,  //"));
        assert_eq!(with_default(text, "B", "1"), text.replace("B = 3 ", "B = 1 "));
        assert_eq!(with_default(text, "C", "1"), text);
    }
}
