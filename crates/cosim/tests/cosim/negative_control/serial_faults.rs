// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the serial organization.
//!
//! Some edits of its resets and clears change nothing that is ever seen, and are not among these: a first
//! frame has no reference, so that a count left behind by a reset is never shown; a rotation leaves zeros;
//! what is written astray after a reset is written over by the next frame; and the
//! candidate of a median is never negative, so that all its signs are equal.

use super::faults::{Fault, fault};
use super::planted::Planted::{
    SerialBlock as Block, SerialConstant as Constant, SerialCorner as Corner, SerialEdge as Edge,
    SerialFold as Fold, SerialMad as Mad, SerialMany as Many, SerialPaper as Paper,
    SerialRaster as Raster, SerialSent as Sent, SerialVariance as Variance,
};

/// Every fault, by module.
#[rustfmt::skip]
pub(crate) const FAULTS: &[Fault] = &[
    fault("operator", Paper, "carry_adder", "} - {~other_i", "} + {~other_i"),
    fault("constant", Paper, "carry_adder", "~carry_i}", "1'b0}"),
    fault("constant", Mad, "carry_adder", "~carry_i}", "1'b1}"),
    fault("width", Paper, "carry_adder", "{plain_i, 1'b0}", "{1'b0, plain_i[WIDTH-2:0], 1'b0}"),

    // Only the largest gradient with a level just below it needs the highest bit.
    fault("width", Edge, "rcm", ".ACC_BITS(11)", ".ACC_BITS(10)"),

    fault("operator", Paper, "serial_lane", "stays = sum[ACC_BITS-1] == acc_q[ACC_BITS-1];",
        "stays = sum[ACC_BITS-1] != acc_q[ACC_BITS-1];"),
    fault("constant", Raster, "serial_lane", "RASTER != 0 && select_row_i && select_column_i", "RASTER != 0 && select_row_i"),
    fault("constant", Sent, "serial_lane", "write_active_i && flags_q[0]", "write_active_i"),
    fault("index", Sent, "serial_lane", "write_border_i && sides_i[side_i]", "write_border_i && sides_i[~side_i]"),
    fault("operator", Paper, "serial_lane", "loading_i ? pixel_i : acc_q[WIDTH-1:0]", "loading_i ? acc_q[WIDTH-1:0] : pixel_i"),
    fault("width", Mad, "serial_lane", "{{(ACC_BITS - MEAN_BITS) {1'b0}}, difference", "{{(ACC_BITS - MEAN_BITS) {negative}}, difference"),
    fault("constant", Mad, "serial_lane", "word} << FRACTION", "word} << (FRACTION - 1)"),
    fault("operator", Variance, "serial_lane", "!masked_i || |(plain & constant_i)", "!masked_i || &(plain & constant_i)"),
    fault("operator", Variance, "serial_lane", "from_aux_i ? wide_aux : wide_word", "wide_word"),
    fault("constant", Mad, "serial_lane", "turned && carry_i", "carry_i"),
    fault("operator", Mad, "serial_lane", "takes && (!divide_i || stays)", "takes"),
    fault("operator", Variance, "serial_lane", "enable_i && takes &&", "enable_i &&"),
    // A mean with more bits than the sum of a region has.
    fault("reset", Variance, "serial_lane", "if (shift_i) aux_q <= {AUX_BITS{1'b0}};\n                else if", "if"),
    fault("operator", Mad, "serial_lane", "{(ACC_BITS - MEAN_BITS) {invert}}", "{(ACC_BITS - MEAN_BITS) {turned}}"),
    fault("constant", Paper, "serial_lane", "{{(CHAIN_BITS - 1) {1'b0}}, scored}", "{CHAIN_BITS{1'b0}}"),
    fault("constant", Paper, "serial_lane", "invert && carry_i", "1'b1"),
    fault("operator", Paper, "serial_lane", "by_sign_i && !acc_q[ACC_BITS-1]", "by_sign_i && acc_q[ACC_BITS-1]"),
    fault("operator", Paper, "serial_lane", "by_run_i && five", "by_run_i && !five"),
    fault("operator", Corner, "serial_lane", "negative_q == acc_q[ACC_BITS-1]", "negative_q != acc_q[ACC_BITS-1]"),
    fault("index", Corner, "serial_lane", "run_q[3] && on", "run_q[2] && on"),
    fault("operator", Corner, "serial_lane", "five || reaches : stays", "five : stays"),
    fault("constant", Corner, "serial_lane", "if (run_clear_i) run_q <= 5'b00000;\n                else if (run_i && !five && (stays || run_corner_i))",
        "if (run_i && !five && (stays || run_corner_i))"),
    fault("width", Paper, "serial_lane", "run_q <= {run_q[3:0], 1'b1}", "run_q <= {run_q[2:0], 2'b11}"),
    fault("operator", Paper, "serial_lane", "assign hit = stays || (EDGE != 0 && run_q[0]);", "assign hit = stays;"),
    fault("constant", Edge, "serial_lane", "else if (run_i) run_q <= stays;", "else if (run_i) run_q <= 1'b0;"),
    fault("index", Paper, "serial_lane", "shift_i ? word_i : fetch_i", "fetch_i"),
    fault("constant", Sent, "serial_lane", "if (shift_i) flags_q <= flags_i;", "flags_q <= flags_i;"),

    fault("index", Block, "serial_memory", "data_q <= pixels_q[address_i];", "data_q <= pixels_q[address_i ^ 1'b1];"),
    fault("width", Block, "serial_memory", "pixels_q[address_i] <= data_i", "pixels_q[address_i] <= {1'b0, data_i[WIDTH-2:0]}"),
    fault("constant", Block, "serial_memory", "reg [WIDTH-1:0] pixels_q[0:WORDS-1];", "reg [WIDTH-1:0] pixels_q[0:WORDS/2-1];"),
    fault("width", Paper, "serial_memory", ".data_i(data_i)", ".data_i({1'b0, data_i[WIDTH-2:0]})"),

    fault("constant", Paper, "serial_parallel_feed", "LAST = PIXELS - 1;", "LAST = PIXELS - 2;"),
    fault("reset", Paper, "serial_parallel_feed", "if (rst_i) word_q <= SECOND;\n        else if", "if"),
    fault("reset", Paper, "serial_parallel_feed", "rst_i || reopen_i || (ready_q", "reopen_i || (ready_q"),
    fault("reset", Fold, "serial_parallel_feed", "if (rst_i) slot_q <= {SLOT_BITS{1'b0}};\n                else if", "if"),
    fault("constant", Fold, "serial_parallel_feed", "LAST_SLOT = FOLD - 1;", "LAST_SLOT = FOLD;"),

    fault("reset", Raster, "serial_raster_feed", "            ready_q <= 1'b1;\n            x_q", "            x_q"),
    fault("reset", Raster, "serial_raster_feed", "            y_q <= {INNER_BITS{1'b0}};\n            column_q <= {COLUMN_BITS{1'b0}};\n            row_q",
        "            column_q <= {COLUMN_BITS{1'b0}};\n            row_q"),
    fault("reset", Sent, "serial_raster_feed", "busy_q   <= 1'b0;\n", "busy_q   <= busy_q;\n"),
    fault("reset", Sent, "serial_raster_feed", "across_q <= 2'd0;\n                    down_q   <= 2'd0;", "across_q <= across_q;\n                    down_q   <= 2'd0;"),
    fault("constant", Raster, "serial_raster_feed", "NEXT_LINE = STRIDE - (SIDE - 1);", "NEXT_LINE = STRIDE - (SIDE - 2);"),
    fault("index", Sent, "serial_raster_feed", "lane_q <= row_lane_q;", "lane_q <= lane_q;"),
    fault("index", Sent, "serial_raster_feed", "row_slot_q <= next_slot;", "row_slot_q <= row_slot_q;"),
    fault("operator", Sent, "serial_raster_feed", "last_across && down_q == down_more", "last_across"),
    fault("operator", Raster, "serial_raster_feed", "take_o = ready_q && valid_i", "take_o = valid_i"),

    fault("constant", Sent, "serial_places", "NEAR = HALO;", "NEAR = HALO - 1;"),
    fault("constant", Sent, "serial_places", "FAR = SIDE - HALO;", "FAR = SIDE - HALO + 1;"),
    fault("constant", Sent, "serial_places", "REPEATED = HALO;", "REPEATED = HALO - 1;"),
    fault("operator", Sent, "serial_places", "offset = OWN + REGION", "offset = OWN - REGION"),
    fault("constant", Sent, "serial_places", "place_i == 2'd1 ? OWN + ONE : OWN + ONE + ONE", "place_i == 2'd1 ? OWN : OWN + ONE + ONE"),
    fault("index", Sent, "serial_neighbor", "far = lanes(COLUMNS + 1); on = slots(COLUMNS + 1)", "far = lanes(COLUMNS); on = slots(COLUMNS)"),
    fault("index", Sent, "serial_neighbor", "far = lanes(-1 - COLUMNS);", "far = lanes(1 - COLUMNS);"),
    fault("operator", Sent, "serial_neighbor", "over = plain >= SLOTS", "over = plain > SLOTS"),
    fault("width", Sent, "serial_neighbor", "over ? plain - SLOTS : plain", "plain"),
    fault("constant", Sent, "serial_sides", "REGION / COLUMNS == 0,", "REGION / COLUMNS == 1,"),
    fault("index", Sent, "serial_sides", "table_of_sides[4*slot_i+:4]", "table_of_sides[0+:4]"),
    fault("constant", Sent, "serial_sides", "REGION % COLUMNS == COLUMNS - 1", "REGION % COLUMNS == COLUMNS"),

    fault("operator", Paper, "serial_group", "!loading_q || valid_i) address_q", "1'b1) address_q"),
    fault("constant", Paper, "serial_group", "write_q || (loading_q && valid_i)", "write_q || valid_i"),
    fault("reset", Paper, "serial_group", "if (rst_i) address_q <= {ADDRESS_BITS{1'b0}};\n                else if", "if"),
    fault("index", Many, "serial_group", "lane >> 6 == OWN", "1'b1"),
    fault("width", Many, "serial_group", "8'd1 << lane[5:3]", "8'd1 << lane[4:3]"),
    fault("width", Many, "serial_group", "8'd1 << lane[2:0]", "8'd1 << lane[1:0]"),

    fault("constant", Mad, "serial_group", ".USED(MAD), .LATE(WORD)) u_deviate", ".USED(VARIANCE), .LATE(WORD)) u_deviate"),
    fault("index", Paper, "serial_group", ".bits_i(run_clear_i)", ".bits_i(count_i)"),

    fault("reset", Paper, "serial_control", "if (rst_i) bits_q <= {(LATE + 1) * WIDTH{1'b0}};\n                else bits_q", "bits_q"),
    fault("constant", Paper, "serial_control", "if (USED == 0)", "if (USED == 0 || WIDTH > 1)"),
    fault("index", Block, "serial_control", "bits_q[LATE*WIDTH+:WIDTH]", "bits_q[0+:WIDTH]"),
    fault("reset", Paper, "serial_shown", "if (rst_i) bits_q <= {(LATE + 1) * WIDTH{1'b0}};\n        else bits_q", "bits_q"),
    fault("index", Block, "serial_shown", "bits_q[LATE*WIDTH+:WIDTH]", "bits_q[0+:WIDTH]"),

    fault("constant", Sent, "serial_decision", ".write_i(rotate_i && last)", ".write_i(rotate_i)"),
    fault("operator", Sent, "serial_decision", ".data_i(active ||", ".data_i(!active ||"),
    fault("reset", Paper, "serial_decision", "if (rst_i) first_q <= 1'b1;\n        else if", "if"),
    fault("constant", Paper, "serial_decision", "else if (frame_i) first_q <= 1'b0;", "else if (rotate_i) first_q <= 1'b0;"),
    fault("operator", Paper, "serial_decision", "score_o >= minimum;", "score_o > minimum;"),
    fault("operator", Constant, "serial_decision", "score_o >= minimum;", "score_o > minimum;"),
    fault("operator", Fold, "serial_decision", "region_i} < BEHIND", "region_i} <= BEHIND"),
    fault("constant", Paper, "serial_decision", "EVERY = PIXELS;", "EVERY = PIXELS - 1;"),
    fault("operator", Corner, "serial_decision", "flags_i[1] && vote : flags_i[1] || vote", "flags_i[1] || vote : flags_i[1] || vote"),
    fault("constant", Corner, "serial_decision", "temporal ? ALL != 0 : srs", "srs"),
    fault("operator", Sent, "serial_decision", "active || (reference && (srs || BLANKS == 0))", "active || reference"),
    fault("constant", Sent, "serial_decision", "reference = referenced && !first_q;", "reference = referenced;"),
    fault("index", Corner, "serial_decision", "minima_i[index_i*SCORE_BITS+:SCORE_BITS]", "minima_i[0+:SCORE_BITS]"),
    fault("operator", Paper, "serial_decision", "flags_i[0] && srs && region_valid_o", "srs && region_valid_o"),

    fault("index", Many, "serial_array", "rows[GROUP*8+(i%64)/8]", "rows[(i%64)/8]"),
    fault("index", Paper, "serial_array", "assign pixel = pixel_i[i*WIDTH+:WIDTH];", "assign pixel = pixel_i[0+:WIDTH];"),
    fault("index", Paper, "serial_array", "words[i*WIDTH+:WIDTH];\n            end", "words[0+:WIDTH];\n            end"),
    fault("operator", Raster, "serial_array", "shown_unload && flags[0]", "shown_unload || flags[0]"),
    fault("constant", Fold, "serial_array", "working ? {slot, word} :", "working ? {place_slot, word} :"),

    fault("reset", Paper, "serial_sequencer", "            state_q <= LOAD;", "            state_q <= state;"),
    fault("constant", Sent, "serial_sequencer", "last_column && part_q == 2'd3;", "last_column && part_q == 2'd2;"),
    fault("constant", Mad, "serial_sequencer", "HALF_PIXELS = PIXELS / 2;", "HALF_PIXELS = PIXELS / 2 + 1;"),
    fault("constant", Variance, "serial_sequencer", "FACTOR = PIXELS;", "FACTOR = PIXELS - 1;"),
    fault("operator", Variance, "serial_sequencer", "pairs_q & (pairs_q - 1'b1)", "pairs_q & (pairs_q + 1'b1)"),
    fault("index", Paper, "serial_sequencer", "neighbor[2:0] >= 3'd2 && neighbor[2:0] <= 3'd4", "neighbor[2:0] > 3'd2 && neighbor[2:0] <= 3'd4"),
    fault("operator", Paper, "serial_sequencer", "down && (CLAMPS == 0 || !last_row)", "down"),
    fault("operator", Paper, "serial_sequencer", "left && (CLAMPS == 0 || column_q != 0)", "left"),
    fault("constant", Corner, "serial_sequencer", "ring_last = tap_q == 4'd11", "ring_last = tap_q == 4'd10"),
    fault("index", Fold, "serial_sequencer", "LAST_LANE = (LANES - 1) * FOLD;", "LAST_LANE = LANES - 1;"),
    fault("constant", Paper, "serial_sequencer", "scale_q <= UNIT << (WIDTH - 1);", "scale_q <= UNIT << (WIDTH - 2);"),
    fault("constant", Paper, "serial_sequencer", "state_q == LOAD || testing || unloading", "state_q == LOAD || unloading"),
    fault("constant", Mad, "serial_sequencer", "else if (in_sum)", "else if (dividing)"),
    fault("width", Sent, "serial_sequencer", "row_q != 0 && row_q <= LAST_COUNTED", "row_q <= LAST_COUNTED"),
    fault("index", Sent, "serial_sequencer", "2'd2: center_q <= BOTTOM_START;", "2'd2: center_q <= TOP_START;"),
];
