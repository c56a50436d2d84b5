// SPDX-License-Identifier: MIT OR Apache-2.0
// The rules of docs/axi.md and REGISTERS.md: AXI4-Lite with a source that obeys its rules, and the value and effect of each
// register. The constants and thresholds of a design come from its REGISTERS.md, in registers.vh.
module properties (
    input wire clk_i, rst_i, awvalid, wvalid, bready, arvalid, rready, begins, busy, restarting, input wire [11:0] awaddr, araddr,
    input wire [31:0] wdata, tick_rate, frames, input wire [3:0] wstrb, input wire [7:0] happens,
    input wire [15:0] repaired, skipped, dropped
);
    `include "reset.vh"
    wire awready, wready, bvalid, arready, rvalid, enable, waits, restart, interrupt;
    wire [31:0] rdata;
    `define CONSTANT(where, high, low, value)
    `define THRESHOLD(name, port, where, high, value)
    `define PORT(name, bits) wire [bits-1:0] name;
    `include "registers.vh"
    `undef PORT
    `define PORT(name, bits) .name(name),
    axi_registers dut (
        `include "registers.vh"
        .clk_i(clk_i), .rst_i(rst_i), .awaddr_i(awaddr), .awvalid_i(awvalid), .awready_o(awready), .wdata_i(wdata), .wstrb_i(wstrb),
        .wvalid_i(wvalid), .wready_o(wready), .bvalid_o(bvalid), .bready_i(bready), .araddr_i(araddr), .arvalid_i(arvalid),
        .arready_o(arready), .rdata_o(rdata), .rvalid_o(rvalid), .rready_i(rready), .begin_i(begins), .tick_rate_i(tick_rate),
        .control_enable_o(enable), .control_wait_o(waits), .control_restart_o(restart), .status_busy_i(busy),
        .status_restarting_i(restarting), .eol_early_i(happens[0]), .eol_late_i(happens[1]), .sof_early_i(happens[2]),
        .sof_late_i(happens[3]), .frame_skipped_i(happens[4]), .region_dropped_i(happens[5]), .row_dropped_i(happens[6]),
        .frame_done_i(happens[7]), .frames_i(frames), .repaired_i(repaired), .skipped_i(skipped), .dropped_i(dropped),
        .interrupt_o(interrupt)
    );

    // A source keeps what it offers until it is taken.
    reg aw_held, w_held, ar_held;
    reg [11:0] aw_was, ar_was;
    reg [35:0] w_was;
    always @(posedge clk_i) begin
        aw_held <= !rst_i && awvalid && !awready;
        w_held  <= !rst_i && wvalid && !wready;
        ar_held <= !rst_i && arvalid && !arready;
        {aw_was, ar_was, w_was} <= {awaddr, araddr, wstrb, wdata};
    end
    always @* if (started) begin
        assume(!aw_held || (awvalid && awaddr == aw_was));
        assume(!w_held || (wvalid && {wstrb, wdata} == w_was));
        assume(!ar_held || (arvalid && araddr == ar_was));
    end

    // Requests that were taken and have no answer yet.
    reg [1:0] addresses, words, asked;
    // Answers that are on the port and were not taken.
    reg b_held, r_held;
    reg [31:0] r_was;
    // Clocks for which one side waits although the other side does not delay it.
    reg [2:0] write_waits, read_waits;
    wire write_stands = (awvalid && wvalid && !awready) || ((addresses != 0 && words != 0) && !bvalid);
    wire read_stands = (arvalid && !arready) || (asked != 0 && !rvalid);
    always @(posedge clk_i) begin
        addresses   <= addresses + (awvalid && awready) - (bvalid && bready);
        words       <= words + (wvalid && wready) - (bvalid && bready);
        asked       <= asked + (arvalid && arready) - (rvalid && rready);
        b_held      <= !rst_i && bvalid && !bready;
        r_held      <= !rst_i && rvalid && !rready;
        r_was       <= rdata;
        write_waits <= write_stands && !(bvalid && !bready) && !(awvalid && awready) ? write_waits + 1 : 0;
        read_waits  <= read_stands && !(rvalid && !rready) && !(arvalid && arready) ? read_waits + 1 : 0;
        if (rst_i) {addresses, words, asked, write_waits, read_waits} <= 0;
    end

    // A write is executed once both of its halves are taken.
    reg [9:0] address_q;
    reg [35:0] word_q;
    wire address_comes = awvalid && awready;
    wire word_comes = wvalid && wready;
    wire writes = (address_comes || addresses != 0) && (word_comes || words != 0) && (address_comes || word_comes);
    wire [9:0] at = address_comes ? awaddr[11:2] : address_q;
    wire [3:0] strobes = word_comes ? wstrb : word_q[35:32];
    wire [31:0] word = word_comes ? wdata : word_q[31:0];
    wire [31:0] strobed = {{8{strobes[3]}}, {8{strobes[2]}}, {8{strobes[1]}}, {8{strobes[0]}}};
    always @(posedge clk_i) begin
        if (address_comes) address_q <= awaddr[11:2];
        if (word_comes) word_q <= {wstrb, wdata};
    end

    // The registers. A command takes effect at the clock after its write.
    reg own_enable, own_wait, own_restart;
    reg [7:0] events, enabled, test;
    wire [31:0] ones = writes ? word & strobed : 0;
    always @(posedge clk_i) begin
        own_restart <= at == 8 && ones[2];
        test        <= at == 12 ? ones[7:0] : 0;
        events      <= (events & ~(at == 10 ? ones[7:0] : 8'd0)) | happens | test;
        if (writes && at == 8 && strobes[0]) {own_wait, own_enable} <= word[1:0];
        if (writes && at == 11 && strobes[0]) enabled <= word[7:0];
        if (rst_i) begin
            own_enable <= 1;
            {own_wait, own_restart, events, enabled, test} <= 0;
        end
    end

    // Thresholds: the written values, and the values taken over.
    `undef PORT
    `undef THRESHOLD
    `define PORT(name, bits)
    `define THRESHOLD(name, port, where, high, value) \
        reg [31:0] name, name``_taken; \
        always @(posedge clk_i) begin \
            if (begins) name``_taken <= name; \
            if (writes && at == where) name <= (name & ~strobed) | (word & strobed & (32'hFFFFFFFF >> (31 - high))); \
            if (rst_i) {name, name``_taken} <= {value, value}; \
        end \
        always @* if (started) assert(port == name``_taken);
    `include "registers.vh"
    `undef CONSTANT
    `undef THRESHOLD

    // The value at an address. An address without a register reads as 0.
    reg [31:0] found;
    `define CONSTANT(where, high, low, value) if (araddr[11:2] == where) found[high:low] = value;
    `define THRESHOLD(name, port, where, high, value) if (araddr[11:2] == where) found = name;
    always @* begin
        found = 0;
        case (araddr[11:2])
            10'd7: found = tick_rate;
            10'd8: found = {own_wait, own_enable};
            10'd9: found = {restarting, busy};
            10'd10: found = events;
            10'd11: found = enabled;
            10'd13: found = frames;
            10'd14: found = repaired;
            10'd15: found = skipped;
            10'd16: found = dropped;
        endcase
        `include "registers.vh"
    end
    reg [31:0] answer;
    always @(posedge clk_i) if (arvalid && arready) answer <= found;

    always @* if (started) begin
        // AXI4-Lite.
        assert(addresses <= 1 && words <= 1 && asked <= 1);
        if (bvalid) assert(addresses == 1 && words == 1);
        if (rvalid) assert(asked == 1 && rdata == answer);
        if (b_held) assert(bvalid);
        if (r_held) assert(rvalid && rdata == r_was);
        assert(write_waits <= 2 && read_waits <= 2);
        // The effects of registers.
        assert(enable == own_enable && waits == own_wait && restart == own_restart);
        assert(interrupt == ((events & enabled) != 0));
    end
endmodule
