// SPDX-License-Identifier: MIT OR Apache-2.0
// Turns the words of packets into bytes, the lowest first (docs/packets.md). Answers, which are bytes already, are sent between
// two packets.
//
// A word is not stored: its source holds it until it is taken with its last byte. One clock before the first byte of each
// packet or answer selects what is sent.
`default_nettype none

module packet_bytes (
    input  wire        clk_i,           // clock, rising edge
    input  wire        rst_i,           // synchronous reset, active high
    input  wire [63:0] data_i,          // a word of a packet
    input  wire        valid_i,         // a word of a packet is on data_i, until it is taken
    input  wire        last_i,          // the word is the last of its packet
    output wire        ready_o,         // the word is taken
    input  wire        answer_valid_i,  // a byte of an answer is on answer_byte_i, until it is taken
    input  wire [ 7:0] answer_byte_i,   // the byte of the answer
    input  wire        answer_last_i,   // the byte is the last of its answer
    output wire        answer_ready_o,  // the byte of the answer is taken
    output wire        valid_o,         // a byte is on byte_o
    output wire [ 7:0] byte_o,          // the byte that is sent
    input  wire        ready_i          // the sink takes the byte
);

    reg packet_q, answer_q;  // a packet is sent; an answer is sent
    reg [2:0] place_q;       // number of the byte in the word
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
