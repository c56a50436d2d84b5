// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares every pixel of a word with its reference: a hit is a difference of more than level_i. hit_o comes two clocks
// after the word.
`default_nettype none

module raster_change #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter LANES = 1,  // pixels of a word
    parameter DEEP = 0    // 1: arranged for a faster clock, at the same latency
) (
    input  wire                   clk_i,        // clock, rising edge
    input  wire [LANES*WIDTH-1:0] word_i,       // word of this frame
    input  wire [LANES*WIDTH-1:0] reference_i,  // references of that word
    input  wire [      WIDTH-1:0] level_i,      // a difference above this level is a change
    output reg  [      LANES-1:0] hit_o         // one bit per pixel: |pixel - reference| > level
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LANES < 1) begin : g_lanes LANES_must_be_1_or_more u_refused (); end
    endgenerate

    genvar lane;
    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            reg [WIDTH:0] difference_q;
            wire above;
            magnitude_above #(.WIDTH(WIDTH + 1), .BORROW(DEEP)) u_above (
                .value_i(difference_q), .level_i(level_i), .above_o(above)
            );
            always @(posedge clk_i) begin
                difference_q <= {1'b0, word_i[lane*WIDTH+:WIDTH]} - {1'b0, reference_i[lane*WIDTH+:WIDTH]};
                hit_o[lane]  <= above;
            end
        end
    endgenerate

endmodule

`default_nettype wire
