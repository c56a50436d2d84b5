// SPDX-License-Identifier: MIT OR Apache-2.0
// Finds the place of a pixel in its block. A region has BLOCKS x BLOCKS blocks, and its pixels come row by row. The
// outputs belong to the pixel of step_i, in the same clock.
//
// If SIDE is a power of two, the place is in the bits of the pixel's number. Otherwise three counters keep it.
`default_nettype none

module block_place #(
    parameter SIDE = 8,          // pixels of a region's side
    parameter BLOCKS = 2,        // blocks of a region's side
    parameter ADDRESS_BITS = 6,  // ceil(log2(SIDE * SIDE))
    parameter AHEAD = 0          // 1: address_i is the number of the next pixel; 0: that of this one
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    step_i,     // a pixel comes
    input  wire [ADDRESS_BITS-1:0] address_i,  // number of the pixel in the region, or with AHEAD of the next pixel
    output wire                    start_o,    // the pixel is the first of its row in the block
    output wire                    upper_o,    // the row is the first of its block
    output wire                    last_o      // the pixel is the last of the block
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SIDE < 2) begin : g_side SIDE_must_be_2_or_more u_refused (); end
        if (BLOCKS != 1 && BLOCKS != 2 && BLOCKS != 4) begin : g_blocks BLOCKS_must_be_1_2_or_4 u_refused (); end
        if (SIDE % BLOCKS != 0) begin : g_divides BLOCKS_must_divide_SIDE u_refused (); end
        if (ADDRESS_BITS != $clog2(SIDE * SIDE)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_SIDE_times_SIDE u_refused ();
        end
        if (AHEAD != 0 && AHEAD != 1) begin : g_ahead AHEAD_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam BLOCK = SIDE / BLOCKS;
    localparam BITS = $clog2(BLOCK);

    generate
        if (BLOCK == 1) begin : g_pixel
            wire unused_inputs = |{clk_i, rst_i, step_i, address_i};
            assign start_o = 1'b1;
            assign upper_o = 1'b1;
            assign last_o  = 1'b1;
        end else if (SIDE == 1 << $clog2(SIDE)) begin : g_power
            localparam ROW = ADDRESS_BITS / 2;
            wire unused_inputs = |{clk_i, rst_i, step_i, address_i};
            wire [BITS-1:0] column = address_i[0+:BITS];
            wire [BITS-1:0] row = address_i[ROW+:BITS];
            assign upper_o = ~|row;
            if (AHEAD) begin : g_ahead
                // With AHEAD the number after the last pixel of a row belongs to the next row.
                wire is_next_row = ~|address_i[0+:ROW];
                wire is_last_row = is_next_row ? ~|row : &row;
                assign start_o = column == {{(BITS - 1) {1'b0}}, 1'b1};
                assign last_o  = ~|column && is_last_row;
            end else begin : g_same
                assign start_o = ~|column;
                assign last_o  = &column && &row;
            end
        end else begin : g_count
            localparam END = BLOCK - 1;
            localparam FINAL = BLOCKS - 1;
            wire unused_address = |address_i;
            reg [BITS-1:0] column_q, row_q;
            reg [1:0] block_q;
            wire row_ends = column_q == END[BITS-1:0];
            wire line_ends = row_ends && block_q == FINAL[1:0];
            always @(posedge clk_i) begin
                if (rst_i) begin
                    column_q <= {BITS{1'b0}};
                    row_q    <= {BITS{1'b0}};
                    block_q  <= 2'd0;
                end else if (step_i) begin
                    column_q <= row_ends ? {BITS{1'b0}} : column_q + 1'b1;
                    if (row_ends) block_q <= line_ends ? 2'd0 : block_q + 2'd1;
                    if (line_ends) row_q <= last_o ? {BITS{1'b0}} : row_q + 1'b1;
                end
            end
            assign start_o = ~|column_q;
            assign upper_o = ~|row_q;
            assign last_o  = row_ends && row_q == END[BITS-1:0];
        end
    endgenerate

endmodule

`default_nettype wire
