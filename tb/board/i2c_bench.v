// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives i2c_setup with a sensor on an open-drain bus. The expected transfers are written from docs/boards.md: three tries of a
// step that is not acknowledged, pauses, then `done`. A monitor checks the rules and the times of the bus.
`timescale 1ns / 1ps
`default_nettype none

module i2c_bench;

    parameter ADDRESS_BYTES = 2;
    parameter QUARTER = 5;
    parameter PAUSE = 70;
    parameter REGISTERED = 1;  // 1: the memory of steps shows a step one clock later
    parameter SEED = 1;
    localparam STEPS = 24, STEP_BITS = 5;
    localparam [6:0] DEVICE = 7'h5A;
    localparam BYTES = ADDRESS_BYTES + 2;
    localparam CLOCK = 10;

    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL i2c_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL i2c_bench at %0t: %0s", $realtime, what);
        end
    endtask

    reg clk = 0, rst = 1;
    always #(CLOCK / 2) clk = !clk;

    // The steps: the values to write, and which byte is not acknowledged how often.
    reg [8*ADDRESS_BYTES+8:0] steps[0:STEPS-1];
    integer refusals[0:STEPS-1], refused_byte[0:STEPS-1];
    wire [STEP_BITS-1:0] step;
    reg [8*ADDRESS_BYTES+8:0] word_q;
    always @(posedge clk) word_q <= steps[step];
    wire [8*ADDRESS_BYTES+8:0] word = REGISTERED ? word_q : steps[step];

    wire scl_low, sda_low, done, failed;
    reg sensor_low = 0;
    // A pull-up is slow, so a line rises late. It falls at once.
    localparam RISE = CLOCK * QUARTER / 3;
    wire scl_drive = !scl_low, sda_drive = !(sda_low || sensor_low);
    reg scl = 1, sda = 1;
    always @(scl_drive) if (scl_drive) scl <= #(RISE) 1; else scl <= 0;
    always @(sda_drive) if (sda_drive) sda <= #(RISE) 1; else sda <= 0;
    i2c_setup #(
        .DEVICE(DEVICE), .ADDRESS_BYTES(ADDRESS_BYTES), .STEPS(STEPS), .STEP_BITS(STEP_BITS), .QUARTER(QUARTER), .PAUSE(PAUSE)
    ) dut (
        .clk_i(clk), .rst_i(rst), .step_o(step), .word_i(word), .scl_low_o(scl_low), .sda_low_o(sda_low), .sda_i(sda), .done_o(done),
        .failed_o(failed)
    );

    // The expected transfers: their bytes, the number of bytes, whether the last one is refused, and the pause before.
    localparam MOST = 3 * STEPS;
    reg [31:0] transfer[0:MOST-1];  // the first byte is the highest
    integer lengths[0:MOST-1], pauses[0:MOST-1], of_step[0:MOST-1];
    reg refuses[0:MOST-1];
    integer transfers = 0, last_pause = 0;
    reg fails;
    task expect_all;
        integer s, tries, pause;
        reg [31:0] bytes;
        begin
            transfers = 0;
            pause     = 0;
            fails     = 0;
            for (s = 0; s < STEPS; s = s + 1) begin
                if (steps[s][8*ADDRESS_BYTES+8]) pause = pause + steps[s][7:0];
                else begin
                    bytes = {DEVICE, 1'b0, steps[s][8*ADDRESS_BYTES+7:0]} << (ADDRESS_BYTES == 1 ? 8 : 0);
                    for (tries = 0; tries < 3 && tries <= refusals[s]; tries = tries + 1) begin
                        transfer[transfers] = bytes;
                        refuses[transfers]  = tries < refusals[s];
                        lengths[transfers]  = tries < refusals[s] ? refused_byte[s] + 1 : BYTES;
                        pauses[transfers]   = pause;
                        of_step[transfers]  = s;
                        transfers           = transfers + 1;
                        pause               = 0;
                    end
                    if (refusals[s] >= 3) fails = 1;
                end
            end
            last_pause = pause;
        end
    endtask

    // The sensor, and the monitor of the bus.
    integer number = 0, bit_number = 0, byte_number = 0;
    reg talks = 0, watch = 0;
    reg [7:0] shift;
    realtime scl_rose, scl_fell, sda_changed, stopped, quarter;
    initial begin
        quarter     = QUARTER * CLOCK;
        scl_rose    = 0;
        scl_fell    = 0;
        sda_changed = 0;
        stopped     = 0;
    end
    realtime gap;
    always @(sda) if (watch) begin
        if (scl !== 0) begin
            if (!sda && !talks) begin
                gap = $realtime - stopped;
                if (number == transfers) fail("a transfer too many");
                if (gap < 2 * quarter - RISE) fail("the bus rests too short before a start");
                if (gap < pauses[number] * PAUSE * CLOCK) fail("a pause is too short");
                // Each step has some quarters for the lines to rest.
                if (gap > pauses[number] * PAUSE * CLOCK + 24 * quarter) fail("a pause is too long");
                if ($realtime - scl_rose < 2 * quarter - RISE) fail("scl was not 1 for long enough before a start");
                talks      = 1;
                bit_number  = 0;
                byte_number = 0;
            end else if (sda && talks) begin
                if ($realtime - scl_rose < quarter) fail("scl was not 1 for long enough before a stop");
                if (bit_number != 0 && bit_number != 1) fail("a stop within a byte");
                if (byte_number != lengths[number]) fail("a stop before all bytes, or too late");
                talks  = 0;
                number  = number + 1;
                stopped = $realtime;
            end else fail("sda changes while scl is 1");
        end else if (!sensor_low && $realtime - scl_fell < quarter - CLOCK && $realtime - scl_fell > RISE + 1 && !released_now)
            fail("sda changes just after scl fell");
        sda_changed = $realtime;
    end
    reg released_now = 0;
    always @(posedge scl) if (watch) begin
        if (talks && $realtime - scl_fell < 2 * quarter) fail("scl is 0 too short");
        if (talks && $realtime - sda_changed < quarter - CLOCK && !released_now) fail("sda is not still before scl rises");
        scl_rose = $realtime;
        if (talks) begin
            if (bit_number < 8) shift = {shift[6:0], sda};
            bit_number = bit_number + 1;
        end else fail("scl rises while nothing is said");
    end
    always @(negedge scl) if (watch) begin
        if (scl_rose != 0 && talks && $realtime - scl_rose < 2 * quarter - RISE - 1) fail("scl is 1 too short");
        if (!talks) fail("scl falls while nothing is said");
        scl_fell     = $realtime;
        released_now = 1;
        #(CLOCK) sensor_low = 0;
        if (talks && bit_number == 8) begin
            if (byte_number >= lengths[number]) fail("a byte too many");
            else if (shift !== transfer[number][31-8*byte_number-:8]) begin
                fail("not the byte that should come");
                if (errors < 20) $display("  step %0d, byte %0d: %h, not %h", of_step[number], byte_number, shift, transfer[number][31-8*byte_number-:8]);
            end
            sensor_low = !(refuses[number] && byte_number == lengths[number] - 1);
        end
        if (talks && bit_number == 9) begin
            bit_number  = 0;
            byte_number = byte_number + 1;
        end
        #(RISE + 1) released_now = 0;
    end

    task reset;
        begin
            watch      = 0;
            rst        = 1;
            sensor_low = 0;
            repeat (QUARTER) @(posedge clk);
            #1 number = 0;
            talks   = 0;
            scl_rose = 0;
            stopped  = $realtime;
            rst      = 0;
            watch    = 1;
            expect_all;
        end
    endtask
    task finish_run;
        realtime last;
        begin
            while (!done) @(posedge clk);
            if (number != transfers || talks) fail("done before all transfers");
            if (failed !== fails) fail("failed");
            if ($realtime - stopped < last_pause * PAUSE * CLOCK) fail("done before the last pause has gone");
            repeat (50 * QUARTER) @(posedge clk);
            if (!done || failed !== fails || number != transfers || scl !== 1 || sda !== 1) fail("something goes on behind done");
        end
    endtask

    integer i, run, total = 0;
    initial begin
        for (run = 0; run < 6; run = run + 1) begin
            for (i = 0; i < STEPS; i = i + 1) begin
                steps[i] = {$random(seed), $random(seed)};
                steps[i][8*ADDRESS_BYTES+8] = 0;
                refusals[i]     = 0;
                refused_byte[i] = 0;
                // Every kind of pause and of refusal. The last run ends with a pause, other runs with a write.
                if (i % 5 == 2) begin
                    steps[i][8*ADDRESS_BYTES+8] = 1;
                    steps[i][7:0] = run == 0 && i == 2 ? 255 : i == 7 ? 0 : i == 12 ? 1 : $unsigned($random(seed)) % 9;
                end else if (run > 0) begin
                    refusals[i]     = $unsigned($random(seed)) % (run == 1 ? 3 : 5);
                    refused_byte[i] = $unsigned($random(seed)) % BYTES;
                end
            end
            if (run == 5) steps[STEPS-1] = {1'b1, {8 * ADDRESS_BYTES{1'b1}}, 8'd7};
            reset;
            if (run == 3) begin
                // After a reset in the middle, the set-up begins again with the first step.
                while (number < 3 || bit_number != 5) @(posedge clk);
                if (done) fail("done while it goes on");
                reset;
            end
            if (run == 4) begin
                while (!failed) @(posedge clk);
                reset;
                if (failed) fail("failed behind a reset");
            end
            finish_run;
            total = total + transfers;
            if (run < 2 && failed) fail("failed without a step that was refused three times");
            if (run == 2 && !failed) fail("no failure, so nothing is shown");
        end
        if (errors == 0) $display("PASS i2c_bench, %0d bytes of address, quarters of %0d clocks: %0d transfers", ADDRESS_BYTES, QUARTER, total);
        else $display("FAIL i2c_bench: %0d errors", errors);
        $finish;
    end
    initial begin
        #200000000 $display("FAIL i2c_bench: does not end");
        $finish;
    end

endmodule

`default_nettype wire
