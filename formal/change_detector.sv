// SPDX-License-Identifier: MIT OR Apache-2.0
// |pixel - reference| > level, for every depth of pixels.
module change_properties #(parameter WIDTH = 8) (input wire [WIDTH-1:0] pixel, reference, level);
    wire hit;
    change_detector #(.WIDTH(WIDTH)) dut (.pixel_i(pixel), .reference_i(reference), .level_i(level), .hit_o(hit));
    wire [WIDTH-1:0] difference = pixel > reference ? pixel - reference : reference - pixel;
    always @* assert(hit == (difference > level));
endmodule

module properties (input wire [15:0] pixel, reference, level);
    genvar width;
    generate
        for (width = 1; width <= 16; width = width + 1) begin : g_width
            change_properties #(.WIDTH(width)) u (
                .pixel(pixel[width-1:0]), .reference(reference[width-1:0]), .level(level[width-1:0])
            );
        end
    endgenerate
endmodule
