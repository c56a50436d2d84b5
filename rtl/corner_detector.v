// SPDX-License-Identifier: MIT OR Apache-2.0
// Detects corners by FAST 5/8: a hit if at least 5 contiguous of the 8 neighbors are all brighter than the center by more
// than level_i, or all darker. hit_o comes in the clock of the step that completes the window. DEEP puts registers before
// and behind the search for a run, so that it comes two clocks later.
`default_nettype none

module corner_detector #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter DEEP = 0    // 0: hit_o comes in the clock of its step; 1: two clocks later
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             advance_i,  // the window moves by one column at this edge
    input  wire             left_i,     // the incoming column is the first of its row
    input  wire             right_i,    // the center is the last of its row
    input  wire [WIDTH-1:0] upper_i,    // upper pixel of the incoming column
    input  wire [WIDTH-1:0] middle_i,   // middle pixel of the incoming column
    input  wire [WIDTH-1:0] lower_i,    // lower pixel of the incoming column
    input  wire [WIDTH-1:0] level_i,    // a neighbor differs if the difference is above this level
    output wire             hit_o       // hit of the center, which has the incoming column on its right
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (DEEP != 0 && DEEP != 1) begin : g_deep_range DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam COLUMN = 3 * WIDTH;

    wire [COLUMN-1:0] incoming = {lower_i, middle_i, upper_i};
    reg  [COLUMN-1:0] center_q;
    reg  [COLUMN-1:0] left_q;

    always @(posedge clk_i) begin
        if (advance_i) begin
            center_q <= incoming;
            left_q   <= left_i ? incoming : center_q;
        end
    end

    wire [COLUMN-1:0] right = right_i ? center_q : incoming;
    wire [ WIDTH-1:0] center = center_q[WIDTH+:WIDTH];

    // The ring of neighbors, clockwise from the upper left one, which is in the lowest bits.
    wire [8*WIDTH-1:0] ring = {
        left_q[WIDTH+:WIDTH],
        left_q[2*WIDTH+:WIDTH],
        center_q[2*WIDTH+:WIDTH],
        right[2*WIDTH+:WIDTH],
        right[WIDTH+:WIDTH],
        right[0+:WIDTH],
        center_q[0+:WIDTH],
        left_q[0+:WIDTH]
    };

    // The bounds: a neighbor is brighter if it is above `high`, and darker if it is below `low`. A bound outside the range
    // of pixels has its highest bit set, and then no neighbor exceeds it.
    wire [WIDTH:0] high = {1'b0, center} + {1'b0, level_i};
    wire [WIDTH:0] low = {1'b0, center} - {1'b0, level_i};
    wire [7:0] brighter;
    wire [7:0] darker;
    wire [7:0] bright;  // `brighter`, as the search for a run sees it; `dark` is `darker` likewise
    wire [7:0] dark;
    wire [7:0] bright_run;
    wire [7:0] dark_run;

    genvar i;
    generate
        for (i = 0; i < 8; i = i + 1) begin : g_ring
            wire [WIDTH-1:0] neighbor = ring[i*WIDTH+:WIDTH];
            assign brighter[i]   = !high[WIDTH] && neighbor > high[WIDTH-1:0];
            assign darker[i]     = !low[WIDTH] && neighbor < low[WIDTH-1:0];
            assign bright_run[i] = bright[i] && bright[(i+1)%8] && bright[(i+2)%8]
                                   && bright[(i+3)%8] && bright[(i+4)%8];
            assign dark_run[i]   = dark[i] && dark[(i+1)%8] && dark[(i+2)%8]
                                   && dark[(i+3)%8] && dark[(i+4)%8];
        end

        if (DEEP) begin : g_deep
            reg [7:0] bright_q;
            reg [7:0] dark_q;
            reg hit_q;
            always @(posedge clk_i) begin
                bright_q <= brighter;
                dark_q   <= darker;
                hit_q    <= |bright_run || |dark_run;
            end
            assign bright = bright_q;
            assign dark   = dark_q;
            assign hit_o  = hit_q;
        end else begin : g_plain
            assign bright = brighter;
            assign dark   = darker;
            assign hit_o  = |bright_run || |dark_run;
        end
    endgenerate

endmodule

`default_nettype wire
