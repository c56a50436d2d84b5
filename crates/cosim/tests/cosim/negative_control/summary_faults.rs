// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of what irrelevant regions send.

use super::faults::{Fault, fault};
use super::planted::Planted::{
    Means, MeansDeep, MeansOne, MeansPixel, MeansSecond, RasterMeans, RasterMeansDeep,
    RasterMeansOne,
};

/// Every fault, by module.
#[rustfmt::skip]
pub(crate) const FAULTS: &[Fault] = &[
    fault("constant", Means, "block_place", "column == {{(BITS - 1) {1'b0}}, 1'b1}", "column == {BITS{1'b0}}"),
    fault("operator", Means, "block_place", "is_next_row ? ~|row : &row", "&row"),
    fault("index", Means, "block_place", "is_next_row = ~|address_i[0+:ROW]", "is_next_row = ~|address_i[0+:BITS]"),
    fault("index", Means, "block_place", "row = address_i[ROW+:BITS]", "row = address_i[ROW-1+:BITS]"),
    fault("constant", MeansSecond, "block_place", "FINAL = BLOCKS - 1;", "FINAL = BLOCKS;"),
    fault("constant", MeansSecond, "block_place", "END = BLOCK - 1;", "END = BLOCK - 2;"),
    fault("operator", MeansSecond, "block_place", "if (line_ends) row_q", "if (row_ends) row_q"),
    fault("reset", MeansSecond, "block_place", "                    column_q <= {BITS{1'b0}};", "                    column_q <= column_q;"),
    fault("reset", MeansSecond, "block_place", "                    row_q    <= {BITS{1'b0}};", "                    row_q    <= row_q;"),
    fault("reset", MeansSecond, "block_place", "                    block_q  <= 2'd0;", "                    block_q  <= block_q;"),

    fault("constant", Means, "block_mean", "HALF = BLOCK * BLOCK / 2", "HALF = (BLOCK * BLOCK - 1) / 2"),
    fault("constant", MeansSecond, "block_mean", "HALF = BLOCK * BLOCK / 2", "HALF = (BLOCK * BLOCK + 1) / 2"),
    fault("constant", MeansOne, "block_mean", "HALF = BLOCK * BLOCK / 2", "HALF = 0"),
    fault("operator", Means, "block_mean", "upper ? HALF", "!upper ? HALF"),
    fault("index", Means, "block_mean", ".advance_i(step_i && start), .data_i(sum_q)", ".advance_i(step_i && start), .data_i(sum)"),
    fault("operator", Means, "block_mean", ".advance_i(step_i && start)", ".advance_i(step_i)"),
    fault("width", Means, "block_mean", "mean_o = product[SHIFT+:WIDTH]", "mean_o = {1'b0, product[SHIFT+:WIDTH-1]}"),
    fault("constant", MeansDeep, "block_mean", "mean_o = product[SHIFT+:WIDTH]", "mean_o = product[SHIFT-1+:WIDTH]"),
    fault("operator", Means, "block_mean", "valid_o  = step_i && last", "valid_o  = last"),
    fault("operator", MeansDeep, "block_mean", "valid_q <= step_i && last", "valid_q <= last"),
    fault("index", MeansDeep, "block_mean", "assign dividend = sum_q;", "assign dividend = sum;"),

    fault("operator", Means, "region_summary", ".level_i(level_i), .above_o(above)", ".level_i(level_i - 1'b1), .above_o(above)"),
    fault("operator", MeansDeep, "region_summary", ".level_i(level_i), .above_o(last_above)", ".level_i(level_i - 1'b1), .above_o(last_above)"),
    fault("operator", MeansOne, "region_summary", ".level_i(level_i), .above_o(differs)", ".level_i(level_i - 1'b1), .above_o(differs)"),
    fault("operator", MeansOne, "region_summary", "{1'b0, mean_o} - {1'b0, held}", "{1'b0, mean_o} + {1'b0, held}"),
    fault("operator", Means, "region_summary", "width > widest_q", "width < widest_q"),
    fault("constant", Means, "region_summary", "{WIDTH{negative}}, negative};", "{WIDTH{negative}}, 1'b0};"),
    fault("width", Means, "region_summary", "^ {WIDTH{negative}}, negative}", "^ {1'b0, {(WIDTH - 1) {negative}}}, negative}"),
    fault("constant", Means, "region_summary", "else if (done_i) widest_q <=", "else if (1'b0) widest_q <="),
    fault("operator", MeansPixel, "region_summary", "found && (done_i || width", "found && (width"),
    fault("operator", MeansDeep, "region_summary", "found_q && !done_i", "found_q"),
    fault("operator", MeansDeep, "region_summary", "differs = above || last_above", "differs = above"),
    fault("operator", MeansDeep, "region_summary", "differs = above || last_above", "differs = last_above"),
    fault("reset", Means, "region_summary",
        "if (active_i) shows_q <= 1'b0;\n            else if", "if"),
    fault("operator", Means, "region_summary", "if (active_i) shows_q", "if (srs_i) shows_q"),
    fault("operator", Means, "region_summary", "else if (summary_o) shows_q <= 1'b1;", "else if (decided_i) shows_q <= 1'b1;"),
    fault("index", Means, "region_summary", "sent ? mean_o : held;", "sent ? held : mean_o;"),
    fault("index", Means, "region_summary", "sent ? mean_o : held;", "mean_o;"),
    fault("index", MeansOne, "region_summary", "sent ? mean_o : held;", "mean_o;"),
    fault("index", Means, "region_summary", ".data_i(shown)", ".data_i(entering)"),
    fault("operator", Means, "region_summary", "if (decided_i) sent_q <= summary_o;", "if (summary_o) sent_q <= 1'b1;"),
    fault("operator", Means, "region_summary", "leaves_o = complete && sent", "leaves_o = complete && shows_q"),
    fault("constant", Means, "region_summary", ".DEPTH(MEANS)) u_now", ".DEPTH(MEANS - 1)) u_now"),
    fault("constant", Means, "region_summary", ".DEPTH(MEANS)) u_held", ".DEPTH(1)) u_held"),
    fault("constant", MeansSecond, "region_summary", ".DEPTH(MEANS)) u_waiting", ".DEPTH(1)) u_waiting"),
    fault("index", MeansSecond, "region_summary", ".data_i(entering), .data_o(mean_o)", ".data_i(mean), .data_o(mean_o)"),
    fault("constant", MeansPixel, "region_summary", "SIDE == BLOCKS && decided_i ? summary_o : sent_q", "sent_q"),
    fault("operator", Means, "region_summary", "decided_i && !srs_i &&", "decided_i &&"),
    fault("operator", MeansSecond, "region_summary", "decided_i && !srs_i &&", "!srs_i &&"),
    fault("reset", Means, "region_summary", "            sent_q  <= 1'b0;", "            sent_q  <= sent_q;"),
    fault("reset", Means, "region_summary", "            shows_q <= 1'b0;\n        end", "            shows_q <= shows_q;\n        end"),

    fault("operator", Means, "rpu", ".forward_i(forward || mean_leaves)", ".forward_i(forward)"),
    fault("index", Means, "rpu", "mean_leaves ? leaving_mean : previous_pixel", "previous_pixel"),
    fault("constant", Means, "rpu", ".AHEAD(1)", ".AHEAD(0)"),
    fault("constant", MeansSecond, "rpu", ".SECOND(1)", ".SECOND(0)"),
    fault("index", MeansDeep, "rpu", ".pixel_i(tail_raw),\n        .done_i", ".pixel_i(tail_pixel),\n        .done_i"),
];

