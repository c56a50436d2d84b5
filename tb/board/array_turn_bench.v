// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives array_turn with frames that follow each other: a frame takes over thresholds only when those of earlier frames have
// taken effect, and each threshold changes at its own clock after the frame's first pixel (docs/boards.md).
`timescale 1ns / 1ps
`default_nettype none

module array_turn_bench;

    parameter LEVEL_AT = 20;
    parameter TEMPORAL_AT = 22;
    parameter MINIMUM_AT = 23;
    parameter PIXELS = 16;
    parameter SEED = 1;
    integer errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL array_turn_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL array_turn_bench at %0t: %0s", $realtime, what);
        end
    endtask

    reg clk = 0, rst = 1, soon = 0;
    always #5 clk = !clk;
    wire taken, level, temporal, minimum;
    array_turn #(
        .LEVEL_AT(LEVEL_AT), .TEMPORAL_AT(TEMPORAL_AT), .MINIMUM_AT(MINIMUM_AT), .COUNT_BITS($clog2(MINIMUM_AT + 1))
    ) dut (
        .clk_i(clk), .rst_i(rst), .soon_i(soon), .begin_o(taken), .level_o(level), .temporal_o(temporal), .minimum_o(minimum)
    );

    // Clock 0 is that of the first pixel of the frame that has taken over. soon_i announces it two clocks before.
    integer at, clock, turns, busy;
    initial begin
        {at, turns, busy, clock} = 0;
        repeat (3) @(posedge clk);
        #1 rst = 0;
        for (clock = 0; clock < 40 * PIXELS; clock = clock + 1) begin
            soon = clock % PIXELS == 0;
            if (clock == 20 * PIXELS + 5) rst = 1;
            if (clock == 20 * PIXELS + 6) rst = 0;
            #1;
            if (taken !== (soon && !busy)) fail("a frame takes over while one does, or none where one may");
            if (level !== (busy && at == LEVEL_AT - 1)) fail("levels turn at another clock");
            if (temporal !== (busy && at == TEMPORAL_AT - 1)) fail("the temporal level turns at another clock");
            if (minimum !== (busy && at == MINIMUM_AT - 1)) fail("minima turn at another clock");
            at = at + 1;
            if (busy && at == MINIMUM_AT) busy = 0;
            if (taken) begin
                at    = -1;
                busy  = 1;
                turns = turns + 1;
            end
            if (rst) busy = 0;
            @(posedge clk);
            #1;
        end
        if (turns < 20) fail("few frames took over");
        if (errors == 0) $display("PASS array_turn_bench: %0d turns", turns);
        else $display("FAIL array_turn_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
