// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives clock_crossing with clocks of many rates, one of which may stand still: every word that found room comes once, in order.
`timescale 1ns / 1ps
`default_nettype none

module crossing_bench;

    parameter DEPTH_BITS = 4;
    parameter SEED = 1;
    localparam WIDTH = 10;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL crossing_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL crossing_bench at %0t: %0s", $realtime, what);
        end
    endtask
    function integer up_to(input integer top);
        up_to = $unsigned($random(seed)) % (top + 1);
    endfunction

    reg write_clk = 0, read_clk = 0, rst = 1, write = 0, take = 0, stand = 0;
    real write_half = 5.3, read_half = 5.0;
    initial forever begin
        #(write_half);
        if (!stand) begin
            write_clk = 1;
            #(write_half) write_clk = 0;
        end
    end
    initial forever #(read_half) read_clk = !read_clk;
    reg [WIDTH-1:0] data = 0;
    wire full, valid;
    wire [WIDTH-1:0] found;
    clock_crossing #(.WIDTH(WIDTH), .DEPTH_BITS(DEPTH_BITS)) dut (
        .write_clk_i(write_clk), .write_i(write), .data_i(data), .full_o(full), .read_clk_i(read_clk), .rst_i(rst), .valid_o(valid),
        .data_o(found), .take_i(take)
    );

    reg [WIDTH-1:0] words[0:262143];
    integer in = 0, out = 0, writes = 50, takes = 50, fulls = 0, empties = 0, most = 0;
    reg blind = 1;
    always @(posedge write_clk) begin
        if (write && !full) begin
            words[in] = data;
            in        = in + 1;
            if (in - out > most && !blind) most = in - out;
            if (in - out > (1 << DEPTH_BITS) && !blind) fail("more words than there is room for");
        end
        if (write && full) fulls = fulls + 1;
        write <= #0.1 up_to(99) < writes;
        data  <= #0.1 $random(seed);
    end
    reg held = 0;
    reg [WIDTH-1:0] held_word;
    always @(posedge read_clk) begin
        if (held && !(valid && found === held_word) && !rst) fail("a word that waits changes");
        held      <= valid && !take && !rst;
        held_word <= found;
        if (valid && take && !rst && !blind) begin
            if (out == in) fail("a word that was not written");
            else if (found !== words[out]) fail("not the word that was written");
            out = out + 1;
        end
        if (take && !valid) empties = empties + 1;
        take <= #0.1 up_to(99) < takes;
    end

    integer n, first;
    initial begin
        repeat (3) @(posedge read_clk);
        #1 rst = 0;
        stand = 0;
        blind = 0;
        for (n = 0; n < 60; n = n + 1) begin
            write_half = n % 4 == 0 ? 5.0 + 0.001 * n : 1.0 + up_to(300) / 20.0;
            read_half  = n % 4 == 0 ? 5.0 : 1.0 + up_to(300) / 20.0;
            writes     = n % 3 == 0 ? 100 : up_to(100);
            takes      = n % 3 == 1 ? 100 : up_to(100);
            #6000;
        end
        // A word for every clock.
        write_half = 5.004; read_half = 5.0; writes = 100; takes = 100;
        #1000 fulls = 0;
        first = out;
        #50000 if (fulls != 0 && DEPTH_BITS > 2) fail("full, though words are taken as fast as they come");
        if (out - first < 4990 && DEPTH_BITS > 2) fail("not a word for every clock");
        // The write clock stands still, and the waiting words come.
        stand = 1;
        #1000 if (out != in || valid) fail("words did not come while the other clock stands still");
        // A reset with a full queue: no word written before it comes.
        for (n = 0; n < 20; n = n + 1) begin
            stand = 0; writes = 100; takes = 0;
            #(400 * read_half) stand = 1;
            #100 if (in - out != 1 << DEPTH_BITS) fail("the queue is not full");
            @(posedge read_clk) #0.2 rst = 1;
            repeat (1 + up_to(3)) @(posedge read_clk);
            #0.2 rst = 0;
            takes = 100;
            #1000 if (valid) fail("a word of before a reset");
            out    = in;
            stand  = 0;
            writes = up_to(100);
            #2000;
            read_half = 2.0 + up_to(100) / 10.0;
        end
        if (most < (1 << DEPTH_BITS) || empties == 0) fail("never full, or never empty");
        if (errors == 0) $display("PASS crossing_bench, %0d words: %0d words", 1 << DEPTH_BITS, out);
        else $display("FAIL crossing_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
