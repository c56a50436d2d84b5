// SPDX-License-Identifier: MIT OR Apache-2.0
// The score is the smaller one of two counts, of the pixels above and below the mean by more than the level, for words with gaps of
// any length, regions of any length and any mean for each word.
module properties #(
    parameter LANES = 1, parameter FRACTION = 0, parameter MEAN_CLOCKS = 1, parameter MEAN_BITS = 2 + FRACTION
) (
    input wire clk_i, step, first, input wire [2*LANES-1:0] pixels, input wire [MEAN_BITS-1:0] mean
);
    (* anyconst *) wire [1:0] level;
    wire [1:0] score;
    raster_segment #(
        .WIDTH(2), .LANES(LANES), .FRACTION(FRACTION), .MEAN_BITS(MEAN_BITS), .COUNT_BITS(3), .SCORE_BITS(2),
        .MEAN_CLOCKS(MEAN_CLOCKS)
    ) dut (
        .clk_i(clk_i), .mean_i(mean), .level_i(level), .word_i(pixels), .step_i(step), .first_i(first), .score_o(score)
    );

    // A word comes one clock before its step, and its mean MEAN_CLOCKS before the word. The first step is one of a first word.
    reg [2*LANES-1:0] word = 0;
    reg [(MEAN_CLOCKS+1)*MEAN_BITS-1:0] means = 0;
    reg [2:0] clocks = 3'd0;
    reg begun = 1'b0;
    always @(posedge clk_i) begin
        word <= pixels;
        means <= {means, mean};
        if (clocks != 3'd7) clocks <= clocks + 3'd1;
        if (step) begun <= 1'b1;
    end
    always @* begin
        if (clocks <= MEAN_CLOCKS) assume(!step);
        if (!begun) assume(!step || first);
    end

    // The counts, with pixels, mean and level in units of the smallest fraction.
    wire [7:0] unit = 8'd1 << FRACTION;
    wire [7:0] middle = {1'b0, means[MEAN_CLOCKS*MEAN_BITS+:MEAN_BITS]};
    reg [2:0] above = 3'd0, below = 3'd0, above_now, below_now;
    reg [1:0] expected;
    reg [1:0] due = 2'd0;
    integer lane;
    always @* begin
        above_now = first ? 3'd0 : above;
        below_now = first ? 3'd0 : below;
        for (lane = 0; lane < LANES; lane = lane + 1) begin
            if (word[2*lane+:2] * unit > middle + level * unit) above_now = above_now + 3'd1;
            if (word[2*lane+:2] * unit + level * unit < middle) below_now = below_now + 3'd1;
        end
    end
    always @(posedge clk_i) begin
        if (step) {above, below} <= {above_now, below_now};
        expected <= above < below ? above : below;
        due <= {due, begun};
    end
    always @* if (due[0]) assert(score == expected);
endmodule
