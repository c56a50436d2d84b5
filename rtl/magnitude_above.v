// SPDX-License-Identifier: MIT OR Apache-2.0
// |value| > level, without an absolute value: a value >= 0 gets -level - 1, a negative one gets
// +level, and the sign stays exactly when the magnitude is above the level.
`default_nettype none

module magnitude_above #(
    parameter WIDTH = 9  // bits of the value, which is signed; the level has one less
) (
    input  wire signed [WIDTH-1:0] value_i,
    input  wire        [WIDTH-2:0] level_i,
    output wire                    above_o
);

    wire negative = value_i[WIDTH-1];
    wire signed [WIDTH-1:0] toward_zero = {!negative, level_i ^ {(WIDTH - 1) {!negative}}};
    // Only the sign of the sum matters.
    /* verilator lint_off UNUSEDSIGNAL */
    wire signed [WIDTH-1:0] rest = value_i + toward_zero;
    /* verilator lint_on UNUSEDSIGNAL */

    assign above_o = rest[WIDTH-1] == negative;

endmodule

`default_nettype wire
