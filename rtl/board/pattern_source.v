// SPDX-License-Identifier: MIT OR Apache-2.0
// Sends AXI4-Stream video of a scene that moves (docs/boards.md), one word per clock: a gradient, texture on parts of it, and
// bright squares. The same scene is a few lines of a program. The first word comes three clocks after reset.
`default_nettype none

module pattern_source #(
    parameter WORDS = 480,     // words of a line, at least 2
    parameter LINES = 1080,    // lines of a frame, at least 2
    parameter LANES = 4,       // pixels of a word
    parameter WIDTH = 8,       // bits of a pixel
    parameter WORD_BITS = 9,   // ceil(log2(WORDS))
    parameter LINE_BITS = 11   // ceil(log2(LINES))
) (
    input  wire                   clk_i,    // clock, rising edge
    input  wire                   rst_i,    // synchronous reset, active high
    output wire                   valid_o,  // a word is on pixel_o; always 1 from three clocks after reset on
    output wire [LANES*WIDTH-1:0] pixel_o,  // the word, its left pixel in the lowest bits
    output wire                   sof_o,    // the word is the first of a frame
    output wire                   eol_o,    // the word is the last of a line
    input  wire                   ready_i,  // the sink takes the word
    output wire [           31:0] frame_o   // number of the frame of the word, from 0 on
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (LINES < 2) begin : g_lines LINES_must_be_2_or_more u_refused (); end
        if (LANES < 1) begin : g_lanes LANES_must_be_1_or_more u_refused (); end
        if (WIDTH < 1 || WIDTH > 16) begin : g_width WIDTH_must_be_1_to_16 u_refused (); end
        if (WORD_BITS != $clog2(WORDS)) begin : g_word_bits WORD_BITS_must_be_clog2_of_WORDS u_refused (); end
        if (LINE_BITS != $clog2(LINES)) begin : g_line_bits LINE_BITS_must_be_clog2_of_LINES u_refused (); end
    endgenerate

    localparam WORD_BEFORE_LAST = WORDS - 2;
    localparam LINE_BEFORE_LAST = LINES - 2;
    reg second_q, third_q;  // the second and the third stage hold a word
    wire step = !third_q || ready_i;

    // The first stage: the place of the word, and values at its first pixel. All of them are counted modulo 2^9 or less.
    reg [WORD_BITS-1:0] word_q;
    reg [LINE_BITS-1:0] line_q;
    reg [31:0] frame_q;
    reg last_word_q, last_line_q;
    reg [7:0] x_q, y_q;             // column x; line y
    reg [8:0] ramp_q, line_ramp_q;  // x + 2 y; 2 y
    reg [7:0] mix_q, line_mix_q;    // 5 x + 19 y; 19 y
    reg [6:0] right_q, start_q;     // x - 3 t; -3 t
    reg [6:0] down_q, top_q;        // y - t; -t
    wire [8:0] next_ramp = last_line_q ? 9'd0 : line_ramp_q + 9'd2;
    wire [7:0] next_mix = last_line_q ? 8'd0 : line_mix_q + 8'd19;
    wire [6:0] next_start = last_line_q ? start_q - 7'd3 : start_q;
    localparam MIX_STEP = 5 * LANES;
    always @(posedge clk_i) begin
        if (step) begin
            word_q      <= word_q + 1'b1;
            last_word_q <= word_q == WORD_BEFORE_LAST[WORD_BITS-1:0];
            x_q         <= x_q + LANES[7:0];
            ramp_q      <= ramp_q + LANES[8:0];
            mix_q       <= mix_q + MIX_STEP[7:0];
            right_q     <= right_q + LANES[6:0];
            if (last_word_q) begin
                word_q      <= {WORD_BITS{1'b0}};
                line_q      <= last_line_q ? {LINE_BITS{1'b0}} : line_q + 1'b1;
                last_line_q <= !last_line_q && line_q == LINE_BEFORE_LAST[LINE_BITS-1:0];
                x_q         <= 8'd0;
                y_q         <= last_line_q ? 8'd0 : y_q + 1'b1;
                ramp_q      <= next_ramp;
                line_ramp_q <= next_ramp;
                mix_q       <= next_mix;
                line_mix_q  <= next_mix;
                right_q     <= next_start;
                start_q     <= next_start;
                down_q      <= last_line_q ? top_q - 1'b1 : down_q + 1'b1;
                if (last_line_q) begin
                    top_q   <= top_q - 1'b1;
                    frame_q <= frame_q + 1'b1;
                end
            end
        end
        if (rst_i) begin
            word_q      <= {WORD_BITS{1'b0}};
            line_q      <= {LINE_BITS{1'b0}};
            frame_q     <= 32'd0;
            last_word_q <= 1'b0;
            last_line_q <= 1'b0;
            x_q         <= 8'd0;
            y_q         <= 8'd0;
            ramp_q      <= 9'd0;
            line_ramp_q <= 9'd0;
            mix_q       <= 8'd0;
            line_mix_q  <= 8'd0;
            right_q     <= 7'd0;
            start_q     <= 7'd0;
            down_q      <= 7'd0;
            top_q       <= 7'd0;
        end
    end

    // The second stage: the same values of each pixel. The third stage: the pixels.
    reg second_sof_q, second_eol_q, sof_q, eol_q;
    reg [31:0] second_frame_q, third_frame_q;
    reg [7:0] second_y_q;
    always @(posedge clk_i) begin
        if (step) begin
            second_q       <= 1'b1;
            second_sof_q   <= word_q == {WORD_BITS{1'b0}} && line_q == {LINE_BITS{1'b0}};
            second_eol_q   <= last_word_q;
            second_frame_q <= frame_q;
            second_y_q     <= y_q;
            third_q        <= second_q;
            sof_q          <= second_sof_q;
            eol_q          <= second_eol_q;
            third_frame_q  <= second_frame_q;
        end
        if (rst_i) begin
            second_q <= 1'b0;
            third_q  <= 1'b0;
        end
    end

    genvar lane;
    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            localparam AT = lane;
            localparam MIX_AT = 5 * lane;
            reg [7:0] lane_x_q, lane_mix_q;
            reg [8:0] lane_ramp_q;
            reg square_q;
            wire [6:0] right = right_q + AT[6:0];
            wire [7:0] hash = lane_mix_q ^ lane_mix_q >> 3 ^ (lane_x_q & second_y_q);
            wire textured = (lane_x_q[7:6] ^ second_y_q[7:6]) == 2'd3;
            wire [6:0] gradient = lane_ramp_q[8:2];
            wire [7:0] value = square_q ? {3'b111, hash[4:0]} : textured ? {2'b00, gradient[6:1]} + {2'b00, hash[5:0]} : {1'b0, gradient};
            wire unused_bits = |lane_ramp_q[1:0] || |hash[7:6] || |right[3:0];
            wire [15:0] shown = {value, 8'd0};
            reg [WIDTH-1:0] pixel_q;
            always @(posedge clk_i)
            if (step) begin
                lane_x_q    <= x_q + AT[7:0];
                lane_mix_q  <= mix_q + MIX_AT[7:0];
                lane_ramp_q <= ramp_q + AT[8:0];
                square_q    <= right[6:4] == 3'd0 && down_q[6:4] == 3'd0;
                pixel_q     <= shown[15-:WIDTH];
            end
            assign pixel_o[lane*WIDTH+:WIDTH] = pixel_q;
            if (WIDTH < 16) begin : g_rest
                wire unused_shown = |shown[15-WIDTH:0];
            end
        end
    endgenerate

    assign valid_o = third_q;
    assign sof_o = sof_q;
    assign eol_o = eol_q;
    assign frame_o = third_frame_q;

endmodule

`default_nettype wire
