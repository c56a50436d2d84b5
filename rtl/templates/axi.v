// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// A camera core on AXI: it takes AXI4-Stream video, sends packets on AXI4-Stream, and has registers on AXI4-Lite. The array
// `rcm` is inside (docs/axi.md of Foveate).
`default_nettype none

module rcm_axi #(
    parameter [31:0] TICK_RATE = 32'd100000000  // frequency of aclk in Hz, which is the number of ticks per second in packets
) (
    (* X_INTERFACE_INFO = "xilinx.com:signal:clock:1.0 aclk CLK" *)
    (* X_INTERFACE_PARAMETER = "ASSOCIATED_BUSIF s_axis_video:m_axis_packets:s_axi, ASSOCIATED_RESET aresetn" *)
    input  wire        aclk,                  // clock, rising edge
    (* X_INTERFACE_INFO = "xilinx.com:signal:reset:1.0 aresetn RST" *)
    (* X_INTERFACE_PARAMETER = "POLARITY ACTIVE_LOW" *)
    input  wire        aresetn,               // synchronous reset, active low
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 s_axis_video TDATA" *)
    input  wire [{= video_bits - 1 =}:0] s_axis_video_tdata,    // {= lanes =} pixels, the left one in the lowest bits
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 s_axis_video TVALID" *)
    input  wire        s_axis_video_tvalid,   // pixels are offered
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 s_axis_video TREADY" *)
    output wire        s_axis_video_tready,   // the offered pixels are taken
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 s_axis_video TUSER" *)
    input  wire        s_axis_video_tuser,    // the offered pixels are the first of a frame
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 s_axis_video TLAST" *)
    input  wire        s_axis_video_tlast,    // the offered pixels are the last of a line
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 m_axis_packets TDATA" *)
    output wire [63:0] m_axis_packets_tdata,  // a word of a packet
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 m_axis_packets TKEEP" *)
    output wire [ 7:0] m_axis_packets_tkeep,  // all ones: every byte of a word is valid
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 m_axis_packets TVALID" *)
    output wire        m_axis_packets_tvalid, // a word of a packet is on tdata
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 m_axis_packets TREADY" *)
    input  wire        m_axis_packets_tready, // the sink takes the word
    (* X_INTERFACE_INFO = "xilinx.com:interface:axis:1.0 m_axis_packets TLAST" *)
    output wire        m_axis_packets_tlast,  // the word is the last of its packet
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi AWADDR" *)
    input  wire [11:0] s_axi_awaddr,          // address of a write, in bytes
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi AWPROT" *)
    input  wire [ 2:0] s_axi_awprot,          // ignored
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi AWVALID" *)
    input  wire        s_axi_awvalid,         // an address of a write is offered
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi AWREADY" *)
    output wire        s_axi_awready,         // the address is taken
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi WDATA" *)
    input  wire [31:0] s_axi_wdata,           // the value that is written
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi WSTRB" *)
    input  wire [ 3:0] s_axi_wstrb,           // one bit per byte of the value: this byte is written
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi WVALID" *)
    input  wire        s_axi_wvalid,          // a value is offered
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi WREADY" *)
    output wire        s_axi_wready,          // the value is taken
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi BRESP" *)
    output wire [ 1:0] s_axi_bresp,           // always OKAY
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi BVALID" *)
    output wire        s_axi_bvalid,          // the write is done
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi BREADY" *)
    input  wire        s_axi_bready,          // the answer to the write is taken
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi ARADDR" *)
    input  wire [11:0] s_axi_araddr,          // address of a read, in bytes
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi ARPROT" *)
    input  wire [ 2:0] s_axi_arprot,          // ignored
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi ARVALID" *)
    input  wire        s_axi_arvalid,         // an address of a read is offered
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi ARREADY" *)
    output wire        s_axi_arready,         // the address is taken
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi RDATA" *)
    output wire [31:0] s_axi_rdata,           // the value that was read
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi RRESP" *)
    output wire [ 1:0] s_axi_rresp,           // always OKAY
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi RVALID" *)
    output wire        s_axi_rvalid,          // the value is on rdata
    (* X_INTERFACE_INFO = "xilinx.com:interface:aximm:1.0 s_axi RREADY" *)
    input  wire        s_axi_rready,          // the value is taken
{%- for port in array_ports_outside %}
    {= port.declaration =}  // {= port.doc =}
{%- endfor %}
{%- if !array_ports_outside.is_empty() %}
    output wire        forget_o,              // the memory outside must forget what was stored, at this edge
{%- endif %}
    (* X_INTERFACE_INFO = "xilinx.com:signal:interrupt:1.0 interrupt_o INTERRUPT" *)
    (* X_INTERFACE_PARAMETER = "SENSITIVITY LEVEL_HIGH" *)
    output wire        interrupt_o            // an enabled event has happened
);

    localparam COLUMNS = {= columns =};
    localparam ROWS = {= rows =};
    localparam COLUMN_BITS = {= column_bits =};
    localparam REGION_BITS = {= region_bits =};
    localparam ROW_BITS = REGION_BITS - COLUMN_BITS + 1;
    localparam BITS = {= bits =};  // bits of a packet that are made per clock
    localparam PART_BITS = {= part_bits =};

    wire unused_protection = |s_axi_awprot || |s_axi_arprot;
{%- if video_bits > word_bits %}
    wire unused_video = |s_axis_video_tdata[{= video_bits - 1 =}:{= word_bits =}];
{%- endif %}

    // A restart waits until no frame is under way. It then resets the array.
    wire rst = !aresetn;
    wire enable, waits, restart, busy, idle_video, idle_packets;
    reg restarting_q;
{%- if class_address_bits.is_some() %}
    wire zone_write, zone_commit;
    wire forget = restarting_q && !busy && idle_video && idle_packets && !zone_write && !zone_commit;
{%- else %}
    wire forget = restarting_q && !busy && idle_video && idle_packets;
{%- endif %}
    always @(posedge aclk) restarting_q <= !rst && !forget && (restarting_q || restart);
{%- if !array_ports_outside.is_empty() %}
    assign forget_o = forget;
{%- endif %}

    // The time in ticks.
    reg [63:0] time_q;
    always @(posedge aclk) time_q <= rst ? 64'd0 : time_q + 1'b1;

    // Video becomes whole frames for the array.
    wire may_begin, behind, frame_begins, frame_skipped, frame_damaged, sof_early, sof_late, eol_early, eol_late;
    wire word_valid, word_first, word_ready;
    wire [{= word_bits - 1 =}:0] word;
    wire admit = may_begin && enable && !restarting_q;
    wire late = !enable || (behind && !waits);
    axi_video #(
        .WIDTH({= pixel_bits =}), .LANES({= lanes =}), .WORDS({= words =}), .LINES({= height =}),
        .WORD_BITS({= words_bits =}), .LINE_BITS({= lines_bits =})
    ) u_video (
        .clk_i(aclk), .rst_i(rst), .valid_i(s_axis_video_tvalid), .pixel_i(s_axis_video_tdata[{= word_bits - 1 =}:0]),
        .sof_i(s_axis_video_tuser), .eol_i(s_axis_video_tlast), .ready_o(s_axis_video_tready),
        .admit_i(admit), .late_i(late), .begin_o(frame_begins), .idle_o(idle_video),
        .valid_o(word_valid), .pixel_o(word), .sof_o(word_first), .ready_i(word_ready),
        .skip_o(frame_skipped), .repair_o(frame_damaged), .sof_early_o(sof_early), .sof_late_o(sof_late),
        .eol_early_o(eol_early), .eol_late_o(eol_late)
    );

{%- if let Some(bits) = class_address_bits %}

    // The map of classes. A commit waits while a frame begins, so that its FRAME packet has the version of the map that it uses.
    // The version and a commit that waits stay at a reset, as the map does.
    wire [31:0] zone_word;
    wire [{= bits - 1 =}:0] zone_address;
    wire zone_word_write, zone_address_write, zone_commit_write, array_pending;
    reg [{= bits - 1 =}:0] zone_address_q;
    reg commit_q = 1'b0;
    reg opening_q;  // the first word of a frame has not reached the array yet
    reg [15:0] version_q = 16'd0;
    reg [15:0] frame_version_q;
    wire zone_pending = commit_q || array_pending;
    assign zone_write = zone_word_write && !zone_pending;
    assign zone_commit = commit_q && !rst && !frame_begins && !opening_q;
    always @(posedge aclk) begin
        opening_q <= !rst && (frame_begins || (opening_q && !(word_valid && word_ready)));
        if (frame_begins) frame_version_q <= version_q;
        if (zone_write) zone_address_q <= zone_address_q + 1'b1;
        if (zone_address_write) zone_address_q <= zone_address;
        if (zone_commit) begin
            commit_q  <= 1'b0;
            version_q <= version_q + 1'b1;
        end
        if (zone_commit_write && !zone_pending && !rst) begin
            commit_q       <= 1'b1;
            zone_address_q <= {{= bits =}{1'b0}};
        end
        if (rst) zone_address_q <= {{= bits =}{1'b0}};
    end
{%- endif %}

    // The array, which docs/raster.md calls the core.
    wire decision_valid, srs, trs, active, summary;
    wire forward_valid, forward_ready, forward_first, forward_last, forward_abort, forward_summary, lost_valid;
    wire [REGION_BITS-1:0] forward_region;
    wire [{= word_bits - 1 =}:0] forward_pixel;
    wire [7:0] forward_frame, lost_frame;
{%- for port in thresholds %}
    wire [{= port.width - 1 =}:0] {= port.name =};
{%- endfor %}
{%- for port in unused %}
    wire [{= port.width - 1 =}:0] unused_{= port.name =};
{%- endfor %}
{%- if !has_means %}
    assign {summary, forward_summary} = 2'b00;
{%- endif %}
{%- if !syncs %}
    wire unused_first = word_first;
{%- endif %}
    wire unused_frames = |forward_frame[7:1] || |lost_frame[7:1];
    rcm #(.COLUMNS(COLUMNS), .ROWS(ROWS)) u_rcm (
{%- for connection in connections %}
        .{= connection.0 =}({= connection.1 =}){% if !loop.last %},{% endif %}
{%- endfor %}
    );

    // Decisions and pixels wait here until their packets leave.
    wire decided_frame, decided_last, row_dropped, row_valid, row_frame, row_take;
    wire region_whole, region_whole_frame, region_valid, region_frame, region_summary, region_take, read;
    wire [ROW_BITS-1:0] row, region_row;
    wire [COLUMN_BITS-1:0] region_column;
    wire [BITS-1:0] row_part, region_part;
    wire [PART_BITS-1:0] part;
    packet_rows #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .COLUMN_BITS(COLUMN_BITS), .ROW_BITS(ROW_BITS),
        .DECISION_BITS({= decision_bits =}), .BITS(BITS), .PART_BITS(PART_BITS)
    ) u_rows (
        .clk_i(aclk), .rst_i(rst || forget), .decision_i(decision_valid), .srs_i(srs), .trs_i(trs), .summary_i(summary),
        .frame_o(decided_frame), .last_o(decided_last), .dropped_o(row_dropped), .valid_o(row_valid),
        .valid_frame_o(row_frame), .row_o(row), .read_i(read), .part_i(part), .part_o(row_part), .take_i(row_take)
    );
    packet_regions #(
        .WIDTH({= pixel_bits =}), .LANES({= lanes =}), .PIXELS({= pixels =}), .MEANS({= means =}), .COLUMNS(COLUMNS),
        .COLUMN_BITS(COLUMN_BITS), .REGION_BITS(REGION_BITS), .BITS(BITS), .PART_BITS(PART_BITS)
    ) u_regions (
        .clk_i(aclk), .rst_i(rst || forget), .valid_i(forward_valid), .region_i(forward_region), .pixel_i(forward_pixel),
        .first_i(forward_first), .last_i(forward_last), .abort_i(forward_abort), .frame_i(forward_frame[0]),
        .summary_i(forward_summary), .ready_o(forward_ready), .whole_o(region_whole), .whole_frame_o(region_whole_frame),
        .valid_o(region_valid), .valid_frame_o(region_frame), .summary_o(region_summary), .row_o(region_row),
        .column_o(region_column), .read_i(read), .part_i(part), .part_o(region_part), .take_i(region_take)
    );

    // Frames under way.
    wire announced, first, frame, closed, opened, ended;
    wire [63:0] frame_time;
    wire [31:0] number, frames;
    wire [REGION_BITS:0] dropped;
    wire [ROW_BITS:0] dropped_rows;
    packet_frames #(.PENDING_BITS({= pending_bits =}), .REGION_BITS(REGION_BITS), .ROW_BITS(ROW_BITS)) u_frames (
        .clk_i(aclk), .rst_i(rst), .forget_i(forget), .time_i(time_q), .begin_i(frame_begins), .skip_i(frame_skipped),
        .decided_frame_i(decided_frame), .decided_last_i(decided_last), .sends_i(active || summary),
        .row_dropped_i(row_dropped), .whole_i(region_whole), .whole_frame_i(region_whole_frame), .lost_i(lost_valid),
        .lost_frame_i(lost_frame[0]), .opened_i(opened), .ended_i(ended), .admit_o(may_begin), .behind_o(behind), .busy_o(busy),
        .announced_o(announced), .first_o(first), .time_o(frame_time), .number_o(number), .frames_o(frames), .frame_o(frame),
        .closed_o(closed), .dropped_o(dropped), .dropped_rows_o(dropped_rows)
    );

    assign m_axis_packets_tkeep = 8'hFF;
    packet_writer #(
        .BITS(BITS), .PART_BITS(PART_BITS), .ROW_WORDS({= row_words =}), .PIXEL_WORDS({= pixel_words =}), .MEAN_WORDS({= mean_words =}),
        .REGION_BITS(REGION_BITS), .COLUMN_BITS(COLUMN_BITS), .ROW_BITS(ROW_BITS), .COLUMNS(COLUMNS), .ROWS(ROWS),
        .FRAME_WIDTH({= width =}), .FRAME_HEIGHT({= height =}), .SIDE({= side =}), .WIDTH({= pixel_bits =}), .MEANS_SIDE({= means_side =}),
        .IRRELEVANT({= irrelevant =}), .RAW({= raw =}), .FINGERPRINT(64'h{= fingerprint =})
    ) u_writer (
        .clk_i(aclk), .rst_i(rst), .announced_i(announced), .first_i(first), .time_i(frame_time), .rate_i(TICK_RATE),
        .number_i(number), .map_version_i({% if class_address_bits.is_some() %}frame_version_q{% else %}16'd0{% endif %}), .frame_i(frame), .closed_i(closed), .dropped_i(dropped), .dropped_rows_i(dropped_rows),
        .opened_o(opened), .ended_o(ended), .idle_o(idle_packets), .row_valid_i(row_valid), .row_frame_i(row_frame),
        .row_i(row), .row_part_i(row_part), .row_take_o(row_take), .region_valid_i(region_valid),
        .region_frame_i(region_frame), .region_summary_i(region_summary), .region_row_i(region_row),
        .region_column_i(region_column), .region_part_i(region_part), .region_take_o(region_take), .read_o(read),
        .part_o(part), .data_o(m_axis_packets_tdata), .valid_o(m_axis_packets_tvalid), .last_o(m_axis_packets_tlast),
        .ready_i(m_axis_packets_tready)
    );

    // Counters, and the registers.
    wire skips = frame_skipped && enable;
    reg [15:0] repaired_q, skipped_q, dropped_q;
    always @(posedge aclk) begin
        if (frame_damaged) repaired_q <= repaired_q + 1'b1;
        if (skips) skipped_q <= skipped_q + 1'b1;
        if (lost_valid) dropped_q <= dropped_q + 1'b1;
        if (rst) begin
            repaired_q <= 16'd0;
            skipped_q  <= 16'd0;
            dropped_q  <= 16'd0;
        end
    end
    assign s_axi_bresp = 2'b00;
    assign s_axi_rresp = 2'b00;
    axi_registers u_registers (
        .clk_i(aclk), .rst_i(rst), .awaddr_i(s_axi_awaddr), .awvalid_i(s_axi_awvalid), .awready_o(s_axi_awready),
        .wdata_i(s_axi_wdata), .wstrb_i(s_axi_wstrb), .wvalid_i(s_axi_wvalid), .wready_o(s_axi_wready),
        .bvalid_o(s_axi_bvalid), .bready_i(s_axi_bready), .araddr_i(s_axi_araddr), .arvalid_i(s_axi_arvalid),
        .arready_o(s_axi_arready), .rdata_o(s_axi_rdata), .rvalid_o(s_axi_rvalid), .rready_i(s_axi_rready),
        .begin_i(frame_begins), .tick_rate_i(TICK_RATE), .status_busy_i(busy), .status_restarting_i(restarting_q),
        .eol_early_i(eol_early), .eol_late_i(eol_late), .sof_early_i(sof_early), .sof_late_i(sof_late),
        .frame_skipped_i(skips), .region_dropped_i(lost_valid), .row_dropped_i(row_dropped), .frame_done_i(ended),
        .frames_i(frames), .repaired_i(repaired_q), .skipped_i(skipped_q), .dropped_i(dropped_q),
{%- if class_address_bits.is_some() %}
        .zone_word_i(32'd0), .zone_word_o(zone_word), .zone_word_write_o(zone_word_write),
        .zone_address_i(zone_address_q), .zone_address_o(zone_address), .zone_address_write_o(zone_address_write),
        .zone_control_commit_o(zone_commit_write), .zone_control_pending_i(zone_pending), .zone_control_version_i(version_q),
{%- endif %}
        .control_enable_o(enable), .control_wait_o(waits), .control_restart_o(restart),
{%- for port in thresholds %}
        .{= port.name =}_o({= port.name =}),
{%- endfor %}
        .interrupt_o(interrupt_o)
    );

endmodule

`default_nettype wire
