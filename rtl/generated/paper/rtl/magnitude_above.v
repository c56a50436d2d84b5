// SPDX-License-Identifier: MIT OR Apache-2.0
// |value| > level, with one carry chain.
//
// The bits of a negative value are inverted, which gives |value| - 1; the lowest bit of the comparison
// makes up for the missing one.
`default_nettype none

module magnitude_above #(
    parameter WIDTH = 9,  // bits of the value, which is signed; the level has one less
    parameter BORROW = 0  // 1: a bit of the difference is the result, for a short path; 0: a comparison, for few LUTs
) (
    input  wire [WIDTH-1:0] value_i,  // signed
    input  wire [WIDTH-2:0] level_i,  // unsigned
    output wire             above_o   // |value_i| > level_i
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WIDTH < 2) begin : g_width WIDTH_must_be_2_or_more u_refused (); end
    endgenerate

    wire negative = value_i[WIDTH-1];
    wire [WIDTH-2:0] inverted = value_i[WIDTH-2:0] ^ {(WIDTH - 1) {negative}};

    // Synthesis makes LUTs of the comparison where it can, and of the difference a carry chain with nothing behind it.
    wire [WIDTH:0] missing = {1'b0, level_i, !negative} - {1'b0, inverted, 1'b1};

    assign above_o = BORROW ? missing[WIDTH] : {inverted, 1'b1} > {level_i, !negative};

endmodule

`default_nettype wire
