// SPDX-License-Identifier: MIT OR Apache-2.0
// Follows a place in a row of equal parts that is passed again and again: the number of the part, and whether the place is
// the first or the last of its part. Outputs belong to the place of step_i.
//
// If the number of parts is a power of two, their counter needs no comparison with its end, because it wraps by itself.
`default_nettype none

module raster_parts #(
    parameter PARTS = 2,  // parts of the row: 1, 2 or 4
    parameter SIZE = 4    // places of a part
) (
    input  wire       clk_i,    // clock, rising edge
    input  wire       rst_i,    // synchronous reset, active high
    input  wire       step_i,   // moves on to the next place
    output wire       first_o,  // the place is the first of its part
    output wire       last_o,   // the place is the last of its part
    output wire [1:0] part_o    // number of the part
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (PARTS != 1 && PARTS != 2 && PARTS != 4) begin : g_parts PARTS_must_be_1_2_or_4 u_refused (); end
        if (SIZE < 1) begin : g_size SIZE_must_be_1_or_more u_refused (); end
    endgenerate

    localparam BITS = $clog2(SIZE);
    localparam PART_BITS = $clog2(PARTS);
    localparam LAST = SIZE - 1;

    wire last;
    generate
        if (SIZE == 1) begin : g_place
            wire unused_inputs = |{clk_i, rst_i, step_i};
            assign first_o = 1'b1;
            assign last = 1'b1;
        end else begin : g_places
            reg [BITS-1:0] place_q;
            always @(posedge clk_i) begin
                if (rst_i || (step_i && last && SIZE != 1 << BITS)) place_q <= {BITS{1'b0}};
                else if (step_i) place_q <= place_q + 1'b1;
            end
            assign first_o = ~|place_q;
            assign last = place_q == LAST[BITS-1:0];
        end
        if (PARTS == 1) begin : g_part
            assign part_o = 2'd0;
        end else begin : g_some
            reg [PART_BITS-1:0] part_q;
            always @(posedge clk_i) begin
                if (rst_i) part_q <= {PART_BITS{1'b0}};
                else if (step_i && last) part_q <= part_q + 1'b1;
            end
            assign part_o = {{(2 - PART_BITS) {1'b0}}, part_q};
        end
    endgenerate
    assign last_o = last;

endmodule

`default_nettype wire
