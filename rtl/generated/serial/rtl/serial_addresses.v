// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the address of each step of the serial array: a pass walks over the centers of a square inside a larger square.
// address_o belongs to the step of the same clock.
//
// `center_q` is the address of the center, and neighbors are at a constant distance from it. Where a window must not leave
// the square, the distance is cut.
`default_nettype none

module serial_addresses #(
    parameter SIDE = 8,             // pixels of a side of a region
    parameter RAW_SIDE = 8,         // side of the square that is loaded
    parameter DENOISED_SIDE = 8,    // side of the square that is denoised
    parameter FILTER = 1,           // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter CLAMPS = 1,           // 1: a window repeats the border of its square
    parameter COPIES = 0,           // not 0: the reference is copied after the last score; 0: it is overwritten pixel by pixel
    parameter FLOW = 0,             // 1: the design has the feature `flow`
    parameter RAW_PAYLOAD = 0,      // 1: raw pixels leave; 0: the pixels that are scored
    parameter BLOCKS = 0,           // blocks of a region's side whose means are sent: 1, 2 or 4; 0: none
    parameter BLOCK_BITS = 1,       // bits of the number of a block, at least 1
    parameter DENOISED_BASE = 64,   // address in a slot where the denoised square starts
    parameter REFERENCE_BASE = 64,  // address in a slot where the reference starts
    parameter WORD_BITS = 7,        // bits of an address inside a slot
    parameter POSITION_BITS = 6     // bits of the number of a pixel in the larger square of centers
) (
    input  wire                     clk_i,          // clock, rising edge
    input  wire [             50:0] step_i,         // the step: one bit for each action, in the order of serial_states
    input  wire [              3:0] tap_i,          // number of the neighbor that is read
    input  wire [              1:0] part_i,         // half of a gradient or of a pair of steps, part of a filter or of a ring's step, or side of the border
    input  wire                     walks_i,        // the next step works on the next center
    input  wire                     slot_ends_i,    // the next step works on the next slot
    input  wire                     last_lane_i,    // the score of the last lane passes
    input  wire                     first_score_i,  // this score is the first of the slot
    input  wire                     last_score_i,   // this score is the last of the slot
    input  wire [   BLOCK_BITS-1:0] block_i,        // number of the block
    input  wire                     last_block_i,   // the block is the last of the region
    // The displacement of `flow`.
    input  wire [              1:0] columns_i,      // |dx|
    input  wire [              1:0] rows_i,         // |dy|
    input  wire                     right_i,        // dx is not negative
    input  wire                     down_i,         // dy is not negative
    output wire [    WORD_BITS-1:0] address_o,      // address of the word inside the slot
    output wire                     write_o,        // the accumulator is written to this address
    output wire [POSITION_BITS-1:0] position_o,     // number of the center in its square, or of the last pixel of a block
    output wire                     last_column_o,  // the center is the last of its row
    output wire                     last_center_o,  // the center is the last of its square
    output wire                     counts_o        // the center is a pixel of the region
);

    localparam INNER = (DENOISED_SIDE - SIDE) / 2;  // distance from the denoised square's border to the first center that is scored
    localparam SCORED_SIDE = FILTER != 0 ? DENOISED_SIDE : RAW_SIDE;
    localparam LEAVING_SIDE = RAW_PAYLOAD != 0 ? RAW_SIDE : SCORED_SIDE;
    localparam SIDE_BITS = $clog2(DENOISED_SIDE);
    localparam BORDERS = FILTER != 0 && INNER != 0;
    localparam BLENDS = FILTER == 3;  // 1: a pixel is compared with its reference before it is written
    localparam SUMMARIES = BLOCKS != 0;
    localparam BLOCK = SIDE / (BLOCKS == 0 ? 1 : BLOCKS);

    // Numbers that fit into their widths.
    /* verilator lint_off WIDTH */
    // The first centers of the passes. While means leave, MEAN_AT is an address of the raw square that is not used otherwise.
    localparam [WORD_BITS-1:0] MEAN_AT = 0;
    localparam [WORD_BITS-1:0] WINDOW_START = (RAW_SIDE - DENOISED_SIDE) / 2 * (RAW_SIDE + 1);
    localparam [WORD_BITS-1:0] SCORED_START = FILTER != 0 ? DENOISED_BASE + INNER * (DENOISED_SIDE + 1)
        : (RAW_SIDE - SIDE) / 2 * (RAW_SIDE + 1);
    localparam [WORD_BITS-1:0] RAW_START = (RAW_SIDE - SIDE) / 2 * (RAW_SIDE + 1);
    localparam [WORD_BITS-1:0] LEAVING_START = RAW_PAYLOAD != 0 ? RAW_START : SCORED_START;
    localparam [WORD_BITS-1:0] FIRST_START = FILTER != 0 ? WINDOW_START : SCORED_START;
    localparam [WORD_BITS-1:0] LEFT_START = DENOISED_BASE + 1;
    localparam [WORD_BITS-1:0] RIGHT_START = DENOISED_BASE + DENOISED_SIDE - 2;
    localparam [WORD_BITS-1:0] TOP_START = DENOISED_BASE + DENOISED_SIDE;
    localparam [WORD_BITS-1:0] BOTTOM_START = DENOISED_BASE + (DENOISED_SIDE - 2) * DENOISED_SIDE;
    // The distances from the last center of a row to the first center of the next row.
    localparam [WORD_BITS-1:0] WINDOW_SKIP = RAW_SIDE - DENOISED_SIDE + 1;
    localparam [WORD_BITS-1:0] SCORED_SKIP = SCORED_SIDE - SIDE + 1;
    localparam [WORD_BITS-1:0] LEAVING_SKIP = LEAVING_SIDE - SIDE + 1;
    localparam [WORD_BITS-1:0] BLOCK_SKIP = LEAVING_SIDE - BLOCK + 1;
    localparam [WORD_BITS-1:0] NEXT_BLOCK = 1 - (BLOCK - 1) * LEAVING_SIDE;
    localparam [WORD_BITS-1:0] ONE = 1;
    localparam [WORD_BITS-1:0] WINDOW_STRIDE = RAW_SIDE;
    localparam [WORD_BITS-1:0] SCORED_STRIDE = SCORED_SIDE;
    localparam [POSITION_BITS-1:0] POSITION_STRIDE = SIDE;
    // Squares that are walked word by word.
    localparam [WORD_BITS-1:0] DENOISED_AT = DENOISED_BASE;
    localparam [WORD_BITS-1:0] REFERENCE_AT = REFERENCE_BASE;
    localparam [SIDE_BITS-1:0] LAST_WIDE = DENOISED_SIDE - 1;
    localparam [SIDE_BITS-1:0] LAST_SIDE = SIDE - 1;
    localparam [SIDE_BITS-1:0] LAST_COUNTED = SIDE;
    localparam [SIDE_BITS-1:0] LAST_OF_BLOCK = BLOCK - 1;
    /* verilator lint_on WIDTH */

    // The bits of the step.
    wire loading, draining, rotating, unloading, shifting, denoising, bordering, temporal, copying;
    wire starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing;
    wire gradient, gradient_test, ring, ring_test, ring_last;
    wire [14:0] unused_sums;
    wire spanning;
    wire [3:0] unused_bounds;
    wire matching, unused_least, noting;
    wire averaging, returning, storing, showing;
    assign {
        loading, draining, rotating, unloading, shifting,
        denoising, bordering, temporal, copying,
        starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing,
        gradient, gradient_test, ring, ring_test, ring_last,
        unused_sums, spanning, unused_bounds,
        matching, unused_least, noting,
        averaging, returning, storing, showing
    } = step_i;
    wire unused_step = starting || adjusting || choosing || reading || gradient_test || ring_test || ring_last || showing;

    // The center.
    reg [SIDE_BITS-1:0] column_q;
    reg [SIDE_BITS-1:0] row_q;
    reg [WORD_BITS-1:0] center_q;
    reg [POSITION_BITS-1:0] position_q;

    // Places of the blocks.
    wire sums_start = SUMMARIES && first_score_i && !averaging;
    wire row_of_blocks_ends;

    generate
        if (BLOCKS > 1) begin : g_blocks
            localparam ROW_BITS = BLOCK_BITS / 2;
            wire [ROW_BITS-1:0] block_column = block_i[0+:ROW_BITS];
            wire [ROW_BITS-1:0] block_row = block_i[ROW_BITS+:ROW_BITS];
            assign row_of_blocks_ends = &block_column;
            // The number of the last pixel of a block.
            /* verilator lint_off WIDTH */
            wire [POSITION_BITS-1:0] last_of_block = block_row * (BLOCK * SIDE) + block_column * BLOCK
                + ((BLOCK - 1) * SIDE + BLOCK - 1);
            /* verilator lint_on WIDTH */
            assign position_o = returning ? last_of_block : position_q;
        end else if (SUMMARIES) begin : g_block
            localparam [POSITION_BITS-1:0] LAST = SIDE * SIDE - 1;
            wire unused_block = |block_i;
            assign row_of_blocks_ends = 1'b1;
            assign position_o = returning ? LAST : position_q;
        end else begin : g_no_blocks
            wire unused_block = |block_i || returning;
            assign row_of_blocks_ends = 1'b1;
            assign position_o = position_q;
        end
    endgenerate

    // The pairs of `flow`: the columns and rows of a region that have no partner at the displacement, the first center, the position
    // of its partner, and the distances from the last pair of a row to the first pair of the next row.
    wire [SIDE_BITS-1:0] missing_columns;
    wire [SIDE_BITS-1:0] missing_rows;
    wire [WORD_BITS-1:0] pair_start;
    wire [WORD_BITS-1:0] pair_skip;
    wire [POSITION_BITS-1:0] partner_start;
    wire [POSITION_BITS-1:0] partner_skip;

    generate
        if (FLOW != 0) begin : g_pairs
            /* verilator lint_off WIDTH */
            assign missing_columns = columns_i;
            assign missing_rows = rows_i;
            assign pair_start = SCORED_START + (down_i ? rows_i * SCORED_STRIDE : 0) + (right_i ? columns_i : 0);
            assign pair_skip = SCORED_SKIP + columns_i;
            assign partner_start = (down_i ? 0 : rows_i * POSITION_STRIDE) + (right_i ? 0 : columns_i);
            assign partner_skip = 1 + columns_i;
            /* verilator lint_on WIDTH */
        end else begin : g_no_pairs
            wire unused_displacement = |columns_i || |rows_i || right_i || down_i || |POSITION_STRIDE;
            assign missing_columns = {SIDE_BITS{1'b0}};
            assign missing_rows = {SIDE_BITS{1'b0}};
            assign pair_start = SCORED_START;
            assign pair_skip = SCORED_SKIP;
            assign partner_start = {POSITION_BITS{1'b0}};
            assign partner_skip = {{(POSITION_BITS - 1) {1'b0}}, 1'b1};
        end
    endgenerate

    // The walk over the centers.
    wire wide_pass = BORDERS && (denoising || bordering);
    wire [SIDE_BITS-1:0] last_place = wide_pass ? LAST_WIDE : averaging ? LAST_OF_BLOCK : LAST_SIDE;
    wire last_column = column_q == last_place - (missing_columns & {SIDE_BITS{matching}});
    wire last_row = row_q == last_place - (missing_rows & {SIDE_BITS{matching}});
    wire last_center = last_column && last_row;
    wire [WORD_BITS-1:0] skip = denoising ? WINDOW_SKIP
        : (unloading || shifting) ? LEAVING_SKIP : SCORED_SKIP;

    wire blended = BLENDS && denoising && writing;  // `binomial3x3` writes a pixel at the end of its steps

    // The distances from the last center of a row of a block, and from the last center of a block.
    wire [WORD_BITS-1:0] block_skip = !last_row ? BLOCK_SKIP : row_of_blocks_ends ? LEAVING_SKIP : NEXT_BLOCK;
    wire [WORD_BITS-1:0] onward = !last_column ? ONE : averaging ? block_skip : matching ? pair_skip : skip;

    assign last_column_o = last_column;
    assign last_center_o = last_center;

    always @(posedge clk_i) begin
        if (loading || draining || slot_ends_i) begin
            column_q   <= {SIDE_BITS{1'b0}};
            row_q      <= {SIDE_BITS{1'b0}};
            position_q <= {POSITION_BITS{1'b0}};
            center_q   <= FIRST_START;
        end else if (bordering && writing) begin
            column_q <= last_column ? {SIDE_BITS{1'b0}} : column_q + 1'b1;
            if (!last_column) center_q <= center_q + (part_i[1] ? ONE : SCORED_STRIDE);
            else case (part_i)
                2'd0: center_q <= RIGHT_START;
                2'd1: center_q <= TOP_START;
                2'd2: center_q <= BOTTOM_START;
                default: center_q <= SCORED_START;
            endcase
        end else if (walks_i) begin
            column_q   <= last_column ? {SIDE_BITS{1'b0}} : column_q + 1'b1;
            if (last_column) row_q <= last_row ? {SIDE_BITS{1'b0}} : row_q + 1'b1;
            position_q <= last_center ? {POSITION_BITS{1'b0}}
                : matching && last_column ? position_q + partner_skip : position_q + 1'b1;
            center_q   <= center_q + onward;
            if (last_center && !(averaging && !last_block_i))
                center_q <= BORDERS && (testing || blended) ? LEFT_START : writing && !blended ? LEAVING_START
                    : SUMMARIES && unloading ? MEAN_AT : SCORED_START;
        end else if (rotating && last_lane_i && (sums_start || (last_score_i && COPIES == 0 && !returning))) begin
            center_q <= LEAVING_START;
        end else if (noting) begin
            center_q   <= pair_start;
            position_q <= partner_start;
        end
    end

    // The neighbors, clockwise from the upper left one. The last number is the center itself.
    reg [3:0] neighbor;
    always @* begin
        if (searching || probing || (spanning && part_i[0])) neighbor = tap_i;
        else if (gradient) neighbor = {1'b0, tap_i[2:0] + (part_i[0] ? 3'd1 : 3'd7)};
        else if (ring) neighbor = {part_i[0], tap_i[2:0]};
        else if (blending) neighbor = !tap_i[3] ? tap_i : tap_i[2] ? 4'd8 : {1'b0, tap_i[1:0], 1'b1};  // weights 1, 2 and 4
        else neighbor = 4'd8;
    end

    wire moved = !neighbor[3];
    wire up = moved && neighbor[2:0] <= 3'd2;
    wire down = moved && neighbor[2:0] >= 3'd4 && neighbor[2:0] <= 3'd6;
    wire left = moved && (neighbor[2:0] == 3'd0 || neighbor[2:0] >= 3'd6);
    wire right = moved && neighbor[2:0] >= 3'd2 && neighbor[2:0] <= 3'd4;

    reg [3:0] way;  // up, down, left, right
    always @* begin
        way[3] = up && (CLAMPS == 0 || row_q != 0);
        way[2] = down && (CLAMPS == 0 || !last_row);
        way[1] = left && (CLAMPS == 0 || column_q != 0);
        way[0] = right && (CLAMPS == 0 || !last_column);
        if (bordering && writing) begin
            way[3] = part_i == 2'd2;
            way[2] = part_i == 2'd3;
            way[1] = part_i == 2'd0;
            way[0] = part_i == 2'd1;
        end
    end

    function [WORD_BITS-1:0] distance(input [3:0] toward, input [WORD_BITS-1:0] stride);
        case (toward)
            4'b0001: distance = ONE;
            4'b0010: distance = {WORD_BITS{1'b1}};
            4'b0100: distance = stride;
            4'b0101: distance = stride + ONE;
            4'b0110: distance = stride - ONE;
            4'b1000: distance = ~stride + ONE;
            4'b1001: distance = ~stride + ONE + ONE;
            4'b1010: distance = ~stride;
            default: distance = {WORD_BITS{1'b0}};
        endcase
    endfunction

    wire [WORD_BITS-1:0] near = WINDOW_STRIDE == SCORED_STRIDE || !(searching || probing || blending)
        ? distance(way, SCORED_STRIDE) : distance(way, WINDOW_STRIDE);

    // The addresses in squares that are walked word by word.
    wire [WORD_BITS-1:0] position;
    wire [WORD_BITS-1:0] reference;

    generate
        if (WORD_BITS > POSITION_BITS) begin : g_extended
            assign position = {{(WORD_BITS - POSITION_BITS) {1'b0}}, position_q};
        end else begin : g_position
            assign position = position_q;
        end
        if (BORDERS) begin : g_inside
            assign counts_o = column_q != 0 && column_q <= LAST_COUNTED
                && row_q != 0 && row_q <= LAST_COUNTED;
            if (COPIES != 0) begin : g_reference
                reg [WORD_BITS-1:0] reference_q;
                always @(posedge clk_i) begin
                    if (!denoising) reference_q <= REFERENCE_AT;
                    else if (testing && counts_o) reference_q <= reference_q + 1'b1;
                end
                assign reference = denoising ? reference_q : REFERENCE_AT + position;
            end else begin : g_no_reference
                assign reference = REFERENCE_AT + position;
            end
        end else begin : g_all_inside
            assign counts_o = 1'b1;
            assign reference = REFERENCE_AT + position;
        end
    endgenerate

    wire compares = BLENDS && blending && part_i == 2'd0;  // the reference is read
    wire to_denoised = FILTER != 0 && ((writing && temporal) || (compares && COPIES == 0));
    wire to_reference = relating || (matching && part_i[0]) || (compares && COPIES != 0) || (writing && (copying || (FILTER == 0 && temporal)));

    assign address_o = to_denoised ? DENOISED_AT + position : to_reference ? reference : center_q + near;
    assign write_o = (writing && temporal) || storing;

endmodule

`default_nettype wire
