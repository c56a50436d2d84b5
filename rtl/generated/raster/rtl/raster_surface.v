// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds up the four values of raster_displacement.v over every region. The smallest sum is the score of `surface`, which comes two
// clocks after the sums of raster_sums.v.
`default_nettype none

module raster_surface #(
    parameter VALUE_BITS = 8,  // bits of a value
    parameter SUM_BITS = 14,   // bits of the sum of a region
    parameter COLUMNS = 240,   // regions in a row of regions
    parameter DEEP = 0         // 0: the score comes four clocks after its last values; 1: five clocks
) (
    input  wire                    clk_i,          // clock, rising edge
    input  wire                    rst_i,          // synchronous reset, active high
    input  wire                    step_i,         // the values of a word come in
    input  wire [4*VALUE_BITS-1:0] values_i,       // values of that word
    input  wire                    segment_end_i,  // the word is the last of a row of its region
    input  wire                    row_end_i,      // the word is the last of its row of the frame
    input  wire                    region_top_i,   // the word is in the first row of its region
    output reg  [    SUM_BITS-1:0] score_o         // score of the rows of a region so far
);

    wire [SUM_BITS-1:0] right, lower, lower_right, lower_left;
    raster_sums #(
        .VALUES(4), .VALUE_BITS(VALUE_BITS), .SUM_BITS(SUM_BITS), .COLUMNS(COLUMNS), .COLUMN_BITS($clog2(COLUMNS)), .DEEP(DEEP)
    ) u_sums (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .values_i(values_i), .segment_end_i(segment_end_i),
        .row_end_i(row_end_i), .region_top_i(region_top_i), .sums_o({lower_left, lower_right, lower, right})
    );

    reg [SUM_BITS-1:0] straight_q, diagonal_q;  // the smaller one of two sums
    always @(posedge clk_i) begin
        straight_q <= right < lower ? right : lower;
        diagonal_q <= lower_right < lower_left ? lower_right : lower_left;
        score_o    <= straight_q < diagonal_q ? straight_q : diagonal_q;
    end

endmodule

`default_nettype wire
