// SPDX-License-Identifier: MIT OR Apache-2.0
// The columns of a word as they came in, kept next to a module of the raster core: the newest word, the centers and the column on
// their left, F_LATE clocks after the ports.
localparam F_COLUMN = 3 * WIDTH;
wire [LANES*F_COLUMN-1:0] f_word;
genvar f_lane;
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_word
        wire [WIDTH-1:0] middle = middle_i[f_lane*WIDTH+:WIDTH];
        wire [WIDTH-1:0] upper = top_i ? middle : upper_i[f_lane*WIDTH+:WIDTH];
        wire [WIDTH-1:0] lower = bottom_i ? middle : lower_i[f_lane*WIDTH+:WIDTH];
        assign f_word[f_lane*F_COLUMN+:F_COLUMN] = {lower, middle, upper};
    end
endgenerate
wire f_step, f_at_left, f_at_right;
wire [LANES*F_COLUMN-1:0] f_incoming;
word_delay #(.WIDTH(3 + LANES * F_COLUMN), .DEPTH(F_LATE)) f_late (
    .clk_i(clk_i), .data_i({step_i, left_i, right_i, f_word}), .data_o({f_step, f_at_left, f_at_right, f_incoming})
);

reg [LANES*F_COLUMN-1:0] f_newest, f_center;
reg [F_COLUMN-1:0] f_before;
reg f_no_left, f_no_right;    // the centers have nothing on their left, or on their right
reg [1:0] f_words = 2'd0;     // number of words that came, up to 3
reg [1:0] f_clocks = 2'd0;    // clocks before the first word that is checked
always @(posedge clk_i) begin
    if (f_clocks != 2'd3) f_clocks <= f_clocks + 2'd1;
    if (f_step && f_clocks == 2'd3) begin
        f_newest   <= f_incoming;
        f_center   <= f_newest;
        f_before   <= f_center[(LANES-1)*F_COLUMN+:F_COLUMN];
        f_no_left  <= f_at_left;
        f_no_right <= f_at_right;
        if (f_words != 2'd3) f_words <= f_words + 2'd1;
    end
end
// The first word of the next row follows the last word of a row. A row has more than one word.
always @* begin
    if (f_words >= 2'd2) assume(!f_step || f_at_left == f_no_right);
    assume(!left_i || !right_i);
end

// The columns left, center and right of a lane.
function [3*F_COLUMN-1:0] f_window(input integer lane);
    f_window = {
        lane == LANES - 1 ? (f_no_right ? f_center[(LANES-1)*F_COLUMN+:F_COLUMN] : f_newest[F_COLUMN-1:0])
                          : f_center[((lane+1)%LANES)*F_COLUMN+:F_COLUMN],
        f_center[lane*F_COLUMN+:F_COLUMN],
        lane == 0 ? (f_no_left ? f_center[F_COLUMN-1:0] : f_before) : f_center[((lane+LANES-1)%LANES)*F_COLUMN+:F_COLUMN]
    };
endfunction
// The whole window is known, and the number of clocks since then, up to 15.
wire f_known = f_words == 2'd3;
reg [3:0] f_age = 4'd0;
always @(posedge clk_i) f_age <= !f_known ? 4'd0 : f_age == 4'd15 ? f_age : f_age + 4'd1;
