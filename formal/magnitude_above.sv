// SPDX-License-Identifier: MIT OR Apache-2.0
// |value| > level for a signed value, for every width in a design.
module magnitude_properties #(parameter WIDTH = 9) (input wire [WIDTH-1:0] value, input wire [WIDTH-2:0] level);
    wire above, borrow;
    magnitude_above #(.WIDTH(WIDTH)) dut (.value_i(value), .level_i(level), .above_o(above));
    magnitude_above #(.WIDTH(WIDTH), .BORROW(1)) short_path (.value_i(value), .level_i(level), .above_o(borrow));
    wire signed [WIDTH:0] wide = $signed(value);
    wire signed [WIDTH:0] magnitude = wide < 0 ? -wide : wide;
    always @* begin
        assert(above == (magnitude > $signed({2'b00, level})));
        assert(borrow == above);
    end
endmodule

module properties (input wire [18:0] value, level);
    genvar width;
    generate
        for (width = 2; width <= 19; width = width + 1) begin : g_width
            magnitude_properties #(.WIDTH(width)) u (.value(value[width-1:0]), .level(level[width-2:0]));
        end
    endgenerate
endmodule
