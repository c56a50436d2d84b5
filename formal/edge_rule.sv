// SPDX-License-Identifier: MIT OR Apache-2.0
// The reason why edge_detector may compare halves. PART 0: for every window its sums s and d satisfy Gx = s - d and
// Gy = s + d. PART 1: for all s and d, |s - d| + |s + d| > level if and only if |s| or |d| > floor(level / 2).
module properties #(parameter WIDTH = 8, parameter PART = 0) (
    // The window, row by row, without its center. The sums hold for any words, not only for pixels.
    input wire signed [WIDTH+5:0] a, b, c, d_, f, g, h, i,
    input wire signed [WIDTH+2:0] s, d,
    input wire [WIDTH+2:0] level
);
    generate
        if (PART == 0) begin : g_sums
            wire signed [WIDTH+5:0] gx = c + f + f + i - a - d_ - d_ - g;
            wire signed [WIDTH+5:0] gy = g + h + h + i - a - b - b - c;
            wire signed [WIDTH+5:0] sum = (h - b) - (a + d_) + (f + i);
            wire signed [WIDTH+5:0] diff = (h - b) + (d_ + g) - (c + f);
            always @* begin
                assert(gx == sum - diff);
                assert(gy == sum + diff);
            end
        end else begin : g_rule
            wire signed [WIDTH+5:0] x = s - d, y = s + d;
            wire signed [WIDTH+5:0] half_level = $signed({4'd0, level[WIDTH+2:1]});
            wire signed [WIDTH+5:0] magnitude = (x < 0 ? -x : x) + (y < 0 ? -y : y);
            wire rule = s > half_level || -s > half_level || d > half_level || -d > half_level;
            always @* assert(rule == (magnitude > $signed({3'd0, level})));
        end
    endgenerate
endmodule
