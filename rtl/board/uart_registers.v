// SPDX-License-Identifier: MIT OR Apache-2.0
// Reads and writes registers for a host on a serial line (docs/boards.md). A command is a REGISTER packet (docs/packets.md), and
// the answer is the same packet with the value that was read.
//
// Command and answer pass bit by bit through the same registers; each part of a packet rotates its own register. A bit that is
// received is compared with the bit that would be sent, and stays where it would be sent from. So there is no multiplexer of
// bytes, and the CRC takes one bit per clock.
`default_nettype none

module uart_registers #(
    parameter PAUSE = 160  // clocks without a byte, at least 16, after which a partial command is dropped
) (
    input  wire        clk_i,           // clock, rising edge
    input  wire        rst_i,           // synchronous reset, active high
    input  wire        valid_i,         // a byte has come, at least 10 clocks after the byte before
    input  wire [ 7:0] byte_i,          // the byte that has come
    output wire        answer_valid_o,  // a byte of an answer is on answer_byte_o
    output wire [ 7:0] answer_byte_o,   // the byte of the answer
    output wire        answer_last_o,   // the byte is the last of the answer
    input  wire        answer_ready_i,  // the byte is taken
    input  wire [31:0] board_i,         // value of the register at address 0x1000
    output wire [11:0] m_awaddr_o,      // AXI4-Lite: address of a write, in bytes
    output wire        m_awvalid_o,     // the address of a write is on the port
    input  wire        m_awready_i,     // the address of a write is taken
    output wire [31:0] m_wdata_o,       // the value that is written
    output wire [ 3:0] m_wstrb_o,       // one bit per byte of the value: always all ones
    output wire        m_wvalid_o,      // the value is on the port
    input  wire        m_wready_i,      // the value is taken
    input  wire        m_bvalid_i,      // the write is done
    output wire        m_bready_o,      // the answer to the write is taken
    output wire [11:0] m_araddr_o,      // address of a read, in bytes
    output wire        m_arvalid_o,     // the address of a read is on the port
    input  wire        m_arready_i,     // the address of a read is taken
    input  wire [31:0] m_rdata_i,       // the value that was read
    input  wire        m_rvalid_i,      // the value is on the port
    output wire        m_rready_o       // the value is taken
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (PAUSE < 16) begin : g_pause PAUSE_must_be_16_or_more u_refused (); end
    endgenerate

    localparam [4:0] LAST_PLACE = 5'd23;
    reg does_q, tells_q;  // a command is executed; its answer is sent; with neither, a command is received
    reg moves_q;          // a byte moves, bit by bit
    reg told_q;           // a byte of the answer waits to be taken
    reg [4:0] place_q;    // number of the byte in the packet; after it has moved, of the next byte
    reg [2:0] bit_q;      // number of the bit in the byte
    reg [7:0] byte_q;
    reg [31:0] crc_q;

    // The command.
    reg write_q;
    reg [15:0] address_q;
    reg [31:0] value_q;
    wire core = address_q[15:12] == 4'd0;

    // The bit of an answer at this place.
    localparam [7:0] MARK = 8'hFA;
    localparam [7:0] TYPE = 8'h06;
    localparam [7:0] WORDS = 8'h03;
    wire in_flag = place_q == 5'd1 && bit_q == 3'd4;
    wire in_address = place_q[4:1] == 4'd2;
    wire in_value = place_q[4:2] == 3'd2;
    wire in_crc = place_q[4:2] == 3'd5;
    reg tell;
    always @* begin
        tell = 1'b0;
        if (place_q == 5'd0) tell = MARK[bit_q];
        if (place_q == 5'd1) tell = TYPE[bit_q] || (bit_q == 3'd4 && write_q);
        if (place_q == 5'd2) tell = WORDS[bit_q];
        if (in_address) tell = address_q[0];
        if (in_value) tell = value_q[0];
        if (in_crc) tell = !crc_q[0];
    end
    wire now = tells_q ? tell : byte_q[0];

    // The bits that a command must have in common with its answer: the head without address and flag, and the CRC. Bytes 12 to
    // 19 are not compared.
    wire looked_at = !in_flag && !in_address && (place_q[4:3] == 2'd0 || in_crc);
    reg wrong_q;
    wire wrong = wrong_q || (!tells_q && looked_at && now != tell);
    wire byte_ends = moves_q && bit_q == 3'd7;
    wire packet_ends = byte_ends && place_q == LAST_PLACE;
    wire heard = packet_ends && !tells_q && !wrong;

    // In the bytes of the CRC, the sum only shifts.
    wire [31:0] next_crc;
    packet_crc #(.BITS(1)) u_crc (.crc_i(crc_q), .data_i(in_crc ? crc_q[0] : now), .crc_o(next_crc));

    // The pause without bytes.
    localparam TIME_BITS = $clog2(PAUSE);
    localparam LAST_TIME = PAUSE - 1;
    reg [TIME_BITS-1:0] time_q;
    wire hear = valid_i && !moves_q && !does_q && !tells_q;
    wire forget = time_q == LAST_TIME[TIME_BITS-1:0] && !hear;

    reg aw_q, w_q, ar_q;
    wire done = does_q && (!core || m_bvalid_i || m_rvalid_i);
    wire take = told_q && answer_ready_i;
    always @(posedge clk_i) begin
        if (moves_q) bit_q <= bit_q + 1'b1;
        if (byte_ends) place_q <= wrong || place_q == LAST_PLACE ? 5'd0 : place_q + 1'b1;
        else if (forget) place_q <= 5'd0;
        moves_q <= hear || done || (take && place_q != 5'd0) || (moves_q && !byte_ends);
        wrong_q <= moves_q && wrong && !byte_ends;
        does_q  <= heard || (does_q && !done);
        tells_q <= done || (tells_q && !(take && place_q == 5'd0));
        told_q  <= (byte_ends && tells_q) || (told_q && !take);
        time_q  <= hear || tells_q ? {TIME_BITS{1'b0}} : time_q + 1'b1;

        if (hear) byte_q <= byte_i;
        else if (moves_q) byte_q <= {now, byte_q[7:1]};
        if (moves_q) crc_q <= next_crc;
        else if (place_q == 5'd0) crc_q <= 32'hFFFFFFFF;
        if (moves_q && in_flag) write_q <= now;
        if (moves_q && in_address) address_q <= {now, address_q[15:1]};
        if (moves_q && in_value) value_q <= {now, value_q[31:1]};
        else if (does_q && !write_q) value_q <= core ? m_rdata_i : address_q == 16'h1000 ? board_i : 32'd0;

        aw_q <= (heard && core && write_q) || (aw_q && !m_awready_i);
        w_q  <= (heard && core && write_q) || (w_q && !m_wready_i);
        ar_q <= (heard && core && !write_q) || (ar_q && !m_arready_i);
        if (rst_i) begin
            place_q <= 5'd0;
            bit_q   <= 3'd0;
            moves_q <= 1'b0;
            wrong_q <= 1'b0;
            does_q  <= 1'b0;
            tells_q <= 1'b0;
            told_q  <= 1'b0;
            time_q  <= {TIME_BITS{1'b0}};
            aw_q    <= 1'b0;
            w_q     <= 1'b0;
            ar_q    <= 1'b0;
        end
    end

    assign answer_valid_o = told_q;
    assign answer_byte_o = byte_q;
    assign answer_last_o = place_q == 5'd0;
    assign m_awaddr_o = address_q[11:0];
    assign m_awvalid_o = aw_q;
    assign m_wdata_o = value_q;
    assign m_wstrb_o = 4'hF;
    assign m_wvalid_o = w_q;
    assign m_bready_o = does_q;
    assign m_araddr_o = address_q[11:0];
    assign m_arvalid_o = ar_q;
    assign m_rready_o = does_q;

endmodule

`default_nettype wire
