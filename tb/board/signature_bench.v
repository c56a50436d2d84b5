// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives packet_signature with a stalling stream of packets of all types: the sum at each END is that of the packets before it.
`timescale 1ns / 1ps
`default_nettype none

module signature_bench;

    parameter SEED = 1;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL signature_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL signature_bench at %0t: %0s", $realtime, what);
        end
    endtask

    reg clk = 0, rst = 1, valid = 0, last = 0, ready = 0;
    always #5 clk = !clk;
    reg [63:0] data = 0;
    wire [31:0] sum, frames;
    wire done;
    packet_signature dut (
        .clk_i(clk), .rst_i(rst), .data_i(data), .valid_i(valid), .last_i(last), .ready_i(ready), .sum_o(sum), .frames_o(frames), .done_o(done)
    );

    reg [31:0] sums[0:999];
    reg [31:0] total;
    integer ends, seen, n, words, w, kind, stalls;
    always @(posedge clk) begin
        if (done && !rst) begin
            if (seen >= ends) fail("done without an END");
            else if (sum !== sums[seen]) fail("not the sum of what has passed");
            if (frames !== seen + 1) fail("not the number of frames");
            seen = seen + 1;
        end
        ready <= #1 $unsigned($random(seed)) % 100 >= stalls;
    end
    initial begin
        for (stalls = 0; stalls < 60; stalls = stalls + 30) begin
            rst = 1;
            repeat (3) @(posedge clk);
            #1 rst   = 0;
            total = 0;
            ends  = 0;
            seen  = 0;
            for (n = 0; n < 600; n = n + 1) begin
                kind  = n % 3 == 0 ? 5 : 1 + $unsigned($random(seed)) % 6;
                words = 2 + $unsigned($random(seed)) % 4;
                for (w = 0; w < words; w = w + 1) begin
                    data  = {$random(seed), $random(seed)};
                    if (w == 0) data[11:8] = kind;
                    last  = w == words - 1;
                    valid = 1;
                    @(posedge clk);
                    while (!ready) @(posedge clk);
                    if (last && (kind == 2 || kind == 4 || kind == 5)) total = total + data[63:32];
                    if (last && kind == 5) begin
                        sums[ends] = total;
                        ends       = ends + 1;
                    end
                    #1;
                    if (stalls > 0 && $unsigned($random(seed)) % 3 == 0) begin
                        valid = 0;
                        data  = {$random(seed), $random(seed)};
                        last  = $random(seed);
                        repeat (1 + $unsigned($random(seed)) % 3) @(posedge clk);
                        #1;
                    end
                end
            end
            valid = 0;
            repeat (10) @(posedge clk);
            if (seen != ends || sum !== total) fail("not the sum of all");
        end
        if (errors == 0) $display("PASS signature_bench: %0d frames twice, sum %h", ends, sum);
        else $display("FAIL signature_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
