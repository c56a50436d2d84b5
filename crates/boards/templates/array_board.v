// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// For {= title =}:
// the array `rcm` behind a pattern at full rate, with a sum of all its outputs, captures and a serial line (docs/boards.md of Foveate).
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

    localparam COLUMNS = {= columns =};
    localparam ROWS = {= rows =};
    localparam REGIONS = COLUMNS * ROWS;
    localparam HEAD_BYTES = {= head_bytes =};

    wire clk, unused_raw, locked;
    board_clock u_clock ({% if pair %}.clk_p_i(clk_p_i), .clk_n_i(clk_n_i){% else %}.clk_i(clk_i){% endif %}, .raw_o(unused_raw), .clk_o(clk), .locked_o(locked));

    // The reset ends once the clock has run for a while.
    reg [7:0] awake_q = 8'd0;
    wire rst = !awake_q[7];
    always @(posedge clk)
        if (!locked) awake_q <= 8'd0;
        else if (rst) awake_q <= awake_q + 1'b1;

    // The pattern.
    wire pixel_valid, soon;
    wire [REGIONS*8-1:0] pixel;
    array_pattern #(.COLUMNS(COLUMNS), .ROWS(ROWS), .SIDE({= side =}), .SIDE_BITS({= side_bits =})) u_pattern (
        .clk_i(clk), .rst_i(rst), .valid_o(pixel_valid), .pixel_o(pixel), .soon_o(soon)
    );

    // The thresholds: as the host wrote them, and as the array uses them at this clock.
    wire taken, level_turn, temporal_turn, minimum_turn;
    array_turn #(
        .LEVEL_AT({= level_at =}), .TEMPORAL_AT({= temporal_at =}), .MINIMUM_AT({= minimum_at =}), .COUNT_BITS({= turn_bits =})
    ) u_turn (
        .clk_i(clk), .rst_i(rst), .soon_i(soon), .begin_o(taken), .level_o(level_turn), .temporal_o(temporal_turn),
        .minimum_o(minimum_turn)
    );
    wire unused_turn = level_turn || temporal_turn || minimum_turn;
{%- for threshold in thresholds %}
    wire {= threshold.range =}written_{= threshold.name =};
    reg {= threshold.range =}{= threshold.name =}_q;
    always @(posedge clk) if ({= threshold.turn_signal =}_turn || rst) {= threshold.name =}_q <= written_{= threshold.name =};
{%- endfor %}

    // The array.
    wire decided;
    wire [REGIONS-1:0] srs, trs, active, forward_valid;
    wire [REGIONS*8-1:0] forward_pixel;
{%- if has_summary %}
    wire [REGIONS-1:0] summary;
{%- else %}
    wire [REGIONS-1:0] summary = {REGIONS{1'b0}};
{%- endif %}
{%- for score in scores %}
    wire [REGIONS*{= score.width =}-1:0] {= score.name =};
{%- endfor %}
    rcm #(.COLUMNS(COLUMNS), .ROWS(ROWS)) u_array (
        .clk_i(clk), .rst_i(rst), .valid_i(pixel_valid), .pixel_i(pixel),
{%- for threshold in thresholds %}
        .{= threshold.name =}_i({= threshold.name =}_q),
{%- endfor %}
{%- for score in scores %}
        .{= score.name =}_o({= score.name =}),
{%- endfor %}
{%- if has_summary %}
        .summary_o(summary),
{%- endif %}
        .decision_valid_o(decided), .srs_o(srs), .trs_o(trs), .active_o(active), .forward_valid_o(forward_valid),
        .forward_pixel_o(forward_pixel)
    );

    // The outputs of each RPU for a decision, registered as bytes: decision and scores, the first in the lowest bits.
    wire [REGIONS*HEAD_BYTES*8-1:0] head;
    genvar region;
    generate
        for (region = 0; region < REGIONS; region = region + 1) begin : g_region
            assign head[region*HEAD_BYTES*8+:HEAD_BYTES*8] = {
{%- for part in head %}
                {= part =}{% if !loop.last %},{% endif %}
{%- endfor %}
            };
        end
    endgenerate
    reg decided_q;
    reg [REGIONS*HEAD_BYTES*8-1:0] head_q;
    reg [REGIONS-1:0] forward_valid_q;
    reg [REGIONS*8-1:0] forward_pixel_q;
    always @(posedge clk) begin
        decided_q       <= decided && !rst;
        head_q          <= head;
        forward_valid_q <= forward_valid;
        forward_pixel_q <= forward_pixel;
    end

    // All outputs are added up, and those of one RPU are kept for the host.
    wire [31:0] sum, frames, status;
    wire frame_done, right, wrong;
    array_signature #(.COLUMNS(COLUMNS), .ROWS(ROWS), .HEAD_BYTES(HEAD_BYTES), .PIXELS({= pixels =})) u_signature (
        .clk_i(clk), .rst_i(rst), .decided_i(decided_q), .head_i(head_q), .forward_valid_i(forward_valid_q),
        .forward_pixel_i(forward_pixel_q), .sum_o(sum), .frames_o(frames), .done_o(frame_done)
    );
    expected_sums u_expected (
        .clk_i(clk), .rst_i(rst), .done_i(frame_done), .sum_i(sum), .frames_i(frames), .right_o(right), .wrong_o(wrong)
    );
    assign status = {frames[15:0], 14'd0, wrong, right};
    wire [15:0] column, row;
    wire [6:0] frame;
    wire start, captured;
    wire [31:0] captured_frame, values;
    wire [HEAD_BYTES*8-1:0] captured_head;
    wire [{= count_bits - 1 =}:0] count;
    wire [8:0] place;
    wire unused_head = |captured_head;
    array_snapshot #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .COLUMN_BITS(16), .ROW_BITS(16), .HEAD_BYTES(HEAD_BYTES), .PIXELS({= pixels =}), .COUNT_BITS({= count_bits =})
    ) u_snapshot (
        .clk_i(clk), .rst_i(rst), .decided_i(decided_q), .head_i(head_q), .forward_valid_i(forward_valid_q),
        .forward_pixel_i(forward_pixel_q), .column_i(column), .row_i(row), .frame_i(frame), .start_i(start), .captured_o(captured),
        .number_o(captured_frame), .head_o(captured_head), .count_o(count), .place_i(place), .word_o(values)
    );

    // The registers and the serial line: commands come in, answers go out.
    wire [11:0] awaddr, araddr;
    wire [31:0] wdata, rdata;
    wire [3:0] wstrb;
    wire awvalid, awready, wvalid, wready, bvalid, bready, arvalid, arready, rvalid, rready;
    array_registers u_array_registers (
        .clk_i(clk), .rst_i(rst), .awaddr_i(awaddr), .awvalid_i(awvalid), .awready_o(awready), .wdata_i(wdata), .wstrb_i(wstrb),
        .wvalid_i(wvalid), .wready_o(wready), .bvalid_o(bvalid), .bready_i(bready), .araddr_i(araddr), .arvalid_i(arvalid),
        .arready_o(arready), .rdata_o(rdata), .rvalid_o(rvalid), .rready_i(rready), .begin_i(taken), .place_o(place),
        .values_i(values), .frames_i(frames), .capture_region_column_o(column), .capture_region_row_o(row),
        .capture_frame_o(frame), .capture_start_o(start), .capture_captured_i(captured), .captured_frame_i(captured_frame),
        .captured_decision_srs_i(captured_head[0]), .captured_decision_trs_i(captured_head[1]),
        .captured_decision_summary_i(captured_head[2]), .captured_decision_active_i(captured_head[3]),
{%- for threshold in thresholds %}
        .{= threshold.name =}_o(written_{= threshold.name =}),
{%- endfor %}
{%- for pin in pins %}
        .{= pin.0 =}({= pin.1 =}),
{%- endfor %}
        .captured_decision_values_i(count)
    );
    wire sent_valid, sent_ready, heard_valid, answer_valid, answer_ready, unused_last;
    wire [7:0] sent, heard, answer;
    wire answer_last;
    assign unused_last = answer_last;
    assign sent_valid = answer_valid;
    assign sent = answer;
    assign answer_ready = sent_ready;
{% include "serial_line.v" %}
    // Lights: one blinks with frames, one is on if a sum was wrong, one if all sums were right.
    wire [{= leds - 1 =}:0] lit = {{% if leds > 3 %}{= leds - 3 =}'d0, {% endif %}right, wrong, frames[{= blink =}]};
    assign led_o = {% if lit_low %}~{% endif %}lit;

endmodule

`default_nettype wire