/// Those of raster cores.
#[rustfmt::skip]
pub(crate) const RASTER: &[Fault] = &[
    fault("constant", RasterMeans, "raster_parts", "LAST = SIZE - 1;", "LAST = SIZE - 2;"),
    fault("operator", RasterMeans, "raster_parts", "else if (step_i && last) part_q", "else if (step_i) part_q"),
    fault("constant", RasterMeansOne, "raster_parts", "last && SIZE != 1 << BITS", "last && 1'b0"),
    fault("reset", RasterMeans, "raster_parts", "if (rst_i) part_q <= {PART_BITS{1'b0}};\n                else if", "if"),
    fault("reset", RasterMeansOne, "raster_parts", "if (rst_i || (step_i", "if ((step_i"),

    fault("constant", RasterMeans, "raster_blocks", "BACK = COLUMNS - 1;", "BACK = COLUMNS;"),
    fault("constant", RasterMeans, "raster_blocks", "BEFORE_LAST = REGIONS - 2;", "BEFORE_LAST = REGIONS - 3;"),
    fault("operator", RasterMeans, "raster_blocks", "back = row_end_i && !complete;", "back = row_end_i;"),
    fault("operator", RasterMeans, "raster_blocks", "step_i && end_o && column_o == LAST[1:0];", "step_i && end_o;"),
    fault("operator", RasterMeans, "raster_blocks", "if (row_end_i && complete) row_o", "if (complete) row_o"),
    fault("reset", RasterMeans, "raster_blocks", "if (rst_i || frame_end_o) region_o", "if (frame_end_o) region_o"),
    fault("reset", RasterMeans, "raster_blocks", "            row_o         <= 2'd0;\n", ""),

    fault("constant", RasterMeansOne, "raster_summary", "HALF = BLOCK * BLOCK / 2", "HALF = (BLOCK * BLOCK + 1) / 2"),
    fault("operator", RasterMeans, "raster_summary", "sum_upper ? HALF", "!sum_upper ? HALF"),
    fault("width", RasterMeans, "raster_summary", "mean_q <= product[SHIFT+:WIDTH]", "mean_q <= {1'b0, product[SHIFT+:WIDTH-1]}"),
    fault("constant", RasterMeansDeep, "raster_summary", ".DEPTH(DEEP)) u_value", ".DEPTH(0)) u_value"),
    fault("constant", RasterMeans, "raster_summary", ".DEPTH(2)) u_early_sent", ".DEPTH(1)) u_early_sent"),
    fault("constant", RasterMeansOne, "raster_summary", ".DEPTH(SUM_CLOCKS + 1)) u_write_place", ".DEPTH(SUM_CLOCKS)) u_write_place"),
    fault("operator", RasterMeans, "raster_summary", ".level_i(level_i), .above_o(above_level)", ".level_i(level_i - 1'b1), .above_o(above_level)"),
    fault("operator", RasterMeansDeep, "raster_summary", "{1'b0, mean_q} - {1'b0, sent}", "{1'b0, mean_q} + {1'b0, sent}"),
    fault("operator", RasterMeans, "raster_summary", "(early_mark && !first)", "early_mark"),
    fault("operator", RasterMeansDeep, "raster_summary", "(early_mark && !first)", "1'b0"),
    fault("operator", RasterMeans, "raster_summary", "(differs_q && !region_start)", "differs_q"),
    fault("operator", RasterMeansDeep, "raster_summary", "mark || (differs_q && !region_start)", "mark"),
    fault("operator", RasterMeans, "raster_summary", "(above_level && complete_q)", "above_level"),
    fault("operator", RasterMeans, "raster_summary", "shown_read && !lost_read && over", "shown_read && over"),
    fault("reset", RasterMeans, "raster_summary", "shown_read && !lost_read && over", "shown_read && !lost_read"),
    fault("constant", RasterMeansOne, "raster_summary", ".DEPTH(4)) u_shown_later", ".DEPTH(3)) u_shown_later"),
    fault("index", RasterMeans, "raster_summary", "number = {line[SIDE_BITS-1:0], column[SIDE_BITS-1:0]}", "number = {column[SIDE_BITS-1:0], line[SIDE_BITS-1:0]}"),
    fault("index", RasterMeansDeep, "raster_summary", ".read_address_i(sent_place)", ".read_address_i(given_place)"),

    fault("operator", RasterMeans, "raster_decision", "(!decided_shown || decided_differs)", "decided_differs"),
    fault("operator", RasterMeans, "raster_decision", "!srs || (decided_shown && !trs)", "!srs"),
    fault("operator", RasterMeansDeep, "raster_decision", "!srs || (decided_shown && !trs)", "!srs"),
    fault("operator", RasterMeans, "raster_decision", "!srs || (decided_shown && !trs)", "!srs || decided_shown"),
    fault("reset", RasterMeans, "raster_decision", "will_be_sent_o && !rst_i", "will_be_sent_o"),

    fault("constant", RasterMeans, "raster_walk", "LAST_BLOCK = (SIDE - BLOCK) * (SIDE + 1)", "LAST_BLOCK = (SIDE - BLOCK) * SIDE"),
    fault("constant", RasterMeans, "raster_walk", "NEXT_LINE = BLOCK * SIDE - ", "NEXT_LINE = SIDE - "),
    fault("index", RasterMeans, "raster_walk", "if (begin_i) mean_q", "if (1'b0) mean_q"),

    fault("index", RasterMeans, "raster_readout", "{means_q, fetched_means_q} <= {fetched_means_q, means}", "{means_q, fetched_means_q} <= {means, means}"),

    fault("operator", RasterMeans, "raster_forward", ".enter_i(active_i || (BLOCKS > 0 && summary_i))", ".enter_i(active_i)"),
    fault("index", RasterMeansDeep, "raster_forward", "summary_o ? {LANES{mean_q}} : pixel_q", "pixel_q"),
    fault("operator", RasterMeans, "raster_forward", "done_o = fetch_last || lost_valid_o", "done_o = fetch_last"),
    fault("operator", RasterMeans, "raster_forward", "done_o = fetch_last || lost_valid_o", "done_o = lost_valid_o"),
    fault("constant", RasterMeansOne, "raster_forward", "ROW_BITS = BANKS > 2 ? 2 : 1", "ROW_BITS = 1"),

    fault("constant", RasterMeansDeep, "raster_core", "(LAST_SENT || BLOCKS > 0) && ROWS", "LAST_SENT && ROWS"),
    fault("operator", RasterMeansDeep, "raster_core", "|| will_be_sent ||", "||"),
    fault("index", RasterMeansDeep, "raster_core", ".word_i(RAW ? stored_raw : center)", ".word_i(center)"),
    fault("index", RasterMeansOne, "raster_core", "{judged_differs, judged_shown} = leaving[SETTLED_BITS+1:SETTLED_BITS]", "{judged_differs, judged_shown} = entering[SETTLED_BITS+1:SETTLED_BITS]"),
];
