// SPDX-License-Identifier: MIT OR Apache-2.0
// The bytes that have left determine the next one: within a packet the next byte of its word, within an answer the next byte of
// the answer, between two of them a byte of an answer if one waits. Bytes of a packet have their highest bit clear, bytes of an
// answer have it set.
module properties (input wire clk_i, rst_i, valid, last, answer_valid, answer_last, ready, input wire [63:0] data, input wire [7:0] answer);
    `include "reset.vh"
    wire word_taken, answer_taken, byte_valid;
    wire [7:0] value;
    packet_bytes dut (
        .clk_i(clk_i), .rst_i(rst_i), .data_i(data), .valid_i(valid), .last_i(last), .ready_o(word_taken), .answer_valid_i(answer_valid),
        .answer_byte_i(answer), .answer_last_i(answer_last), .answer_ready_o(answer_taken), .valid_o(byte_valid), .byte_o(value), .ready_i(ready)
    );
    always @* assume((data & 64'h8080808080808080) == 0 && answer[7]);

    // Sources hold a word or byte until it is taken.
    reg was_word, was_answer;
    reg [64:0] word_before;
    reg [8:0] answer_before;
    always @(posedge clk_i) begin
        was_word      <= !rst_i && valid && !word_taken;
        was_answer    <= !rst_i && answer_valid && !answer_taken;
        word_before   <= {last, data};
        answer_before <= {answer_last, answer};
    end
    always @* if (started) begin
        if (was_word) assume(valid && {last, data} == word_before);
        if (was_answer) assume(answer_valid && {answer_last, answer} == answer_before);
    end

    // A model of the page, over the bytes that leave.
    reg in_packet, in_answer, was_held, was_idle, answer_waited, something_waited;
    reg [2:0] place;
    reg [7:0] held;
    wire leaves = byte_valid && ready;
    always @(posedge clk_i) begin
        if (leaves && value[7]) in_answer <= !answer_last;
        if (leaves && !value[7]) begin
            place     <= place + 1;
            in_packet <= !(last && place == 7);
        end
        was_held         <= !rst_i && byte_valid && !ready;
        held             <= value;
        was_idle         <= !rst_i && !byte_valid && !in_packet && !in_answer;
        answer_waited    <= answer_valid;
        something_waited <= answer_valid || valid;
        if (rst_i) {in_packet, in_answer, place} <= 0;
    end
    always @* if (started) begin
        if (byte_valid && value[7]) assert(!in_packet && answer_valid && value == answer);
        if (byte_valid && !value[7]) assert(!in_answer && valid && value == data[8*place+:8]);
        assert(answer_taken == (ready && answer_taken));
        if (answer_valid && answer_taken) assert(leaves && value[7]);
        if (valid && word_taken) assert(leaves && !value[7] && place == 7);
        if (leaves && value[7]) assert(answer_taken);
        if (leaves && !value[7] && place == 7) assert(word_taken);
        if (in_packet && valid) assert(byte_valid);
        if (in_answer && answer_valid) assert(byte_valid);
        if (was_held) assert(byte_valid && value == held);
        // Between two of them, a packet or answer that has waited for a clock is next, an answer first.
        if (was_idle && something_waited) assert(byte_valid);
        if (was_idle && byte_valid) assert(value[7] == answer_waited);
    end
endmodule
