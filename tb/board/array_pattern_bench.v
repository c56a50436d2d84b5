// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares array_pattern with the function of docs/boards.md: every region at each clock, without a gap, also after a reset.
`timescale 1ns / 1ps
`default_nettype none

module array_pattern_bench;

    parameter COLUMNS = 5;
    parameter ROWS = 4;
    parameter SIDE = 8;
    parameter FRAMES = 140;
    parameter SEED = 1;
    localparam REGIONS = COLUMNS * ROWS;
    integer errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL array_pattern_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL array_pattern_bench at %0t: %0s", $realtime, what);
        end
    endtask

    reg clk = 0, rst = 1;
    always #5 clk = !clk;
    wire valid, soon;
    wire [REGIONS*8-1:0] pixels;
    array_pattern #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .SIDE(SIDE), .SIDE_BITS($clog2(SIDE))
    ) dut (
        .clk_i(clk), .rst_i(rst), .valid_o(valid), .pixel_o(pixels), .soon_o(soon)
    );

    integer squares = 0, textures = 0, gradients = 0;
    function integer scene(input integer x, input integer y, input integer t);
        integer mix, noise, ramp;
        begin
            mix   = (5 * x + 19 * y) & 255;
            noise = mix ^ (mix >> 3) ^ (x & y & 255);
            ramp  = ((x + 2 * y) & 511) >> 2;
            if (((x - 3 * t) & 127) < 16 && ((y - t) & 127) < 16) begin
                scene   = 224 | (noise & 31);
                squares = squares + 1;
            end else if ((((x >> 6) ^ (y >> 6)) & 3) == 3) begin
                scene    = (ramp >> 1) + (noise & 63);
                textures = textures + 1;
            end else begin
                scene     = ramp;
                gradients = gradients + 1;
            end
        end
    endfunction

    // Clocks since reset: pixels are there from the third clock on.
    integer since, u, v, t, region, wanted;
    reg soon_first, soon_second;
    always @(posedge clk) begin
        if (rst) begin
            {since, u, v, t} = 0;
            {soon_first, soon_second} = 2'd0;
        end else begin
            if (valid !== (since > 2)) fail("no pixel where one must be, or one too early");
            if (valid) begin
                if (soon_second !== (u == 0 && v == 0)) fail("the start of a frame is not announced two clocks before");
                for (region = 0; region < REGIONS; region = region + 1) begin
                    wanted = scene(region % COLUMNS * SIDE + u, region / COLUMNS * SIDE + v, t);
                    if (pixels[region*8+:8] !== wanted[7:0]) begin
                        fail("not the pixel of the scene");
                        if (errors < 9) $display("  region %0d, %0d, %0d, t %0d: %0d, not %0d", region, u, v, t, pixels[region*8+:8], wanted);
                    end
                end
                u = u + 1;
                if (u == SIDE) begin
                    u = 0;
                    v = v + 1;
                end
                if (v == SIDE) begin
                    v = 0;
                    t = t + 1;
                end
            end
            soon_second = soon_first;
            soon_first  = soon;
            since       = since + 1;
        end
    end
    initial begin
        repeat (4) @(posedge clk);
        #1 rst = 0;
        repeat (5 * SIDE * SIDE / 2) @(posedge clk);
        #1 rst = 1;
        repeat (3) @(posedge clk);
        #1 rst = 0;
        while (t < FRAMES) @(posedge clk);
        if (squares == 0 || gradients == 0 || (textures == 0 && COLUMNS * SIDE > 192)) fail("a part of the scene was not seen");
        if (errors == 0) $display("PASS array_pattern_bench, %0d x %0d regions of %0d: %0d frames", COLUMNS, ROWS, SIDE, t);
        else $display("FAIL array_pattern_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
