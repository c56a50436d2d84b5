// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares counters with numbers that are wide enough, for regions of several sizes: position_counter, hit_counter,
// frame_progress, score_hold, forward_gate.
module counter_properties #(parameter SIDE = 2) (
    input wire clk_i, rst_i, step, hit, forward, input wire [7:0] pixel
);
    `include "reset.vh"
    localparam PIXELS = SIDE * SIDE;
    localparam ADDRESS_BITS = $clog2(PIXELS);
    localparam COUNT_BITS = $clog2(PIXELS + 1);
    wire last, done;
    wire [15:0] place, seen;
    frames #(.PIXELS(PIXELS)) u_frames (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );

    // Addresses are equal to positions, so no word outside the region is written.
    wire [ADDRESS_BITS-1:0] address;
    wire address_last;
    position_counter #(.PIXELS(PIXELS), .ADDRESS_BITS(ADDRESS_BITS)) u_position (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .address_o(address), .last_o(address_last)
    );
    always @* if (started) begin
        assert(address == place);
        assert(address_last == last);
    end

    // Hits are counted exactly, at most one for each pixel.
    wire [COUNT_BITS-1:0] count;
    hit_counter #(.WIDTH(COUNT_BITS)) u_hits (
        .clk_i(clk_i), .rst_i(rst_i), .restart_i(done), .hit_i(step && hit), .count_o(count)
    );
    reg [15:0] hits;
    always @(posedge clk_i) begin
        if (rst_i) hits <= 16'd0;
        else hits <= (done ? 16'd0 : hits) + (step && hit);
    end
    always @* if (started) begin
        assert(hits <= seen);
        assert(count == hits);
        assert(count <= PIXELS);
    end

    // The number of frames since reset: none, one, or more.
    wire progress_done, stored, second;
    frame_progress u_progress (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_i(last),
        .done_o(progress_done), .stored_o(stored), .second_o(second)
    );
    reg [1:0] finished;
    always @(posedge clk_i) begin
        if (rst_i) finished <= 2'd0;
        else if (step && last && !finished[1]) finished <= finished + 2'd1;
    end
    always @* if (started) begin
        assert(finished <= 2'd2);
        assert(progress_done == done);
        assert(stored == (finished != 2'd0));
        assert(second == (finished == 2'd2));
    end

    wire [COUNT_BITS-1:0] held;
    score_hold #(.WIDTH(COUNT_BITS)) u_hold (
        .clk_i(clk_i), .rst_i(rst_i), .load_i(done), .score_i(count), .score_o(held)
    );
    reg [15:0] of_last_frame;
    always @(posedge clk_i) begin
        if (rst_i) of_last_frame <= 16'd0;
        else if (done) of_last_frame <= hits;
    end
    always @* if (started) assert(held == of_last_frame);

    // A pixel leaves at every step of an active frame, and at no other time.
    wire leaves;
    wire [7:0] leaving;
    forward_gate #(.WIDTH(8)) u_gate (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .forward_i(forward), .pixel_i(pixel),
        .valid_o(leaves), .pixel_o(leaving)
    );
    reg was_step;
    reg [7:0] was_pixel;
    always @(posedge clk_i) begin
        was_step <= !rst_i && step && forward;
        was_pixel <= pixel;
    end
    always @* if (started) begin
        assert(leaves == was_step);
        assert(leaving == (was_step ? was_pixel : 8'd0));
    end
endmodule

module properties (input wire clk_i, rst_i, step, hit, forward, input wire [7:0] pixel);
    counter_properties #(.SIDE(2)) u2 (.clk_i, .rst_i, .step, .hit, .forward, .pixel);
    counter_properties #(.SIDE(3)) u3 (.clk_i, .rst_i, .step, .hit, .forward, .pixel);
    counter_properties #(.SIDE(5)) u5 (.clk_i, .rst_i, .step, .hit, .forward, .pixel);
    counter_properties #(.SIDE(8)) u8 (.clk_i, .rst_i, .step, .hit, .forward, .pixel);
    counter_properties #(.SIDE(20)) u20 (.clk_i, .rst_i, .step, .hit, .forward, .pixel);
    counter_properties #(.SIDE(64)) u64 (.clk_i, .rst_i, .step, .hit, .forward, .pixel);
endmodule
