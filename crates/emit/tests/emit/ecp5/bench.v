// SPDX-License-Identifier: MIT OR Apache-2.0
// The memory in both forms, with the same inputs: what they show is the same once it is known.
`default_nettype none

module bench;
    parameter WIDTH = 16;
    parameter WORDS = 240;
    localparam BITS = $clog2(WORDS);
    reg clk = 1'b0;
    reg write = 1'b0, read = 1'b0, take = 1'b0;
    reg [BITS-1:0] write_address = 0, read_address = 0;
    reg [WIDTH-1:0] word = 0;
    wire [WIDTH-1:0] plain, blocks;
    integer clocks, known, seed;

    raster_memory #(.WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(BITS), .OUTPUT_STAGE(1)) u_plain (
        .clk_i(clk), .write_i(write), .write_address_i(write_address), .data_i(word), .read_i(read),
        .read_address_i(read_address), .output_i(take), .data_o(plain)
    );
    ecp5_memory #(.WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(BITS), .OUTPUT_STAGE(1)) u_blocks (
        .clk_i(clk), .write_i(write), .write_address_i(write_address), .data_i(word), .read_i(read),
        .read_address_i(read_address), .output_i(take), .data_o(blocks)
    );

    initial begin
        seed = WIDTH * WORDS;
        known = 0;
        for (clocks = 0; clocks < 3 * WORDS + 1000; clocks = clocks + 1) begin
            // First each word once, so that all are known; then anywhere, but not where a word is written.
            write = clocks < WORDS || $random(seed) % 2 == 0;
            write_address = clocks < WORDS ? clocks : $unsigned($random(seed)) % WORDS;
            word = {$random(seed), $random(seed)};
            read = clocks > WORDS && $random(seed) % 4 != 0;
            take = $random(seed) % 4 != 0;
            read_address = $unsigned($random(seed)) % WORDS;
            if (read_address == write_address) read_address = (read_address + 1) % WORDS;
            #1 clk = 1'b1;
            #1 clk = 1'b0;
            if (^plain !== 1'bx || ^blocks !== 1'bx) begin
                known = known + 1;
                if (plain !== blocks) begin
                    $display("MISMATCH at clock %0d: %h and %h", clocks, plain, blocks);
                    $finish;
                end
            end
        end
        if (known > WORDS) $display("PASS %0d", known);
        $finish;
    end
endmodule

`default_nettype wire
