// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the median, the fifth of the nine sorted pixels of a 3x3 window. With SWITCHING a center that is neither the largest
// nor the smallest pixel of its window is the result instead. The result comes two clocks after its step.
//
// Each column is sorted once, when it comes in. The median of nine is the median of three values: the largest of the
// three low pixels, the median of the three middle pixels, and the smallest of the three high pixels.
`default_nettype none

module median3x3 #(
    parameter WIDTH = 8,     // bits of a pixel
    parameter SWITCHING = 0  // 1: a center that is no extreme of its window stays as it is
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             rst_i,      // synchronous reset, active high
    input  wire             advance_i,  // the window moves by one column at this edge
    input  wire             step_i,     // the window is complete with the incoming column
    input  wire             left_i,     // the incoming column is the first of its row
    input  wire             right_i,    // the center is the last of its row
    input  wire [WIDTH-1:0] upper_i,    // upper pixel of the incoming column
    input  wire [WIDTH-1:0] middle_i,   // middle pixel of the incoming column
    input  wire [WIDTH-1:0] lower_i,    // lower pixel of the incoming column
    output reg              valid_o,    // a median is on median_o, two clocks after step_i
    output reg  [WIDTH-1:0] median_o    // the median (SWITCHING: or the center)
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (SWITCHING != 0 && SWITCHING != 1) begin : g_switching_range SWITCHING_must_be_0_or_1 u_refused (); end
    endgenerate

    function [WIDTH-1:0] lesser(input [WIDTH-1:0] a, input [WIDTH-1:0] b);
        lesser = a < b ? a : b;
    endfunction

    function [WIDTH-1:0] greater(input [WIDTH-1:0] a, input [WIDTH-1:0] b);
        greater = a < b ? b : a;
    endfunction

    function [WIDTH-1:0] middle_of(
        input [WIDTH-1:0] a, input [WIDTH-1:0] b, input [WIDTH-1:0] c
    );
        middle_of = greater(lesser(a, b), lesser(greater(a, b), c));
    endfunction

    // The sorted columns. `right` is the newest, then `center`, then `left`.
    reg [WIDTH-1:0] right_low_q, right_mid_q, right_high_q;
    reg [WIDTH-1:0] center_low_q, center_mid_q, center_high_q;
    reg [WIDTH-1:0] left_low_q, left_mid_q, left_high_q;
    reg row_start_q;  // the column in `right` is the first of its row
    reg clamp_q;      // the center's column is used in place of its right neighbor
    reg step_q;

    always @(posedge clk_i) begin
        if (advance_i) begin
            right_low_q   <= lesser(lesser(upper_i, middle_i), lower_i);
            right_mid_q   <= middle_of(upper_i, middle_i, lower_i);
            right_high_q  <= greater(greater(upper_i, middle_i), lower_i);
            center_low_q  <= right_low_q;
            center_mid_q  <= right_mid_q;
            center_high_q <= right_high_q;
            left_low_q    <= row_start_q ? right_low_q : center_low_q;
            left_mid_q    <= row_start_q ? right_mid_q : center_mid_q;
            left_high_q   <= row_start_q ? right_high_q : center_high_q;
            row_start_q   <= left_i;
            clamp_q       <= right_i;
        end
    end

    wire [WIDTH-1:0] right_low = clamp_q ? center_low_q : right_low_q;
    wire [WIDTH-1:0] right_mid = clamp_q ? center_mid_q : right_mid_q;
    wire [WIDTH-1:0] right_high = clamp_q ? center_high_q : right_high_q;

    wire [WIDTH-1:0] highest_low = greater(greater(left_low_q, center_low_q), right_low);
    wire [WIDTH-1:0] middle_mid = middle_of(left_mid_q, center_mid_q, right_mid);
    wire [WIDTH-1:0] lowest_high = lesser(lesser(left_high_q, center_high_q), right_high);

    wire [WIDTH-1:0] median = middle_of(highest_low, middle_mid, lowest_high);
    wire [WIDTH-1:0] result;

    generate
        if (SWITCHING) begin : g_switching
            // The middle pixel of a column, and two bits that say if it is the largest and if it is the smallest of the three. Another
            // pixel may have the same value.
            reg right_largest_q, right_smallest_q, center_largest_q, center_smallest_q;
            reg [WIDTH-1:0] right_pixel_q, center_pixel_q;
            always @(posedge clk_i) begin
                if (advance_i) begin
                    right_largest_q   <= middle_i >= upper_i && middle_i >= lower_i;
                    right_smallest_q  <= middle_i <= upper_i && middle_i <= lower_i;
                    right_pixel_q     <= middle_i;
                    center_largest_q  <= right_largest_q;
                    center_smallest_q <= right_smallest_q;
                    center_pixel_q    <= right_pixel_q;
                end
            end

            // An extreme of its column is one of its window if no other column goes beyond it.
            wire largest = center_largest_q && left_high_q <= center_high_q && right_high <= center_high_q;
            wire smallest = center_smallest_q && left_low_q >= center_low_q && right_low >= center_low_q;
            assign result = largest || smallest ? median : center_pixel_q;
        end else begin : g_median
            assign result = median;
        end
    endgenerate

    always @(posedge clk_i) begin
        median_o <= result;
        if (rst_i) begin
            step_q  <= 1'b0;
            valid_o <= 1'b0;
        end else begin
            step_q  <= step_i;
            valid_o <= step_q;
        end
    end

endmodule

`default_nettype wire
