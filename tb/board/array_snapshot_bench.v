// SPDX-License-Identifier: MIT OR Apache-2.0
// Drives array_snapshot with random outputs of an array: it keeps the outputs of the chosen region for the chosen frame, and
// no others (docs/boards.md).
`timescale 1ns / 1ps
`default_nettype none

module array_snapshot_bench;

    parameter COLUMNS = 4;
    parameter ROWS = 3;
    parameter HEAD_BYTES = 3;
    parameter PIXELS = 9;
    parameter SEED = 1;
    localparam REGIONS = COLUMNS * ROWS;
    localparam HEAD_BITS = HEAD_BYTES * 8;
    localparam COUNT_BITS = $clog2(PIXELS + 1);
    integer seed = SEED, errors = 0;
    task fail(input [8*60-1:0] what);
        begin
            errors = errors + 1;
            if (errors == 20) begin
                $display("FAIL array_snapshot_bench: too many");
                $finish;
            end
            if (errors < 20) $display("FAIL array_snapshot_bench at %0t: %0s", $realtime, what);
        end
    endtask
    function integer up_to(input integer top);
        up_to = $unsigned($random(seed)) % (top + 1);
    endfunction

    reg clk = 0, rst = 1, decided = 0, start = 0;
    always #5 clk = !clk;
    reg [REGIONS*HEAD_BITS-1:0] head = 0;
    reg [REGIONS-1:0] leaves = 0;
    reg [REGIONS*8-1:0] pixels = 0;
    reg [15:0] column = 0, row = 0;
    reg [6:0] frame = 0;
    reg [8:0] place = 0;
    wire captured;
    wire [31:0] number, word;
    wire [HEAD_BITS-1:0] kept;
    wire [COUNT_BITS-1:0] count;
    array_snapshot #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .COLUMN_BITS(16), .ROW_BITS(16), .HEAD_BYTES(HEAD_BYTES), .PIXELS(PIXELS), .COUNT_BITS(COUNT_BITS)
    ) dut (
        .clk_i(clk), .rst_i(rst), .decided_i(decided), .head_i(head), .forward_valid_i(leaves), .forward_pixel_i(pixels),
        .column_i(column), .row_i(row), .frame_i(frame), .start_i(start), .captured_o(captured), .number_o(number), .head_o(kept),
        .count_o(count), .place_i(place), .word_o(word)
    );

    // The outputs of the chosen region for each of the last frames.
    integer n, clock, region, chosen;
    reg [HEAD_BITS-1:0] said_head[0:511];
    reg [7:0] said[0:512*PIXELS-1];
    integer said_count[0:511];
    initial n = 0;
    initial clock = 0;
    always @(posedge clk) begin
        #1;
        if (rst) begin
            n     = 0;
            clock = 0;
            decided = 0;
        end else begin
            decided = clock == 0;
            for (region = 0; region < REGIONS * HEAD_BYTES; region = region + 1) head[region*8+:8] = $random(seed);
            for (region = 0; region < REGIONS; region = region + 1) begin
                leaves[region]      = n % 3 == 0 ? $random(seed) : n % 3 == 1;
                pixels[region*8+:8] = $random(seed);
            end
            chosen = row * COLUMNS + column;
            // The last pixel of a frame comes with the next decision.
            if (n > 0 && column < COLUMNS && row < ROWS && leaves[chosen]) begin
                said[(n-1)%512*PIXELS+said_count[(n-1)%512]] = pixels[chosen*8+:8];
                said_count[(n-1)%512] = said_count[(n-1)%512] + 1;
            end
            if (decided) begin
                said_head[n%512]  = column < COLUMNS && row < ROWS ? head[chosen*HEAD_BITS+:HEAD_BITS] : {HEAD_BITS{1'b0}};
                said_count[n%512] = 0;
                n = n + 1;
            end
            clock = clock == PIXELS - 1 ? 0 : clock + 1;
        end
    end

    integer tries, waited, k, begun;
    initial begin
        repeat (4) @(posedge clk);
        #2 rst = 0;
        repeat (3 * PIXELS) @(posedge clk);
        for (tries = 0; tries < 24; tries = tries + 1) begin
            #2;
            // Every seventh region does not exist.
            column = tries % 7 == 6 ? COLUMNS + up_to(300) : up_to(COLUMNS - 1);
            row    = tries % 7 == 5 ? ROWS + up_to(300) : up_to(ROWS - 1);
            frame  = tries == 3 ? n + 100 : n + 3 + up_to(20);
            repeat (4) @(posedge clk);
            #2 start = 1;
            @(posedge clk);
            #2 start = 0;
            begun = n;
            // A capture that has begun is dropped at the next start.
            if (tries % 5 == 4) begin
                while (n % 128 != (frame + 1) % 128) @(posedge clk);
                repeat (PIXELS / 2) @(posedge clk);
                #2 start = 1;
                frame = frame + 9;
                @(posedge clk);
                #2 start = 0;
            end
            if (captured) fail("captured before it has come");
            waited = 0;
            while (!captured && waited < 140 * PIXELS) begin
                @(posedge clk);
                #2 waited = waited + 1;
            end
            if (!captured) fail("not captured");
            else begin
                if (number[6:0] !== frame || number >= n || number < begun) fail("not a frame that was asked for");
                if (n - number > 2) fail("captured long after it has left");
                if (kept !== said_head[number%512]) fail("not its decision and scores");
                if (count !== said_count[number%512]) fail("not as many pixels as left");
                for (k = 0; k < said_count[number%512]; k = k + 1) begin
                    place = k / 4;
                    repeat (2) @(posedge clk);
                    #2;
                    if (word[k%4*8+:8] !== said[number%512*PIXELS+k]) fail("not the pixel that left");
                end
                place = 511;
                repeat (2) @(posedge clk);
                #2;
                if (PIXELS < 2045 && word !== 32'd0) fail("a place that is not there");
            end
        end
        if (errors == 0) $display("PASS array_snapshot_bench, %0d x %0d: %0d captures", COLUMNS, ROWS, tries);
        else $display("FAIL array_snapshot_bench: %0d errors", errors);
        $finish;
    end

endmodule

`default_nettype wire
