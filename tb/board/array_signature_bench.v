// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives array_signature with random outputs of an array: the sum after each frame is that of docs/boards.md, computed bit by bit.
`timescale 1ns / 1ps
`default_nettype none

module array_signature_bench;

    parameter COLUMNS = 4;
    parameter ROWS = 3;
    parameter HEAD_BYTES = 3;
    parameter PIXELS = 9;
    parameter SEED = 1;
    localparam REGIONS = COLUMNS * ROWS;
    localparam HEAD_BITS = HEAD_BYTES * 8;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL array_signature_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL array_signature_bench at %0t: %0s", $realtime, what);
        end
    endtask

    reg clk = 0, rst = 1, decided = 0;
    always #5 clk = !clk;
    reg [REGIONS*HEAD_BITS-1:0] head = 0;
    reg [REGIONS-1:0] leaves = 0;
    reg [REGIONS*8-1:0] pixels = 0;
    wire [31:0] sum, frames;
    wire done;
    array_signature #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .HEAD_BYTES(HEAD_BYTES), .PIXELS(PIXELS)
    ) dut (
        .clk_i(clk), .rst_i(rst), .decided_i(decided), .head_i(head), .forward_valid_i(leaves), .forward_pixel_i(pixels),
        .sum_o(sum), .frames_o(frames), .done_o(done)
    );

    // The CRC of packets, one bit at a time.
    function [31:0] with_byte(input [31:0] crc, input [7:0] value);
        integer n;
        begin
            with_byte = crc;
            for (n = 0; n < 8; n = n + 1) with_byte = with_byte[0] ^ value[n] ? (with_byte >> 1) ^ 32'hEDB88320 : with_byte >> 1;
        end
    endfunction

    reg [31:0] crc[0:REGIONS-1], sums[0:999], total;
    integer known, seen, clocks, n, region, place, latest, at;
    always @(posedge clk)
        if (!rst) begin
            clocks = clocks + 1;
            if (done) begin
                if (seen >= known) fail("done without a frame");
                else if (sum !== sums[seen]) fail("not the sum of all frames");
                if (frames !== seen + 1) fail("not the number of frames");
                if (clocks - latest > COLUMNS + $clog2(ROWS) + 2) fail("the sum is late");
                seen = seen + 1;
            end
        end

    initial begin
        repeat (2) begin
            rst = 1;
            repeat (3) @(posedge clk);
            #1 rst = 0;
            {known, seen, clocks, total, latest} = 0;
            repeat (5) @(posedge clk);
            for (n = 0; n < 60; n = n + 1) begin
                #1;
                // A decision, and with it the last pixels of the frame before.
                for (place = 0; place < PIXELS; place = place + 1) begin
                    decided = place == 0;
                    for (region = 0; region < REGIONS * HEAD_BYTES; region = region + 1) head[region*8+:8] = $random(seed);
                    for (region = 0; region < REGIONS; region = region + 1) begin
                        leaves[region]      = n % 3 == 0 ? $random(seed) : n % 3 == 1;
                        pixels[region*8+:8] = $random(seed);
                        if (leaves[region] && (n > 0 || place > 0)) crc[region] = with_byte(crc[region], pixels[region*8+:8]);
                    end
                    if (place == 0) begin
                        if (n > 0) begin
                            for (region = 0; region < REGIONS; region = region + 1) total = total + ~crc[region];
                            sums[known] = total;
                            known       = known + 1;
                            latest      = clocks;
                        end
                        for (region = 0; region < REGIONS; region = region + 1) begin
                            crc[region] = 32'hFFFFFFFF;
                            crc[region] = with_byte(with_byte(with_byte(with_byte(crc[region], region[7:0]), region[15:8]), region[23:16]), region[31:24]);
                            for (at = 0; at < HEAD_BYTES; at = at + 1) crc[region] = with_byte(crc[region], head[region*HEAD_BITS+at*8+:8]);
                        end
                    end
                    @(posedge clk);
                    #1;
                end
            end
            decided = 0;
            repeat (COLUMNS + 20) @(posedge clk);
            if (seen != 59) fail("not all frames came");
        end
        if (errors == 0) $display("PASS array_signature_bench, %0d x %0d: %0d frames twice, sum %h", COLUMNS, ROWS, seen, sum);
        else $display("FAIL array_signature_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
