// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the raster organization.
//!
//! The flags of the lower border have no faults here. They change nothing in frames that the core
//! completes below, because the rows that it adds repeat the last one.

use super::fault_designs::FaultDesign::{
    RasterBanks as Banks, RasterExternal as Outside, RasterLost as Lost,
    RasterMadVariance as Moments, RasterPairs as Pairs, RasterPaper as Paper, RasterSent as Sent,
};
use super::faults::{RtlFault, fault};

/// All faults, by module.
#[rustfmt::skip]
pub(crate) const FAULTS: &[RtlFault] = &[
    fault("constant", Paper, "raster_memory", "if (write_i) words_q", "words_q"),
    fault("index", Paper, "raster_memory", "words_q[read_address_i]", "words_q[write_address_i]"),
    fault("width", Paper, "raster_memory", "<= data_i;", "<= {1'b0, data_i[WIDTH-2:0]};"),
    fault("index", Sent, "raster_memory", "assign data_o = output_q;", "assign data_o = read_q;"),

    fault("index", Paper, "word_delay", "line_q[WIDTH*(DEPTH-1)+:WIDTH]", "line_q[WIDTH*(DEPTH-2)+:WIDTH]"),
    fault("index", Paper, "bit_delay", "bits_q[DEPTH-1]", "bits_q[DEPTH-2]"),
    fault("reset", Paper, "bit_delay", "rst_i ? {DEPTH{1'b0}} : {bits_q", "{bits_q"),

    fault("index", Sent, "raster_pad", "word_i[(REST-1)*WIDTH+:WIDTH]", "word_i[REST*WIDTH+:WIDTH]"),
    fault("constant", Paper, "raster_pad", "pad_i ? {LANES{last_q}} : filled", "filled"),
    fault("operator", Paper, "raster_pad", "step_i && !pad_i", "step_i"),

    fault("constant", Paper, "raster_control", "BEFORE_LAST_WORD = ROW_WORDS - 2;", "BEFORE_LAST_WORD = ROW_WORDS - 3;"),
    fault("operator", Paper, "raster_control", "own_q || (ready_o && valid_i)", "own_q || valid_i"),
    fault("index", Paper, "raster_control", "left_o = unit_end_q[3:2]", "left_o = unit_end_q[2:1]"),
    fault("index", Paper, "raster_control", "top_o = {top_2q, old_top_q[1]}", "top_o = {old_top_q[2], old_top_q[1]}"),
    fault("constant", Sent, "raster_control", "&& !busy_i;", ";"),
    fault("constant", Paper, "raster_control", "settled_q  <= LAST_SETTLE == 0;", "settled_q  <= 1'b1;"),
    fault("reset", Paper, "raster_control", "            taken_row_q     <= 1'b1;\n", ""),
    fault("operator", Paper, "raster_control", "frame_last = !real_q && !old_real_q[WINDOWS]", "frame_last = !old_real_q[WINDOWS]"),

    fault("operator", Paper, "raster_window", "assign top_o = top_q;", "assign top_o = 1'b0;"),
    fault("operator", Paper, "raster_window", "REPEATS && repeat_q ? middle : word_q", "word_q"),
    fault("index", Paper, "raster_window", "write_place = old_place_q;", "write_place = place_q;"),
    fault("constant", Sent, "raster_window", "bottom_3q    <= bottom_2q;", "bottom_3q    <= 1'b0;"),

    fault("index", Sent, "raster_line", ".write_address_i(old_place_q)", ".write_address_i(place)"),
    fault("constant", Sent, "raster_line", ".WORDS(ROW_WORDS), .PLACE_BITS", ".WORDS(ROW_WORDS - 1), .PLACE_BITS"),

    fault("operator", Paper, "median_columns", "ab ? (bc ? c : b) : (ac ? c : a)", "ab ? (bc ? c : b) : (ac ? a : c)"),
    fault("operator", Sent, "median_columns", "(top_q || ab_q ? bc_q : ac_q)", "(ab_q ? bc_q : ac_q)"),
    fault("operator", Sent, "median_columns", "{!bottom_q && (top_q", "{(top_q"),
    fault("operator", Sent, "median_columns", "top_q || bottom_q || ab_q == bc_q", "bottom_q || ab_q == bc_q"),
    fault("operator", Sent, "median_columns", "ab_q != bc_q && ab_q == ac_q", "ab_q != bc_q && ab_q != ac_q"),
    fault("operator", Sent, "median_columns", "(!top_q && ab_q ? !ac_q : !bc_q)", "(ab_q ? !ac_q : !bc_q)"),
    fault("index", Sent, "median_columns", "choice[1] ? c : choice[0] ? b : a", "choice[0] ? b : choice[1] ? c : a"),
    fault("constant", Paper, "median_columns", "top = top_i ? b : a;", "top = a;"),
    fault("constant", Pairs, "median_columns", "bottom = bottom_i ? b : c;", "bottom = c;"),
    fault("operator", Paper, "median_columns", "top > bottom", "a > c"),
    fault("constant", Sent, "median_columns", "(lane == 0 && row_left)", "1'b0"),
    fault("constant", Sent, "median_columns", "lane == LANES - 1 && row_right", "1'b0"),
    fault("constant", Paper, "median_columns", "next_above[3*LANES-2] || merge_right_q", "next_above[3*LANES-2]"),
    fault("width", Paper, "median_columns", "{no_right, b} > {1'b0, c}", "b > c"),
    fault("index", Sent, "median_columns", "earlier = next_above[3*(lane-1)+level]", "earlier = last_q[level]"),

    fault("operator", Paper, "raster_edge", "{1'b0, lower_2q[(lane+1)*FOUR+:FOUR]} - {", "{1'b0, lower_2q[(lane+1)*FOUR+:FOUR]} + {"),
    fault("index", Paper, "raster_edge", "left_2q ? {first_upper_2q, 1'b0} : upper_2q[FOUR-1:0]", "upper_2q[FOUR-1:0]"),
    fault("constant", Sent, "raster_edge", "top_i ? middle : top", "top"),
    fault("constant", Pairs, "raster_edge", "bottom_i ? middle : bottom", "bottom"),
    fault("operator", Paper, "raster_edge", "hit_q <= sum_above || diff_above;", "hit_q <= sum_above;"),
    fault("width", Paper, "raster_edge", "level_i[LEVEL_BITS-1:1]", "{1'b0, level_i[LEVEL_BITS-2:1]}"),
    fault("operator", Sent, "raster_edge", "sum_above_4q || diff_above_4q", "diff_above_4q"),

    fault("operator", Sent, "raster_corner", "neighbor > high[WIDTH-1:0]", "neighbor >= high[WIDTH-1:0]"),
    fault("index", Sent, "raster_corner", "&& brighter[(i+3)%8] && brighter[(i+4)%8]", "&& brighter[(i+3)%8]"),
    fault("constant", Sent, "raster_corner", "top_i ? middle : upper_i", "1'b0 ? middle : upper_i"),
    fault("constant", Sent, "raster_corner", "bottom_i ? middle : lower_i", "1'b0 ? middle : lower_i"),
    fault("constant", Sent, "raster_corner", "on_left ? flags[1] : flags[0]", "flags[0]"),

    fault("operator", Paper, "raster_change", "word_i[lane*WIDTH+:WIDTH]} - {", "word_i[lane*WIDTH+:WIDTH]} + {"),
    fault("width", Sent, "magnitude_above", "missing[WIDTH]", "missing[WIDTH-1]"),
    fault("constant", Sent, "magnitude_above", "{1'b0, level_i, !negative}", "{1'b0, level_i, 1'b1}"),
    fault("width", Paper, "raster_change", "{1'b0, word_i[lane*WIDTH+:WIDTH]}", "{2'b0, word_i[lane*WIDTH+:WIDTH-1]}"),

    fault("operator", Paper, "raster_counts", "top ? {FEATURES * KEPT_BITS{1'b0}} : kept_above", "kept_above"),
    fault("reset", Paper, "raster_counts", "            fresh_q  <= 1'b1;\n", ""),
    fault("constant", Sent, "raster_counts", "DEEP && EARLY ? 1 : 0", "DEEP && EARLY ? 2 : 0"),
    fault("constant", Outside, "raster_counts", "DEEP && !EARLY ? 1 : 0", "0"),
    fault("index", Sent, "raster_counts", "hits_i[feature*LANES+lane]", "hits_i[feature*LANES]"),
    fault("width", Paper, "raster_counts", "$clog2((SIDE - 1) * SIDE + 1);", "$clog2((SIDE - 1) * SIDE + 1) - 1;"),

    fault("constant", Banks, "raster_banks", ".DEPTH(4)", ".DEPTH(3)"),
    fault("index", Banks, "raster_banks", "given_q <= write[group] && write_place[group][BANK_BITS+:SLOT_BITS] == OWN;", "given_q <= write[group];"),
    fault("index", Banks, "raster_banks", "if (comes) bank_words_q", "if (asked_q) bank_words_q"),
    fault("constant", Banks, "raster_core", "CENTER_CLOCKS - 2 - GROUPS", "CENTER_CLOCKS - 1 - GROUPS"),
    fault("constant", Pairs, "raster_pairs", "again = again_q && !waits_q;", "again = again_q;"),
    fault("constant", Pairs, "raster_pairs", "come_second_q || come_half;", "come_second_q;"),
    fault("constant", Pairs, "raster_pairs", "ask_half = HALF && last_pair_q", "ask_half = HALF"),
    fault("reset", Pairs, "raster_pairs", "            again_q       <= 1'b1;\n", ""),
    fault("operator", Pairs, "raster_pairs", "write = waits_q && !read;", "write = waits_q;"),
    fault("index", Pairs, "raster_pairs", "come_second_q ? first_q : word_i", "word_i"),
    fault("reset", Pairs, "raster_pairs", "            come_second_q <= 1'b0;\n", ""),

    fault("operator", Outside, "raster_external", "read_i && !first_frame_i", "read_i"),
    fault("constant", Outside, "raster_external", ".DEPTH(1 + DEEP)", ".DEPTH(1)"),
    fault("operator", Outside, "raster_external", "reference_ready_o && !reference_valid_i", "!reference_valid_i"),
    fault("reset", Outside, "raster_external", "if (rst_i) underrun_o <= 1'b0;\n        else if", "if"),
    fault("reset", Outside, "raster_external", "write_i && !rst_i", "write_i"),

    fault("constant", Paper, "raster_store", ".WORDS(WORDS), .PLACE_BITS(ADDRESS_BITS)) u_read", ".WORDS(WORDS - 1), .PLACE_BITS(ADDRESS_BITS)) u_read"),
    fault("index", Sent, "raster_store", "write_place = place_i;", "write_place = read_place;"),
    fault("reset", Paper, "raster_store", ".rst_i(rst_i), .step_i(read_i)", ".rst_i(1'b0), .step_i(read_i)"),

    fault("constant", Paper, "raster_start", "NEXT_ROW = SEGMENT + (SIDE - 1) * ROW_WORDS", "NEXT_ROW = SEGMENT + SIDE * ROW_WORDS"),
    fault("constant", Sent, "raster_start", "ROW_STEP = SEGMENT + (SIDE - 1) * ROW_WORDS", "ROW_STEP = SEGMENT + SIDE * ROW_WORDS"),
    fault("reset", Paper, "raster_start", "            start_o       <= {START_BITS{1'b0}};\n", ""),

    fault("operator", Lost, "raster_valid", "(decided_bit_q ^ read_lost_bit)", "decided_bit_q"),
    fault("reset", Sent, "raster_valid", " && !none_i;", ";"),

    fault("constant", Paper, "raster_walk", "JUMP = ROW_WORDS - SEGMENT + 1", "JUMP = ROW_WORDS - SEGMENT"),
    fault("constant", Sent, "raster_walk", "LAST_POSITION = SIDE * SIDE - LANES", "LAST_POSITION = SIDE * SIDE - 2 * LANES"),
    fault("index", Moments, "raster_walk", "if (begin_i) begin\n            place_q      <= start_i;", "if (begin_i) begin\n            place_q      <= place_q;"),

    fault("operator", Moments, "raster_repeat", "repeat_i ? above : word_i", "word_i"),
    fault("index", Moments, "raster_repeat", "(step_i ? next : place_q)", "(place_q)"),

    fault("operator", Moments, "raster_sums", "top ? {SUM_BITS{1'b0}} : above", "above"),
    fault("constant", Moments, "raster_sums", "fresh_q ? {SUM_BITS{1'b0}} : row_q", "row_q"),

    fault("operator", Moments, "raster_variance", "multiple_q - square_q", "multiple_q + square_q"),
    fault("constant", Moments, "raster_variance", "factor * square_sum;", "square_sum;"),

    fault("operator", Lost, "raster_queue", "oldest_valid_q <= stored && !take_i", "oldest_valid_q <= stored"),
    fault("operator", Sent, "raster_queue", "stored && !read_valid_q", "stored"),
    fault("operator", Sent, "raster_queue", ".output_i(move)", ".output_i(1'b1)"),
    fault("operator", Sent, "raster_queue", "stored || read_valid_q || oldest_valid_q", "stored"),

    fault("operator", Moments, "raster_pass", "scaled < mean ? mean - scaled : scaled - mean", "scaled - mean"),
    fault("operator", Moments, "raster_pass", "(!reading_q || last);", "!reading_q;"),
    fault("constant", Moments, "raster_pass", "first_2q ? {SUM_BITS{1'b0}} : sum_q", "sum_q"),

    fault("operator", Paper, "raster_readout", "oldest_age >= AGE", "oldest_age > AGE"),
    fault("operator", Paper, "raster_readout", "held_age >= AGE", "held_age > AGE"),
    fault("index", Lost, "raster_readout", "held_stale ? held_region_q : oldest_region", "oldest_region"),
    fault("operator", Paper, "raster_readout", "assign step_o = !valid_o || ready_i;", "assign step_o = ready_i;"),
    fault("reset", Paper, "raster_readout", "        if (rst_i) held_q <= 1'b0;\n", ""),
    fault("operator", Paper, "raster_readout", "abort = held_stale && !first_o", "abort = held_stale"),
    fault("index", Paper, "raster_forward", ".output_i(step)", ".output_i(1'b1)"),
    fault("operator", Paper, "raster_readout", "fetched_last_q || aborted_q || abort;", "fetched_last_q || aborted_q;"),
    fault("operator", Paper, "raster_readout", "abort_o          <= aborted_q || abort;", "abort_o          <= aborted_q;"),
    fault("operator", Sent, "raster_readout", "fetched_last_q || aborted_q || abort;", "aborted_q || abort;"),
    fault("operator", Paper, "raster_readout", "!step_o && (aborted_q || abort);", "!step_o && abort;"),
    fault("operator", Paper, "raster_readout", "!step_o && (aborted_q || abort);", "aborted_q || abort;"),
    fault("index", Paper, "raster_readout", "begin_o          <= fetched_first_q;", "begin_o          <= first_o;"),
    fault("index", Paper, "raster_readout", "frame_o          <= fetched_frame_q;", "frame_o          <= frame_i;"),
    fault("index", Paper, "raster_readout", "held_region_o = held_region_q;", "held_region_o = oldest_region;"),

    fault("operator", Sent, "raster_decision", "srs = ALL ? &decided_votes", "srs = ALL ? |decided_votes"),
    fault("constant", Sent, "raster_decision", "blanked = BLANKS && !srs;", "blanked = 1'b0;"),
    fault("index", Sent, "raster_decision", "last_region_o    <= decided_last;", "last_region_o    <= last_region_q;"),
    fault("constant", Sent, "raster_decision", "!LAST_SENT || reference_valid ? scores_i", "1'b1 ? scores_i"),

    fault("reset", Paper, "raster_forward", "            lost_o       <= 1'b0;\n", ""),
    fault("reset", Paper, "raster_forward", "            lost_valid_o <= 1'b0;\n", ""),
    fault("reset", Paper, "raster_forward", "if (rst_i) frame_q <= {FRAME_BITS{1'b0}};\n        else if", "if"),
    fault("operator", Paper, "raster_forward", "decision_i && last_region_i", "decision_i"),
    fault("operator", Paper, "raster_forward", "held_frame = frame_q - {", "held_frame = frame_q + {"),
    fault("width", Pairs, "raster_forward", "LOW_BITS = ROWS < BANKS ? 2 : 1", "LOW_BITS = 1"),
    fault("constant", Lost, "raster_forward", "held_extra[LOW_BITS+:PLACE_BITS]", "held_extra[0+:PLACE_BITS]"),
    fault("constant", Sent, "raster_forward", "RAW ? raw_i : scored_i", "scored_i"),
    fault("constant", Sent, "raster_forward", "JUMP = ROW_WORDS - SEGMENT + 1", "JUMP = ROW_WORDS - SEGMENT"),

    fault("constant", Paper, "raster_ring", "BEFORE_LAST = WORDS - 2", "BEFORE_LAST = WORDS - 3"),
    fault("reset", Paper, "raster_ring", "            place_o <= {PLACE_BITS{1'b0}};\n            end_q", "            end_q"),
    fault("index", Moments, "raster_deviation", ".OUTPUT_STAGE(DEEP)\n    ) u_copy", ".OUTPUT_STAGE(1)\n    ) u_copy"),
    fault("constant", Moments, "raster_deviation", "HALF = SIDE * SIDE / 2", "HALF = 0"),
    fault("operator", Moments, "raster_moments", "word_i[lane*WIDTH+:WIDTH] * word_i[lane*WIDTH+:WIDTH]", "word_i[lane*WIDTH+:WIDTH] + word_i[lane*WIDTH+:WIDTH]"),

    fault("constant", Paper, "raster_core", "changes | {LANES{first_frame_q}}", "changes"),
];
