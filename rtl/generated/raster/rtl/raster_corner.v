// SPDX-License-Identifier: MIT OR Apache-2.0
// Detects corners by FAST 5/8 for every pixel of a word at once: a hit if at least 5 contiguous of the 8 neighbors are all
// brighter than the center by more than level_i, or all darker. hit_o comes four clocks after its step, with DEEP five.
//
// At a border the missing neighbors are copies of the center and of the pixels above and below it. So the results of the
// comparisons are copied, not the pixels.
`default_nettype none

module raster_corner #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter LANES = 1,  // pixels of a word
    parameter DEEP = 0    // 0: hit_o comes four clocks after its step; 1: five clocks
) (
    input  wire                   clk_i,     // clock, rising edge
    input  wire                   step_i,    // columns come in; the centers are the columns of the step before
    input  wire                   left_i,    // the first center has nothing on its left
    input  wire                   right_i,   // the last center has nothing on its right
    input  wire                   top_i,     // the incoming columns have nothing at the top: upper_i may hold any word
    input  wire                   bottom_i,  // the incoming columns have nothing at the bottom: lower_i may hold any word
    input  wire [LANES*WIDTH-1:0] upper_i,   // upper pixels of the incoming columns
    input  wire [LANES*WIDTH-1:0] middle_i,  // middle pixels of the incoming columns
    input  wire [LANES*WIDTH-1:0] lower_i,   // lower pixels of the incoming columns
    input  wire [      WIDTH-1:0] level_i,   // a neighbor differs if the difference is above this level
    output wire [      LANES-1:0] hit_o      // hits of the centers, one per pixel of the word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LANES < 1) begin : g_lanes LANES_must_be_1_or_more u_refused (); end
    endgenerate

    localparam COLUMN = 3 * WIDTH;
    localparam BOUND = WIDTH + 1;

    // The columns {bottom, middle, top}, and the bounds that the neighbors of a middle pixel are compared with.
    reg [LANES*COLUMN-1:0] newest_q;
    reg [LANES*COLUMN-1:0] center_q;
    reg [      COLUMN-1:0] left_q;
    reg [LANES*BOUND-1:0] newest_high_q, newest_low_q;  // middle + level; middle - level, signed
    reg [LANES*BOUND-1:0] high_q, low_q;
    reg no_left_q, no_right_q, no_left_2q, no_right_2q;

    wire [(LANES+2)*COLUMN-1:0] columns = {newest_q[COLUMN-1:0], center_q, left_q};

    always @(posedge clk_i) begin
        no_left_2q  <= no_left_q;
        no_right_2q <= no_right_q;
        if (step_i) begin
            center_q   <= newest_q;
            left_q     <= center_q[(LANES-1)*COLUMN+:COLUMN];
            high_q     <= newest_high_q;
            low_q      <= newest_low_q;
            no_left_q  <= left_i;
            no_right_q <= right_i;
        end
    end

    genvar lane, i;
    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            wire [WIDTH-1:0] middle = middle_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] top = top_i ? middle : upper_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] bottom = bottom_i ? middle : lower_i[lane*WIDTH+:WIDTH];
            always @(posedge clk_i) begin
                if (step_i) begin
                    newest_q[lane*COLUMN+:COLUMN] <= {bottom, middle, top};
                    newest_high_q[lane*BOUND+:BOUND] <= {1'b0, middle} + {1'b0, level_i};
                    newest_low_q[lane*BOUND+:BOUND]  <= {1'b0, middle} - {1'b0, level_i};
                end
            end

            // The ring of neighbors, clockwise from the upper left one, which is in the lowest bits.
            wire [COLUMN-1:0] left = columns[lane*COLUMN+:COLUMN];
            wire [COLUMN-1:0] center = columns[(lane+1)*COLUMN+:COLUMN];
            wire [COLUMN-1:0] right = columns[(lane+2)*COLUMN+:COLUMN];
            wire unused_middle = |center[WIDTH+:WIDTH];  // the bounds are used in place of this pixel
            wire [8*WIDTH-1:0] ring = {
                left[WIDTH+:WIDTH],
                left[2*WIDTH+:WIDTH],
                center[2*WIDTH+:WIDTH],
                right[2*WIDTH+:WIDTH],
                right[WIDTH+:WIDTH],
                right[0+:WIDTH],
                center[0+:WIDTH],
                left[0+:WIDTH]
            };
            wire [BOUND-1:0] high = high_q[lane*BOUND+:BOUND];
            wire [BOUND-1:0] low = low_q[lane*BOUND+:BOUND];
            wire no_left = lane == 0 && no_left_2q;
            wire no_right = lane == LANES - 1 && no_right_2q;
            reg  [7:0] above_q, below_q;
            wire [7:0] brighter, darker;
            wire [7:0] bright_run, dark_run;

            for (i = 0; i < 8; i = i + 1) begin : g_ring
                wire [WIDTH-1:0] neighbor = ring[i*WIDTH+:WIDTH];
                wire above = !high[WIDTH] && neighbor > high[WIDTH-1:0];
                wire below = !low[WIDTH] && neighbor < low[WIDTH-1:0];
                always @(posedge clk_i) begin
                    above_q[i] <= above;
                    below_q[i] <= below;
                end
                assign bright_run[i] = brighter[i] && brighter[(i+1)%8] && brighter[(i+2)%8]
                                       && brighter[(i+3)%8] && brighter[(i+4)%8];
                assign dark_run[i] = darker[i] && darker[(i+1)%8] && darker[(i+2)%8]
                                     && darker[(i+3)%8] && darker[(i+4)%8];
            end

            // Bits 0, 7 and 6 are the left column from top to bottom, 1 and 5 the center column, 2, 3 and 4 the right column.
            function [7:0] at_border(input [7:0] flags, input on_left, input on_right);
                at_border = {
                    on_left ? 1'b0 : flags[7], on_left ? flags[5] : flags[6], flags[5],
                    on_right ? flags[5] : flags[4], on_right ? 1'b0 : flags[3],
                    on_right ? flags[1] : flags[2], flags[1], on_left ? flags[1] : flags[0]
                };
            endfunction
            assign brighter = at_border(above_q, no_left, no_right);
            assign darker = at_border(below_q, no_left, no_right);

            reg bright_q, dark_q, hit_q;
            always @(posedge clk_i) begin
                bright_q <= |bright_run;
                dark_q   <= |dark_run;
                hit_q    <= bright_q || dark_q;
            end
            if (DEEP) begin : g_deep
                reg hit_2q;
                always @(posedge clk_i) hit_2q <= hit_q;
                assign hit_o[lane] = hit_2q;
            end else begin : g_plain
                assign hit_o[lane] = hit_q;
            end
        end
    endgenerate

endmodule

`default_nettype wire
