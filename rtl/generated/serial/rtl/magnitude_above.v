// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares the magnitude of a signed value with a level, with one carry chain. Combinational.
//
// The bits of a negative value are inverted, which gives |value| - 1. The lowest bit of the comparison adds the missing one.
`default_nettype none

module magnitude_above #(
    parameter WIDTH = 9,  // bits of the signed value
    parameter BORROW = 0  // 0: the result is a comparison, which takes few LUTs; 1: the result is a bit of a difference, which makes a short path
) (
    input  wire [WIDTH-1:0] value_i,  // the signed value
    input  wire [WIDTH-2:0] level_i,  // the unsigned level
    output wire             above_o   // |value_i| > level_i
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 2) begin : g_width WIDTH_must_be_2_or_more u_refused (); end
    endgenerate

    wire negative = value_i[WIDTH-1];
    wire [WIDTH-2:0] inverted = value_i[WIDTH-2:0] ^ {(WIDTH - 1) {negative}};

    // Synthesis may build the comparison of LUTs. It builds the difference as a carry chain with no logic behind it.
    wire [WIDTH:0] missing = {1'b0, level_i, !negative} - {1'b0, inverted, 1'b1};

    assign above_o = BORROW ? missing[WIDTH] : {inverted, 1'b1} > {level_i, !negative};

endmodule

`default_nettype wire
