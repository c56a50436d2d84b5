// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// For {= title =}:
// the core `rcm_axi` behind a pattern at full rate, with a sum of all packets and a serial line (docs/boards.md of Foveate).
`default_nettype none

module board (
{%- if pair %}
    input  wire       clk_p_i,  // the clock of the board, {= mhz =} MHz
    input  wire       clk_n_i,  // the inverted half of that differential clock
{%- else %}
    input  wire       clk_i,    // the clock of the board, {= mhz =} MHz
{%- endif %}
    input  wire       rx_i,     // serial line from the host
    output wire       tx_o,     // serial line to the host
    output wire [{= leds - 1 =}:0] led_o     // lights
);

    wire clk, unused_raw, locked;
    board_clock u_clock ({% if pair %}.clk_p_i(clk_p_i), .clk_n_i(clk_n_i){% else %}.clk_i(clk_i){% endif %}, .raw_o(unused_raw), .clk_o(clk), .locked_o(locked));

    // The reset ends once the clock has run for a while.
    reg [7:0] awake_q = 8'd0;
    wire rst = !awake_q[7];
    always @(posedge clk)
        if (!locked) awake_q <= 8'd0;
        else if (rst) awake_q <= awake_q + 1'b1;

    // The pattern.
    wire pixel_valid, pixel_ready, sof, eol;
    wire [{= video_bits - 1 =}:0] pixel;
    wire [31:0] unused_frame;
    pattern_source #(
        .WORDS({= words =}), .LINES({= height =}), .LANES({= lanes =}), .WIDTH(8), .WORD_BITS({= word_bits =}), .LINE_BITS({= line_bits =})
    ) u_pattern (
        .clk_i(clk), .rst_i(rst), .valid_o(pixel_valid), .pixel_o(pixel), .sof_o(sof), .eol_o(eol), .ready_i(pixel_ready),
        .frame_o(unused_frame)
    );

{% include "core.v" %}
    // All packets are taken at once and added up. The serial line carries as many of them as it has time for, each whole.
    assign packet_ready = 1'b1;
    wire [31:0] sum, frames, status;
    wire frame_done, right, wrong;
    packet_signature u_signature (
        .clk_i(clk), .rst_i(rst), .data_i(packet), .valid_i(packet_valid), .last_i(packet_last), .ready_i(packet_ready),
        .sum_o(sum), .frames_o(frames), .done_o(frame_done)
    );
    expected_sums u_expected (
        .clk_i(clk), .rst_i(rst), .done_i(frame_done), .sum_i(sum), .frames_i(frames), .right_o(right), .wrong_o(wrong)
    );
    assign status = {frames[15:0], 14'd0, wrong, right};
    wire shown_valid, shown_last, shown_ready;
    wire [63:0] shown;
    packet_sample #(.WORDS({= packet_words =}), .WORD_BITS({= packet_bits =})) u_sample (
        .clk_i(clk), .rst_i(rst), .data_i(packet), .valid_i(packet_valid), .last_i(packet_last), .data_o(shown),
        .valid_o(shown_valid), .last_o(shown_last), .ready_i(shown_ready)
    );
    packet_bytes u_bytes (
        .clk_i(clk), .rst_i(rst), .data_i(shown), .valid_i(shown_valid), .last_i(shown_last), .ready_o(shown_ready),
        .answer_valid_i(answer_valid), .answer_byte_i(answer), .answer_last_i(answer_last), .answer_ready_o(answer_ready),
        .valid_o(sent_valid), .byte_o(sent), .ready_i(sent_ready)
    );
{% include "serial_line.v" %}
    // Lights: one blinks with frames, one is on if a sum was wrong, one if all sums were right.
    wire [{= leds - 1 =}:0] lit = {{% if leds > 3 %}{= leds - 3 =}'d0, {% endif %}right, wrong, frames[4]};
    assign led_o = {% if lit_low %}~{% endif %}lit;

endmodule

`default_nettype wire
