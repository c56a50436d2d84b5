// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives packet_bytes with sources and a sink that stall: every packet and every answer comes whole, in order, and not inside another.
`timescale 1ns / 1ps
`default_nettype none

module bytes_bench;

    parameter SEED = 1;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL bytes_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL bytes_bench at %0t: %0s", $realtime, what);
        end
    endtask
    function integer up_to(input integer top);
        up_to = $unsigned($random(seed)) % (top + 1);
    endfunction

    reg clk = 0, rst = 1;
    always #5 clk = !clk;
    reg [63:0] data = 0;
    reg valid = 0, last = 0, answer_valid = 0, answer_last = 0, ready = 0;
    reg [7:0] answer = 0;
    wire word_ready, answer_ready, byte_valid;
    wire [7:0] given;
    packet_bytes dut (
        .clk_i(clk), .rst_i(rst), .data_i(data), .valid_i(valid), .last_i(last), .ready_o(word_ready), .answer_valid_i(answer_valid),
        .answer_byte_i(answer), .answer_last_i(answer_last), .answer_ready_o(answer_ready), .valid_o(byte_valid), .byte_o(given),
        .ready_i(ready)
    );

    // Bytes of a packet are 0xxxxxxx, those of an answer 1xxxxxxx, so that the sink can tell them apart.
    reg [8:0] words[0:65535], answers[0:65535];  // {last, byte}
    integer words_in = 0, words_out = 0, answers_in = 0, answers_out = 0, packets = 0, replies = 0, pace, n, k;
    localparam COUNT = 300;
    initial begin : source
        integer w;
        repeat (3) @(posedge clk);
        #1 rst = 0;
        for (packets = 0; packets < COUNT; packets = packets + 1) begin
            n = 1 + up_to(6);
            for (w = 0; w < n; w = w + 1) begin
                if (up_to(2) == 0) repeat (up_to(20)) @(posedge clk);
                #1 data = {$random(seed), $random(seed)} & 64'h7F7F7F7F7F7F7F7F;
                last  = w == n - 1;
                valid = 1;
                for (k = 0; k < 8; k = k + 1) begin
                    words[words_in] = {last && k == 7, data[8*k+:8]};
                    words_in        = words_in + 1;
                end
                @(posedge clk);
                while (!word_ready) @(posedge clk);
                #1 valid = 0;
            end
        end
    end
    initial begin : answering
        integer a, m;
        #100;
        for (replies = 0; replies < COUNT; replies = replies + 1) begin
            repeat (up_to(300)) @(posedge clk);
            m = 1 + up_to(5);
            for (a = 0; a < m; a = a + 1) begin
                if (up_to(1) == 0) repeat (up_to(9)) @(posedge clk);
                #1 answer = $random(seed) | 8'h80;
                answer_last  = a == m - 1;
                answer_valid = 1;
                answers[answers_in] = {answer_last, answer};
                answers_in          = answers_in + 1;
                @(posedge clk);
                while (!answer_ready) @(posedge clk);
                #1 answer_valid = 0;
            end
        end
    end

    // The sink.
    always @(posedge clk) ready <= #1 up_to(pace) == 0;
    initial begin
        pace = 0;
        forever begin
            #20000 pace = up_to(3);
        end
    end
    reg in_packet = 0, in_answer = 0, held = 0, waited = 0;
    reg [7:0] held_byte;
    integer passed_by = 0;
    always @(posedge clk) if (!rst) begin
        if (held && !(byte_valid && given === held_byte)) fail("a byte that waits changes");
        held      <= byte_valid && !ready;
        held_byte <= given;
        if (byte_valid && ready) begin
            if (given[7]) begin
                if (in_packet) fail("an answer within a packet");
                if (answers_out == answers_in || given !== answers[answers_out][7:0]) fail("not the byte of the answer");
                in_answer   = !answers[answers_out][8];
                answers_out = answers_out + 1;
                waited      = 0;
            end else begin
                if (in_answer) fail("a packet within an answer");
                if (words_out == words_in || given !== words[words_out][7:0]) fail("not the byte of the word");
                if (!in_packet && waited) passed_by = passed_by + 1;
                in_packet = !words[words_out][8];
                // An answer or packet that waits when a packet ends goes first.
                if (!in_packet) waited = answer_valid;
                words_out = words_out + 1;
            end
        end
    end
    initial begin
        wait (packets == COUNT && replies == COUNT);
        #3000;
        if (words_out != words_in || answers_out != answers_in) fail("bytes did not come");
        if (passed_by != 0) fail("a packet passed an answer that waited");
        if (errors == 0) $display("PASS bytes_bench: %0d bytes of packets, %0d of answers", words_out, answers_out);
        else $display("FAIL bytes_bench: %0d errors", errors);
        $finish;
    end
    initial begin
        #20000000 $display("FAIL bytes_bench: does not end");
        $finish;
    end

endmodule

`default_nettype wire
