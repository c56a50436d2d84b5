// SPDX-License-Identifier: MIT OR Apache-2.0
// A core and a host with arbitrary behavior. A simulation checks the content of commands (tb/board/registers_bench.v); here only
// bytes that may belong to a command are counted.
module properties #(parameter BYTES = 24, GAP = 10) (
    input wire clk_i, rst_i, valid, answer_ready, awready, wready, bvalid, arready, rvalid, input wire [7:0] value, input wire [31:0] board, rdata
);
    `include "reset.vh"
    localparam PAUSE = 16;
    wire answer_valid, answer_last, awvalid, wvalid, bready, arvalid, rready;
    wire [7:0] answer;
    wire [11:0] awaddr, araddr;
    wire [31:0] wdata;
    wire [3:0] wstrb;
    uart_registers #(.PAUSE(PAUSE)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .byte_i(value), .answer_valid_o(answer_valid), .answer_byte_o(answer),
        .answer_last_o(answer_last), .answer_ready_i(answer_ready), .board_i(board), .m_awaddr_o(awaddr), .m_awvalid_o(awvalid),
        .m_awready_i(awready), .m_wdata_o(wdata), .m_wstrb_o(wstrb), .m_wvalid_o(wvalid), .m_wready_i(wready), .m_bvalid_i(bvalid),
        .m_bready_o(bready), .m_araddr_o(araddr), .m_arvalid_o(arvalid), .m_arready_i(arready), .m_rdata_i(rdata), .m_rvalid_i(rvalid),
        .m_rready_o(rready)
    );

    // Bytes come at least GAP clocks after one another, as on a serial line.
    reg [3:0] since;
    always @(posedge clk_i) since <= rst_i ? GAP : valid ? 1 : since == GAP ? GAP : since + 1;
    always @* if (started) assume(!valid || since == GAP);

    // The core answers only requests, and holds its answer.
    reg addressed, worded, asked, was_b, was_r;
    reg [31:0] r_before;
    always @(posedge clk_i) begin
        if (awvalid && awready) addressed <= 1;
        if (wvalid && wready) worded <= 1;
        if (arvalid && arready) asked <= 1;
        if (bvalid && bready) {addressed, worded} <= 0;
        if (rvalid && rready) asked <= 0;
        was_b    <= !rst_i && bvalid && !bready;
        was_r    <= !rst_i && rvalid && !rready;
        r_before <= rdata;
        if (rst_i) {addressed, worded, asked} <= 0;
    end
    always @* if (started) begin
        assume(!bvalid || (addressed && worded));
        assume(!rvalid || asked);
        if (was_b) assume(bvalid);
        if (was_r) assume(rvalid && rdata == r_before);
    end

    // An upper bound of the bytes of a command: its place in a packet if no byte was wrong. A pause begins another packet.
    reg [4:0] heard;
    reg [4:0] pause;
    reg [4:0] told;       // number of bytes of an answer
    wire busy = awvalid || wvalid || arvalid || addressed || worded || asked;
    always @(posedge clk_i) begin
        pause <= valid ? 0 : pause == PAUSE + 1 ? pause : pause + 1;
        // After a pause the byte is the first of a packet.
        if (valid && !answer_valid) heard <= pause > PAUSE ? 1 : heard == BYTES ? BYTES : heard + 1;
        if (answer_valid && answer_ready) begin
            told <= answer_last ? 0 : told + 1;
            if (answer_last) heard <= 0;
        end
        if (rst_i) {heard, told, pause} <= 0;
    end

    reg was_aw, was_w, was_ar, was_answer, was_busy;
    reg [11:0] aw_before, ar_before;
    reg [31:0] w_before;
    reg [8:0] answer_before;
    always @(posedge clk_i) begin
        was_aw        <= !rst_i && awvalid && !awready;
        was_w         <= !rst_i && wvalid && !wready;
        was_ar        <= !rst_i && arvalid && !arready;
        was_answer    <= !rst_i && answer_valid && !answer_ready;
        aw_before     <= awaddr;
        ar_before     <= araddr;
        w_before      <= wdata;
        answer_before <= {answer_last, answer};
        was_busy      <= !rst_i && busy;
    end
    always @* if (started) begin
        // Offered values stay until they are taken.
        if (was_aw) assert(awvalid && awaddr == aw_before);
        if (was_w) assert(wvalid && wdata == w_before);
        if (was_ar) assert(arvalid && araddr == ar_before);
        if (was_answer) assert(answer_valid && {answer_last, answer} == answer_before);
        assert(wstrb == 4'hF);
        // One transfer at a time, each with one address and one word, and its answer is taken at once.
        assert(!(awvalid || wvalid || addressed || worded) || !(arvalid || asked));
        if (awvalid) assert(!addressed);
        if (wvalid) assert(!worded);
        if (arvalid) assert(!asked);
        if (awvalid || addressed) assert(wvalid || worded);
        if (wvalid || worded) assert(awvalid || addressed);
        if (bvalid) assert(bready);
        if (rvalid) assert(rready);
        // A transfer begins only after BYTES bytes without a pause, and no answer is sent before it has ended.
        if (busy && !was_busy) assert(heard == BYTES);
        if (answer_valid) assert(!busy);
        if (answer_valid) assert(answer_last == (told == BYTES - 1));
        assert(told < BYTES);
    end
endmodule
