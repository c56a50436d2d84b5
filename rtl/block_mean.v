// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the rounded mean of each block of a region. valid_o and mean_o come with the last pixel of the block, with
// DEEP one clock later.
//
// The sum of the current block is in a register. The sums of the other blocks of the same row of blocks wait in a delay
// line, which moves when the next block continues. The sum starts with half of a block's pixels, so that the mean is
// floor(sum / pixels). That division is a multiplication and a shift, exact for every sum that can occur.
`default_nettype none

module block_mean #(
    parameter WIDTH = 8,                     // bits of a pixel
    parameter SIDE = 8,                      // pixels of a region's side
    parameter BLOCKS = 2,                    // blocks of a region's side
    parameter ADDRESS_BITS = 6,              // ceil(log2(SIDE * SIDE))
    parameter AHEAD = 0,                     // 1: address_i is the number of the next pixel; 0: that of this one
    parameter SUM_BITS = 12,                 // bits of the sum of a block plus half of its pixels
    parameter FACTOR_BITS = 1,               // bits of FACTOR
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // (sum * FACTOR) >> SHIFT is the sum divided by the pixels of a block
    parameter SHIFT = 4,                     // bits of the product that are dropped
    parameter DEEP = 0                       // 1: the mean comes one clock after the last pixel, behind a register
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    step_i,     // a pixel comes
    input  wire [ADDRESS_BITS-1:0] address_i,  // number of the pixel in the region, or with AHEAD of the next pixel
    input  wire [       WIDTH-1:0] pixel_i,    // the pixel of this step
    output wire                    valid_o,    // a block is complete: with this pixel, with DEEP with the pixel of the last clock
    output wire [       WIDTH-1:0] mean_o      // mean of the complete block
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (SUM_BITS < WIDTH) begin : g_sum_bits SUM_BITS_must_be_WIDTH_or_more u_refused (); end
        if (SHIFT < 0 || SHIFT + WIDTH > SUM_BITS + FACTOR_BITS) begin : g_shift
            SHIFT_and_WIDTH_must_lie_in_the_product u_refused ();
        end
        if (DEEP != 0 && DEEP != 1) begin : g_deep DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam BLOCK = SIDE / BLOCKS;
    localparam HALF = BLOCK * BLOCK / 2;
    localparam PRODUCT_BITS = SUM_BITS + FACTOR_BITS;

    wire start, upper, last;
    block_place #(.SIDE(SIDE), .BLOCKS(BLOCKS), .ADDRESS_BITS(ADDRESS_BITS), .AHEAD(AHEAD)) u_place (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .address_i(address_i),
        .start_o(start), .upper_o(upper), .last_o(last)
    );

    reg [SUM_BITS-1:0] sum_q;
    wire [SUM_BITS-1:0] sum, waiting;
    wire [SUM_BITS-1:0] so_far = !start ? sum_q : upper ? HALF[SUM_BITS-1:0] : waiting;

    adder #(.WIDTH(SUM_BITS)) u_sum (
        .plain_i({{(SUM_BITS - WIDTH) {1'b0}}, pixel_i}), .other_i(so_far), .sum_o(sum)
    );

    generate
        if (BLOCKS == 1) begin : g_one
            assign waiting = sum_q;
        end else begin : g_line
            line_delay #(.WIDTH(SUM_BITS), .DEPTH(BLOCKS - 1)) u_line (
                .clk_i(clk_i), .advance_i(step_i && start), .data_i(sum_q), .data_o(waiting)
            );
        end
    endgenerate

    always @(posedge clk_i) if (step_i) sum_q <= sum;

    wire [SUM_BITS-1:0] dividend;
    // The bits below SHIFT are the remainder. The bits above the mean are never set.
    /* verilator lint_off UNUSEDSIGNAL */
    wire [PRODUCT_BITS-1:0] product = {{FACTOR_BITS{1'b0}}, dividend} * {{SUM_BITS{1'b0}}, FACTOR};
    /* verilator lint_on UNUSEDSIGNAL */
    assign mean_o = product[SHIFT+:WIDTH];

    generate
        if (DEEP) begin : g_deep_mean
            reg valid_q;
            always @(posedge clk_i) valid_q <= step_i && last;
            assign valid_o  = valid_q;
            assign dividend = sum_q;
        end else begin : g_mean
            assign valid_o  = step_i && last;
            assign dividend = sum;
        end
    endgenerate

endmodule

`default_nettype wire
