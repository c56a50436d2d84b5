// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares uart_sender and uart_receiver with a line that is written from its definition: a start bit, 8 bits, a stop bit.
`timescale 1ns / 1ps
`default_nettype none

module uart_bench;

    parameter DIVISOR = 4;
    parameter SEED = 1;
    localparam CLOCK = 10;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL uart_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL uart_bench at %0t: %0s", $realtime, what);
        end
    endtask
    function integer up_to(input integer top);
        up_to = $unsigned($random(seed)) % (top + 1);
    endfunction

    reg clk = 0, rst = 1;
    always #(CLOCK / 2) clk = !clk;

    reg send = 0;
    reg [7:0] given = 0;
    wire ready, tx;
    uart_sender #(.DIVISOR(DIVISOR)) sender (.clk_i(clk), .rst_i(rst), .valid_i(send), .byte_i(given), .ready_o(ready), .tx_o(tx));

    // The line of the sender, clock by clock. The expected line is a list of levels.
    reg [9:0] frame;
    integer left = 0, sent = 0, gaps = 0;  // clocks left of the byte
    reg started = 0;
    always @(negedge clk) if (started) begin
        if (left > 0) begin
            if (tx !== frame[(10*DIVISOR-left)/DIVISOR]) fail("not the level that the line should have");
            left = left - 1;
        end else if (tx !== 1) fail("the line does not rest at 1");
        if (ready !== (left == 0)) fail("ready is not where a byte has been sent");
    end
    always @(posedge clk) if (started && send && ready) begin
        frame = {1'b1, given, 1'b0};
        left  = 10 * DIVISOR;
        sent  = sent + 1;
    end
    initial begin
        #1 if (tx !== 1) fail("the line is not 1 before the first clock");
        repeat (3) @(posedge clk);
        #1 rst = 0;
        started = 1;
        repeat (200) begin
            given = $random(seed);
            send  = 1;
            @(posedge clk);
            while (!ready) @(posedge clk);
            #1;
            // Most bytes follow without a pause.
            if (up_to(3) == 0) begin
                send = 0;
                repeat (up_to(3 * DIVISOR)) @(posedge clk);
                #1;
            end
        end
        send = 0;
        if (sent != 200) fail("bytes were not sent");
    end

    // The line of the receiver. Its bits are longer or shorter than they should be, and begin at any time.
    reg line = 1;
    wire valid;
    wire [7:0] got;
    uart_receiver #(.DIVISOR(DIVISOR)) receiver (.clk_i(clk), .rst_i(rst), .rx_i(line), .valid_o(valid), .byte_o(got));
    reg [7:0] expected[0:4095];
    integer expects = 0, at = 0;
    always @(posedge clk) if (valid) begin
        if (at == expects) fail("a byte that was not sent");
        else if (got !== expected[at]) fail("not the byte that was sent");
        at = at + 1;
    end
    realtime each;
    task put(input [7:0] value, input stop);
        integer i;
        begin
            if (stop) begin
                expected[expects] = value;
                expects           = expects + 1;
            end
            line = 0;
            #(each);
            for (i = 0; i < 8; i = i + 1) begin
                line = value[i];
                #(each);
            end
            line = stop;
            #(each);
        end
    endtask
    integer n, percent;
    initial begin
        line = 0;  // this 0 is not a start bit, because it is there at a reset
        #200 line = 1;
        #(20 * DIVISOR * CLOCK);
        for (percent = -15; percent <= 15; percent = percent + 5) begin
            each = DIVISOR * CLOCK * (1000.0 + percent) / 1000.0;
            for (n = 0; n < 60; n = n + 1) begin
                put($random(seed), 1);
                if (up_to(2) == 0) #(up_to(40 * CLOCK * DIVISOR) / 3.0);
            end
            #(each);
            if (at != expects) fail("a byte did not come");
        end
        each = DIVISOR * CLOCK;
        for (n = 0; n < 20; n = n + 1) begin
            // A byte without its stop bit is left out, and so is a line that stays at 0.
            put($random(seed), 0);
            #(each * up_to(30)) line = 1;
            #(each * 2);
            put(8'h00, 0);
            line = 1;
            #(each * 2);
            put($random(seed), 1);
            #(each);
            if (at != expects) fail("a byte did not come behind one without a stop bit");
            // A line that is 0 for less than half a bit is not a start bit.
            line = 0;
            #(DIVISOR > 7 ? each / 4 : CLOCK / 2) line = 1;
            // The byte after it is sampled in the middle of its own bits.
            #(DIVISOR > 7 ? each * (100 + up_to(100)) / 100.0 : each * 12);
            each = DIVISOR * CLOCK * 0.985;
            if (DIVISOR > 7) put($random(seed), 1);
            each = DIVISOR * CLOCK;
            #(each * 2);
            if (at != expects && DIVISOR > 7) fail("a byte did not come behind a pulse");
        end
        wait (sent == 200);
        #(20 * DIVISOR * CLOCK);
        if (errors == 0) $display("PASS uart_bench, %0d clocks of a bit: %0d bytes sent, %0d received", DIVISOR, sent, at);
        else $display("FAIL uart_bench: %0d errors", errors);
        $finish;
    end
    initial begin
        #500000000 $display("FAIL uart_bench: does not end");
        $finish;
    end

endmodule

`default_nettype wire
