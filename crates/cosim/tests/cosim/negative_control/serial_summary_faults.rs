// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of summaries in the serial organization.
//!
//! A sum that passes during a reset is compared and written all the same. This is never visible,
//! because the next frame starts over.

use super::fault_designs::FaultDesign::{
    SerialMeans as Means, SerialMeansMany as Many, SerialMeansRaster as Raster,
};
use super::faults::{RtlFault, fault};

/// All faults, by module.
#[rustfmt::skip]
pub(crate) const FAULTS: &[RtlFault] = &[
    fault("operator", Means, "serial_summary", ".level_i(level_i), .above_o(above)", ".level_i(level_i - 1'b1), .above_o(above)"),
    fault("index", Raster, "serial_summary", "mean = product[SHIFT+:WIDTH]", "mean = product[SHIFT-1+:WIDTH]"),
    fault("index", Means, "serial_summary", "second ? in_second : in_first", "in_first"),
    fault("operator", Means, "serial_summary", "to_second = !was_second && !first_q", "to_second = was_second && !first_q"),
    fault("reset", Means, "serial_summary", "if (rst_i) first_q <= 1'b1;\n        else if", "if"),
    fault("constant", Means, "serial_summary", "else if (frame_i) first_q", "else if (decided_i) first_q"),
    fault("operator", Means, "serial_summary", "{!active_i && (summary_o || shows),", "{(summary_o || shows),"),
    fault("operator", Means, "serial_summary", "{!active_i && (summary_o || shows),", "{!srs_i && (summary_o || shows),"),
    fault("constant", Raster, "serial_summary", "(summary_o || shows),", "summary_o,"),
    fault("operator", Means, "serial_summary", "summary_o ? to_second : !to_second", "to_second"),
    fault("operator", Means, "serial_summary", "passed_q && !to_second_q", "passed_q"),
    fault("operator", Many, "serial_summary", "passed_q && to_second_q", "passed_q"),
    fault("index", Means, "serial_summary", "passed_at_q[WORD_BITS-1-:REGION_BITS]", "passed_at_q[0+:REGION_BITS]"),
    fault("operator", Means, "serial_summary", "~|passed_at_q[0+:BLOCK_BITS]", "&passed_at_q[0+:BLOCK_BITS]"),
    fault("operator", Means, "serial_summary", "above || (!starts_q && differs)", "above"),
    fault("constant", Means, "serial_summary", "(!shows || differs)", "!shows"),
    fault("operator", Raster, "serial_summary", "decided_i && !srs_i", "decided_i"),
    fault("index", Means, "serial_summary", "compared_q ? compared_at_q : region_i", "region_i"),
    fault("index", Means, "serial_summary", "{next_region_i, next_block_i}", "{region_i, block_i}"),
    fault("width", Means, "serial_summary", "{1'b0, mean} - {1'b0, shown_q}", "{mean[WIDTH-1], mean} - {shown_q[WIDTH-1], shown_q}"),

    fault("constant", Means, "serial_means", "\"distributed\", no_rw_check *)\n            reg [WIDTH-1:0] means_q[0:WORDS-1];",
        "\"distributed\", no_rw_check *)\n            reg [WIDTH-1:0] means_q[0:WORDS/4-1];"),
    fault("constant", Many, "serial_means", "\"block\", no_rw_check *)\n            reg [WIDTH-1:0] means_q[0:WORDS-1];",
        "\"block\", no_rw_check *)\n            reg [WIDTH-1:0] means_q[0:WORDS/4-1];"),

    fault("operator", Means, "serial_states", "is_averaging ? !last_block_i : first_score_i", "!is_averaging && first_score_i"),
    fault("constant", Many, "serial_states", "RETURNED = LATE == 0 ? STORE : BEHIND", "RETURNED = STORE"),
    fault("constant", Many, "serial_states", "IDLE: state = is_returning ? STORE : WRITE", "IDLE: state = WRITE"),
    fault("reset", Means, "serial_states", "                    averaging_q <= 1'b0;", "                    averaging_q <= averaging;"),
    fault("reset", Means, "serial_states", "                    returning_q <= 1'b0;", "                    returning_q <= returning;"),
    fault("constant", Means, "serial_addresses", "BLOCK_SKIP = LEAVING_SIDE - BLOCK + 1", "BLOCK_SKIP = LEAVING_SIDE - BLOCK"),
    fault("constant", Means, "serial_addresses", "NEXT_BLOCK = 1 - (BLOCK - 1)", "NEXT_BLOCK = 2 - (BLOCK - 1)"),
    fault("constant", Means, "serial_addresses", "MEAN_AT = 0;", "MEAN_AT = RAW_SIDE * RAW_SIDE;"),
    fault("constant", Means, "serial_addresses", "sums_start = SUMMARIES && first_score_i && !averaging", "sums_start = 1'b0"),
    fault("index", Means, "serial_addresses", "row_of_blocks_ends ? LEAVING_SKIP : NEXT_BLOCK", "NEXT_BLOCK"),
    fault("index", Raster, "serial_addresses", "block_column * BLOCK\n", "block_column * SIDE\n"),
    fault("operator", Means, "serial_regions", "(averaging_i ? !last_block_o : first_score_o)", "(averaging_i && !last_block_o)"),
    fault("reset", Raster, "serial_regions", "if (loading_i) block_q <= {BLOCK_BITS{1'b0}};\n                else if", "if"),
    fault("constant", Means, "serial_constant", "HALF_BLOCK = BLOCK / 2;", "HALF_BLOCK = (BLOCK - 1) / 2;"),
    fault("constant", Raster, "serial_constant", "HALF_BLOCK = BLOCK / 2;", "HALF_BLOCK = (BLOCK + 1) / 2;"),
    fault("operator", Raster, "serial_controls", "keep = keeping || (coded && shift)", "keep = keeping"),
    fault("constant", Means, "serial_group", "{3{BORDERS != 0}}, RETURNS}", "{3{BORDERS != 0}}, 1'b0}"),
    fault("constant", Means, "serial_group", "SUMS || MEANS, ", "SUMS, "),

    fault("index", Means, "serial_lane", "write_mean ? chain_q[WIDTH-1:0] : acc_q[WIDTH-1:0]", "acc_q[WIDTH-1:0]"),
    fault("index", Means, "serial_lane", "unload_mean && flags_q[FLAGS-1]", "unload_mean && flags_q[0]"),
    fault("constant", Means, "serial_lane", "if (unload_mean) chain_q <= {CHAIN_BITS{1'b0}};\n                else chain_q", "chain_q"),
    fault("index", Means, "serial_lane", "acc_q[DROPPED+:CHAIN_BITS]", "acc_q[DROPPED-1+:CHAIN_BITS]"),
    fault("index", Raster, "serial_lane", "(keep ? word_i : fetched)", "fetched"),
    fault("operator", Means, "serial_decision", "last ? summary_i : srs", "srs"),
    fault("constant", Many, "serial_decision", "!rotate_i ? flags_i[FLAGS-1] : temporal", "temporal"),
    fault("constant", Means, "serial_array", "RASTER == 0 && shown_return ? wide_mean[CHAIN_BITS-1:0] : {CHAIN_BITS{1'b0}}", "{CHAIN_BITS{1'b0}}"),
    fault("index", Raster, "serial_array", "shown_return ? flags[FLAGS-1] : flags[0]", "flags[0]"),
    fault("index", Raster, "serial_array", "shown_return ? mean : ring[WIDTH-1:0]", "ring[WIDTH-1:0]"),
    fault("index", Many, "serial_shown", "bits[LATE*WIDTH+:WIDTH]", "bits[0+:WIDTH]"),
];
