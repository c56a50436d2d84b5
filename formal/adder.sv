// SPDX-License-Identifier: MIT OR Apache-2.0
// The sum modulo 2^WIDTH, for every width in a design.
module adder_properties #(parameter WIDTH = 8) (input wire [WIDTH-1:0] a, b);
    wire [WIDTH-1:0] sum;
    adder #(.WIDTH(WIDTH)) dut (.plain_i(a), .other_i(b), .sum_o(sum));
    wire [WIDTH-1:0] expected = a + b;
    always @* assert(sum == expected);
endmodule

module properties (input wire [18:0] a, b);
    genvar width;
    generate
        for (width = 1; width <= 19; width = width + 1) begin : g_width
            adder_properties #(.WIDTH(width)) u (.a(a[width-1:0]), .b(b[width-1:0]));
        end
    endgenerate
endmodule
