// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the binomial mean of a 3x3 window: the sum of the pixels with the weights 1, 2, 1 in both directions plus 8, divided
// by 16. The result comes two clocks after its step, as that of median3x3.v.
//
// Each column is added up once, when it comes in, together with 2. The weights of the three columns are 4 in all, which makes 8.
`default_nettype none

module binomial3x3 #(
    parameter WIDTH = 8  // bits of a pixel
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             rst_i,      // synchronous reset, active high
    input  wire             advance_i,  // the window moves by one column at this edge
    input  wire             step_i,     // the window is complete with the incoming column
    input  wire             left_i,     // the incoming column is the first of its row
    input  wire             right_i,    // the center is the last of its row
    input  wire [WIDTH-1:0] upper_i,    // upper pixel of the incoming column
    input  wire [WIDTH-1:0] middle_i,   // middle pixel of the incoming column
    input  wire [WIDTH-1:0] lower_i,    // lower pixel of the incoming column
    output reg              valid_o,    // a mean is on mean_o, two clocks after step_i
    output reg  [WIDTH-1:0] mean_o      // the binomial mean
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    localparam COLUMN = WIDTH + 2;  // bits of the sum of a column, which is at most 4 * (2^WIDTH - 1) + 2

    // The incoming column. The 2 is a carry into the second bit.
    wire [WIDTH:0] outer = {1'b0, upper_i} + {1'b0, lower_i};
    wire [COLUMN-1:0] incoming;
    assign incoming[0] = outer[0];
    carry_adder #(.WIDTH(COLUMN - 1)) u_incoming (
        .plain_i({1'b0, middle_i}), .other_i({1'b0, outer[WIDTH:1]}), .carry_i(1'b1), .sum_o(incoming[COLUMN-1:1])
    );

    // The sums of the columns. `right` is the newest, then `center`, then `left`.
    reg [COLUMN-1:0] right_q, center_q, left_q;
    reg row_start_q;  // the column in `right` is the first of its row
    reg clamp_q;      // the center's column is used in place of its right neighbor
    reg step_q;

    always @(posedge clk_i) begin
        if (advance_i) begin
            right_q     <= incoming;
            center_q    <= right_q;
            left_q      <= row_start_q ? right_q : center_q;
            row_start_q <= left_i;
            clamp_q     <= right_i;
        end
    end

    wire [COLUMN:0] sides;
    adder #(.WIDTH(COLUMN + 1)) u_sides (
        .plain_i({1'b0, left_q}), .other_i({1'b0, clamp_q ? center_q : right_q}), .sum_o(sides)
    );
    wire [COLUMN+1:0] total = {1'b0, sides} + {1'b0, center_q, 1'b0};
    wire unused_remainder = |total[3:0];

    always @(posedge clk_i) begin
        mean_o <= total[4+:WIDTH];
        if (rst_i) begin
            step_q  <= 1'b0;
            valid_o <= 1'b0;
        end else begin
            step_q  <= step_i;
            valid_o <= step_q;
        end
    end

endmodule

`default_nettype wire
