// SPDX-License-Identifier: MIT OR Apache-2.0
// Hit when a pixel differs from its reference by more than level, for every pixel of a word at once; two
// clocks after they come in.
`default_nettype none

module raster_change #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter LANES = 1,  // pixels of a word
    parameter DEEP = 0    // 1: for a faster clock
) (
    input  wire                   clk_i,        // clock, rising edge
    input  wire [LANES*WIDTH-1:0] word_i,       // of this frame
    input  wire [LANES*WIDTH-1:0] reference_i,  // its reference
    input  wire [      WIDTH-1:0] level_i,      // a change is more than this
    output reg  [      LANES-1:0] hit_o         // |pixel - reference| > level
);

    // Limits: out of them elaboration stops at a module that does not exist.
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
