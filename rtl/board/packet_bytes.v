// SPDX-License-Identifier: MIT OR Apache-2.0
// Words of packets become bytes, the lowest first (docs/packets.md). Answers, which are bytes already, pass between two packets.
//
// A word is not kept: its source holds it until it is taken with its last byte. What passes is chosen at a clock of its own,
// before the first byte of each packet.
`default_nettype none

module packet_bytes (
    input  wire        clk_i,           // clock, rising edge
    input  wire        rst_i,           // synchronous reset, active high
    input  wire [63:0] data_i,          // a word of a packet
    input  wire        valid_i,         // it is there, and stays until it is taken
    input  wire        last_i,          // it is the last of its packet
    output wire        ready_o,         // it is taken
    input  wire        answer_valid_i,  // a byte of an answer is there, and stays until it is taken
    input  wire [ 7:0] answer_byte_i,   // that byte
    input  wire        answer_last_i,   // it is the last of its answer
    output wire        answer_ready_o,  // it is taken
    output wire        valid_o,         // a byte
    output wire [ 7:0] byte_o,          // that byte
    input  wire        ready_i          // it is taken
);

    reg packet_q, answer_q;  // one of them passes
    reg [2:0] place_q;       // of the byte in the word
    wire word_ends = place_q == 3'd7;

    assign valid_o = (packet_q && valid_i) || (answer_q && answer_valid_i);
    assign byte_o = answer_q ? answer_byte_i : data_i[{place_q, 3'd0}+:8];
    assign ready_o = packet_q && ready_i && word_ends;
    assign answer_ready_o = answer_q && ready_i;

    always @(posedge clk_i) begin
        if (packet_q && valid_i && ready_i) place_q <= place_q + 1'b1;
        if (packet_q) packet_q <= !(valid_i && ready_o && last_i);
        else if (answer_q) answer_q <= !(answer_valid_i && ready_i && answer_last_i);
        else begin
            answer_q <= answer_valid_i;
            packet_q <= valid_i && !answer_valid_i;
        end
        if (rst_i) begin
            packet_q <= 1'b0;
            answer_q <= 1'b0;
            place_q  <= 3'd0;
        end
    end

endmodule

`default_nettype wire
