// SPDX-License-Identifier: MIT OR Apache-2.0
// The sum with carry modulo 2^WIDTH, for every width up to 64.
module carry_properties #(parameter WIDTH = 8) (input wire [WIDTH-1:0] a, b, input wire carry);
    wire [WIDTH-1:0] sum;
    carry_adder #(.WIDTH(WIDTH)) dut (.plain_i(a), .other_i(b), .carry_i(carry), .sum_o(sum));
    wire [WIDTH-1:0] expected = a + b + carry;
    always @* assert(sum == expected);
endmodule

module properties (input wire [63:0] a, b, input wire carry);
    genvar width;
    generate
        for (width = 1; width <= 64; width = width + 1) begin : g_width
            carry_properties #(.WIDTH(width)) u (.a(a[width-1:0]), .b(b[width-1:0]), .carry(carry));
        end
    endgenerate
endmodule
