// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// For {= title =}:
// the core `rcm_axi` between a sensor and a serial line (docs/boards.md of Foveate).
`default_nettype none

module board (
    input  wire       clk_i,               // the clock of the board, {= mhz =} MHz
    output wire       sensor_xclk_o,       // the sensor's clock
    input  wire       sensor_pclk_i,       // the clock of the sensor's pixels
    input  wire       sensor_vsync_i,      // vsync of the sensor: between frames
    input  wire       sensor_href_i,       // href of the sensor: within a line
    input  wire [{= capture.lines - 1 =}:0] sensor_data_i,       // pixel data of the sensor
    inout  wire       sensor_scl,          // I2C clock; needs a pull-up outside
    inout  wire       sensor_sda,          // I2C data; needs a pull-up outside
{%- if capture.reset %}
    output wire       sensor_reset_n_o,    // 0: the sensor is reset
{%- endif %}
{%- if capture.power_down %}
    output wire       sensor_power_down_o, // 1: the sensor is off
{%- endif %}
    input  wire       rx_i,                // serial line from the host
    output wire       tx_o,                // serial line to the host
    output wire [{= leds - 1 =}:0] led_o                // lights
);

    wire raw, clk, locked;
    board_clock u_clock (
        .clk_i(clk_i), .raw_o(raw), .clk_o(clk), .locked_o(locked)
    );

    // The reset ends once the clock has run for a while.
    reg [7:0] awake_q = 8'd0;
    wire rst = !awake_q[7];
    always @(posedge clk)
        if (!locked) awake_q <= 8'd0;
        else if (rst) awake_q <= awake_q + 1'b1;

    wire pixel_valid, pixel_ready, sof, eol;
    wire [7:0] pixel;
    wire [31:0] status;
    wire wrong;

    // The sensor: its registers are written first, then its pixels are taken.
    wire [{= capture.step_bits - 1 =}:0] step;
    wire [{= capture.word_bits - 1 =}:0] step_word;
    wire scl_low, sda_low, done, failed, lost;
    sensor_steps u_steps (.clk_i(clk), .step_i(step), .word_o(step_word));
    i2c_setup #(
        .DEVICE(7'h{= capture.device =}), .ADDRESS_BYTES({= capture.address_bytes =}), .STEPS({= capture.steps =}), .STEP_BITS({= capture.step_bits =}),
        .QUARTER({= capture.quarter =}), .PAUSE({= capture.pause =})
    ) u_setup (
        .clk_i(clk), .rst_i(rst), .step_o(step), .word_i(step_word), .scl_low_o(scl_low), .sda_low_o(sda_low),
        .sda_i(sensor_sda), .done_o(done), .failed_o(failed)
    );
    assign sensor_scl = scl_low ? 1'b0 : 1'bz;
    assign sensor_sda = sda_low ? 1'b0 : 1'bz;
    assign sensor_xclk_o = raw;
{%- if capture.reset %}
    assign sensor_reset_n_o = !rst;
{%- endif %}
{%- if capture.power_down %}
    assign sensor_power_down_o = 1'b0;
{%- endif %}
    dvp_capture #(
        .BUS_BITS({= capture.lines =}), .FORMAT({= capture.format =}), .VSYNC_HIGH({= capture.vsync_high =}), .LEFT({= capture.left =}), .TOP({= capture.top =}), .COLUMNS({= width =}),
        .LINES({= height =}), .COLUMN_BITS({= capture.column_bits =}), .LINE_BITS({= capture.line_bits =})
    ) u_capture (
        .pclk_i(sensor_pclk_i), .vsync_i(sensor_vsync_i), .href_i(sensor_href_i), .data_i(sensor_data_i), .clk_i(clk),
        .rst_i(rst), .valid_o(pixel_valid), .pixel_o(pixel), .sof_o(sof), .eol_o(eol), .ready_i(pixel_ready), .lost_o(lost)
    );
    reg [15:0] lost_q;
    always @(posedge clk) lost_q <= rst ? 16'd0 : lost_q + {15'd0, lost};
    assign status = {lost_q, 14'd0, failed, done};
    assign wrong = failed || lost_q != 16'd0;

{% include "core.v" %}    packet_bytes u_bytes (
        .clk_i(clk), .rst_i(rst), .data_i(packet), .valid_i(packet_valid), .last_i(packet_last), .ready_o(packet_ready),
        .answer_valid_i(answer_valid), .answer_byte_i(answer), .answer_last_i(answer_last), .answer_ready_o(answer_ready),
        .valid_o(sent_valid), .byte_o(sent), .ready_i(sent_ready)
    );
{% include "serial_line.v" %}
    // Lights: one blinks with frames, one is on after an error.
    reg [3:0] frames_q;
    always @(posedge clk) if (rst) frames_q <= 4'd0; else if (pixel_valid && pixel_ready && sof) frames_q <= frames_q + 1'b1;
    wire [{= leds - 1 =}:0] lit = {{% if leds > 2 %}{= leds - 2 =}'d0, {% endif %}wrong, frames_q[3]};
    assign led_o = {% if lit_low %}~{% endif %}lit;

endmodule

`default_nettype wire
