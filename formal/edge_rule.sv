// SPDX-License-Identifier: MIT OR Apache-2.0
// Why edge_detector may compare halves: for every window (Gx + Gy) / 2 and (Gy - Gx) / 2 are the sums that it
// forms, and for all gradients |Gx| + |Gy| > level if and only if one of them is above floor(level / 2).
module properties #(parameter WIDTH = 8) (
    input wire [WIDTH-1:0] a, b, c, d, f, g, h, i,  // the window, row by row, without its center
    input wire [WIDTH-1:0] m,                       // its center
    input wire signed [WIDTH+3:0] some_gx, some_gy,
    input wire [WIDTH+2:0] level
);
    function signed [WIDTH+5:0] wide(input [WIDTH-1:0] pixel);
        wide = $signed({6'd0, pixel});
    endfunction
    wire signed [WIDTH+5:0] gx = wide(c) + 2 * wide(f) + wide(i) - wide(a) - 2 * wide(d) - wide(g);
    wire signed [WIDTH+5:0] gy = wide(g) + 2 * wide(h) + wide(i) - wide(a) - 2 * wide(b) - wide(c);
    wire signed [WIDTH+5:0] sum = (wide(h) - wide(b)) - (wide(a) + wide(d)) + (wide(f) + wide(i));
    wire signed [WIDTH+5:0] diff = (wide(h) - wide(b)) + (wide(d) + wide(g)) - (wide(c) + wide(f));
    always @* begin
        assert(gx + gy == 2 * sum);
        assert(gy - gx == 2 * diff);
    end

    wire signed [WIDTH+5:0] x = some_gx, y = some_gy;
    wire signed [WIDTH+5:0] half_sum = (x + y) >>> 1, half_diff = (y - x) >>> 1;
    wire signed [WIDTH+5:0] half_level = $signed({3'd0, level >> 1});
    wire rule = half_sum > half_level || -half_sum > half_level || half_diff > half_level || -half_diff > half_level;
    wire signed [WIDTH+5:0] magnitude = (x < 0 ? -x : x) + (y < 0 ? -y : y);
    always @* if (x[0] == y[0]) assert(rule == (magnitude > $signed({3'd0, level})));
endmodule
