// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares a pixel with its reference: a hit is a difference of more than level_i. Combinational.
`default_nettype none

module change_detector #(
    parameter WIDTH = 8  // bits of a pixel
) (
    input  wire [WIDTH-1:0] pixel_i,      // pixel of this frame
    input  wire [WIDTH-1:0] reference_i,  // reference of that pixel
    input  wire [WIDTH-1:0] level_i,      // a difference above this level is a change
    output wire             hit_o         // |pixel_i - reference_i| > level_i
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    wire [WIDTH:0] difference = {1'b0, pixel_i} - {1'b0, reference_i};

    magnitude_above #(.WIDTH(WIDTH + 1)) u_above (
        .value_i(difference), .level_i(level_i), .above_o(hit_o)
    );

endmodule

`default_nettype wire
