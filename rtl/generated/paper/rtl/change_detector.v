// SPDX-License-Identifier: MIT OR Apache-2.0
// Hit when a pixel differs from its reference by more than level.
`default_nettype none

module change_detector #(
    parameter WIDTH = 8  // bits of a pixel
) (
    input  wire [WIDTH-1:0] pixel_i,      // of this frame
    input  wire [WIDTH-1:0] reference_i,  // its reference
    input  wire [WIDTH-1:0] level_i,      // a change is more than this
    output wire             hit_o         // |pixel_i - reference_i| > level_i
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    wire [WIDTH:0] difference = {1'b0, pixel_i} - {1'b0, reference_i};

    magnitude_above #(.WIDTH(WIDTH + 1)) u_above (
        .value_i(difference), .level_i(level_i), .above_o(hit_o)
    );

endmodule

`default_nettype wire
