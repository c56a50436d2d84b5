// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares pattern_source with the function of docs/boards.md, with a sink that stalls and with one that never does.
`timescale 1ns / 1ps
`default_nettype none

module pattern_bench;

    parameter LANES = 4;
    parameter WIDTH = 8;
    parameter WORDS = 40;
    parameter LINES = 133;
    parameter FRAMES = 4;
    parameter SEED = 1;
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL pattern_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL pattern_bench at %0t: %0s", $realtime, what);
        end
    endtask

    reg clk = 0, rst = 1, ready = 0;
    always #5 clk = !clk;
    wire valid, sof, eol;
    wire [LANES*WIDTH-1:0] pixels;
    wire [31:0] number;
    pattern_source #(
        .WORDS(WORDS), .LINES(LINES), .LANES(LANES), .WIDTH(WIDTH), .WORD_BITS($clog2(WORDS)), .LINE_BITS($clog2(LINES))
    ) dut (
        .clk_i(clk), .rst_i(rst), .valid_o(valid), .pixel_o(pixels), .sof_o(sof), .eol_o(eol), .ready_i(ready), .frame_o(number)
    );

    integer squares = 0, textures = 0, gradients = 0;
    function integer scene(input integer x, input integer y, input integer t);
        integer mix, noise, ramp, value;
        begin
            mix   = (5 * x + 19 * y) & 255;
            noise = mix ^ (mix >> 3) ^ (x & y & 255);
            ramp  = ((x + 2 * y) & 511) >> 2;
            if (((x - 3 * t) & 127) < 16 && ((y - t) & 127) < 16) begin
                value   = 224 | (noise & 31);
                squares = squares + 1;
            end else if ((((x >> 6) ^ (y >> 6)) & 3) == 3) begin
                value    = (ramp >> 1) + (noise & 63);
                textures = textures + 1;
            end else begin
                value     = ramp;
                gradients = gradients + 1;
            end
            scene = (value << 8) >> (16 - WIDTH);
        end
    endfunction

    integer x, y, t, lane, words, stalls, wanted;
    reg held = 0;
    reg [LANES*WIDTH+33:0] held_word;
    always @(posedge clk) begin
        if (rst) begin
            {x, y, t, words} = 0;
            held <= 0;
        end else begin
            if (held && !(valid && {pixels, sof, eol, number} === held_word)) fail("a word that waits changes");
            held      <= valid && !ready;
            held_word <= {pixels, sof, eol, number};
            if (words > 0 && !valid) fail("a bubble");
            if (valid && ready) begin
                for (lane = 0; lane < LANES; lane = lane + 1) begin
                    wanted = scene(x + lane, y, t);
                    if (pixels[lane*WIDTH+:WIDTH] !== wanted[WIDTH-1:0]) begin
                        fail("not the pixel of the scene");
                        if (errors < 9) $display("  x %0d, y %0d, t %0d: %0d, not %0d", x + lane, y, t, pixels[lane*WIDTH+:WIDTH], wanted);
                    end
                end
                if (sof !== (x == 0 && y == 0)) fail("SOF");
                if (eol !== (x == (WORDS - 1) * LANES)) fail("EOL");
                if (number !== t) fail("number of the frame");
                words = words + 1;
                x     = x + LANES;
                if (x == WORDS * LANES) begin
                    x = 0;
                    y = y + 1;
                end
                if (y == LINES) begin
                    y = 0;
                    t = t + 1;
                end
            end
        end
        ready <= #1 $unsigned($random(seed)) % 100 >= stalls;
    end
    initial begin
        stalls = 30;
        repeat (4) @(posedge clk);
        #1 rst = 0;
        repeat (3000) @(posedge clk);
        // A word is offered whether it is taken or not.
        stalls = 100;
        #1 rst = 1;
        repeat (3) @(posedge clk);
        #1 rst = 0;
        repeat (10) @(posedge clk);
        if (!valid) fail("no word behind a reset");
        stalls = 0;
        while (t < FRAMES) @(posedge clk);
        if (squares == 0 || gradients == 0 || (textures == 0 && WORDS * LANES > 128)) fail("a part of the scene was not seen");
        if (errors == 0) $display("PASS pattern_bench, %0d pixels of %0d bits at a clock: %0d words", LANES, WIDTH, words);
        else $display("FAIL pattern_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
