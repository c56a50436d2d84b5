// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the rounded fixed-point mean floor((2^FRACTION * sum + HALF) / pixels). The division by a constant is a
// multiplication and a shift, exact for every sum that can occur. mean_o holds the mean after the edge of done_i.
`default_nettype none

module region_mean #(
    parameter SUM_BITS = 14,                  // bits of the sum
    parameter FRACTION = 0,                   // fraction bits of the mean
    parameter DIVIDEND_BITS = 14,             // bits of 2^FRACTION * sum + HALF
    parameter MEAN_BITS = 8,                  // bits of the mean, in units of 2^-FRACTION
    parameter FACTOR_BITS = 1,                // bits of FACTOR
    parameter [DIVIDEND_BITS-1:0] HALF = 32,  // half of the pixels of a region, rounded down
    parameter [FACTOR_BITS-1:0] FACTOR = 1,   // (dividend * FACTOR) >> SHIFT is the dividend divided by the pixels of a region
    parameter SHIFT = 6                       // bits of the product that are dropped
) (
    input  wire                 clk_i,   // clock, rising edge
    input  wire                 done_i,  // the sum is that of a whole frame
    input  wire [ SUM_BITS-1:0] sum_i,   // sum of that frame
    output reg  [MEAN_BITS-1:0] mean_o   // mean of the last whole frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (FRACTION < 0 || FRACTION > 12) begin : g_fraction FRACTION_must_be_0_to_12 u_refused (); end
        if (DIVIDEND_BITS < SUM_BITS + FRACTION) begin : g_dividend_bits
            DIVIDEND_BITS_must_be_SUM_BITS_and_FRACTION_or_more u_refused ();
        end
        if (SHIFT < 0 || SHIFT + MEAN_BITS > DIVIDEND_BITS + FACTOR_BITS) begin : g_shift
            SHIFT_and_MEAN_BITS_must_lie_in_the_product u_refused ();
        end
    endgenerate

    localparam PRODUCT_BITS = DIVIDEND_BITS + FACTOR_BITS;

    wire [DIVIDEND_BITS-1:0] scaled = {{(DIVIDEND_BITS - SUM_BITS) {1'b0}}, sum_i} << FRACTION;
    wire [DIVIDEND_BITS-1:0] dividend = scaled + HALF;
    // The bits below SHIFT are the remainder. The bits above the mean are never set.
    /* verilator lint_off UNUSEDSIGNAL */
    wire [PRODUCT_BITS-1:0] product =
        {{FACTOR_BITS{1'b0}}, dividend} * {{DIVIDEND_BITS{1'b0}}, FACTOR};
    /* verilator lint_on UNUSEDSIGNAL */

    always @(posedge clk_i) begin
        if (done_i) mean_o <= product[SHIFT+:MEAN_BITS];
    end

endmodule

`default_nettype wire
