// SPDX-License-Identifier: MIT OR Apache-2.0
// The second pass counts the pixels with 2^f * x > mu + 2^f * level, and those with 2^f * x < mu - 2^f * level. The score is the
// smaller count, and the surplus is the difference of both.
wire [WIDTH-1:0] f_pixel;
wire [MEAN_BITS-1:0] f_mean;
wire signed [63:0] f_scaled = {{(64 - WIDTH) {1'b0}}, f_pixel} << FRACTION;
wire signed [63:0] f_distance = {{(64 - WIDTH) {1'b0}}, level_i} << FRACTION;
wire signed [63:0] f_center = {{(64 - MEAN_BITS) {1'b0}}, f_mean};
generate
    if (DEEP) begin : g_f_deep
        reg [WIDTH-1:0] f_pixel_q;
        reg [MEAN_BITS-1:0] f_mean_q;
        reg f_earlier = 1'b0;  // there was an earlier clock
        always @(posedge clk_i) begin
            f_pixel_q <= pixel_i;
            f_mean_q  <= mean_i;
            f_earlier <= 1'b1;
        end
        assign {f_pixel, f_mean} = {f_pixel_q, f_mean_q};
        always @* if (f_earlier) assert($signed(difference) == f_scaled - f_center);
    end else begin : g_f_plain
        assign {f_pixel, f_mean} = {pixel_i, mean_i};
    end
endgenerate
reg [15:0] f_above, f_below;
reg [15:0] f_seen;  // number of steps since the frame began
wire [15:0] f_surplus = f_above - f_below;
reg f_reset_seen = 1'b0;
always @(posedge clk_i) begin
    if (rst_i) f_reset_seen <= 1'b1;
    f_above <= rst_i || !enable_i ? 0 : (restart_i ? 0 : f_above) + (step_i && f_scaled > f_center + f_distance);
    f_below <= rst_i || !enable_i ? 0 : (restart_i ? 0 : f_below) + (step_i && f_scaled < f_center - f_distance);
    f_seen  <= rst_i ? 0 : (restart_i ? 0 : f_seen) + step_i;
end
always @* if (f_reset_seen) begin
    assume(f_seen < PIXELS || restart_i);  // a frame has PIXELS steps, and ends in the clock after the last one
    assert(f_seen <= PIXELS);
    assert(f_above <= f_seen && f_below <= f_seen && f_above + f_below <= f_seen);
    assert(score_o == (f_above < f_below ? f_above : f_below));
    assert(surplus_q == f_surplus[SURPLUS_BITS-1:0]);
end
