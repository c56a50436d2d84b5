// SPDX-License-Identifier: MIT OR Apache-2.0
// Memory with a port to write and a port to read. data_o is the word of the last read edge, with OUTPUT_STAGE one edge
// later. A word that is written and read at one edge is read as it was before.
//
// With FOVEATE_ECP5 defined, a memory with OUTPUT_STAGE is built of blocks of the Lattice ECP5, DP16KD. Its second register
// is the output register of the block, which synth_ecp5 never uses by itself; a block without it takes most of a clock to
// show a word that it has read. Words that do not fit into one block are in banks, and a bank is selected behind these
// registers. A word that is written and read at one edge is then undefined; no module here does that.
`default_nettype none

module raster_memory #(
    parameter WIDTH = 16,         // bits of a word
    parameter WORDS = 240,        // words, at least 2
    parameter ADDRESS_BITS = 8,   // ceil(log2(WORDS))
    parameter OUTPUT_STAGE = 0,   // 0: a word is on data_o one edge after its address; 1: two edges
    parameter STYLE = "block"     // of what it is built: "block" or "ultra" RAM
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    write_i,          // write at this edge
    input  wire [ADDRESS_BITS-1:0] write_address_i,  // address of the word that is written
    input  wire [       WIDTH-1:0] data_i,           // the word that is written
    input  wire                    read_i,           // read at this edge; otherwise the memory's register keeps its word
    input  wire [ADDRESS_BITS-1:0] read_address_i,   // address of the word that is read
    input  wire                    output_i,         // the second register takes the word that was read; otherwise it stays (OUTPUT_STAGE)
    output wire [       WIDTH-1:0] data_o            // the word that was read
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(WORDS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_WORDS u_refused ();
        end
        if (OUTPUT_STAGE != 0 && OUTPUT_STAGE != 1) begin : g_output_stage
            OUTPUT_STAGE_must_be_0_or_1 u_refused ();
        end
        if (STYLE != "block" && STYLE != "ultra") begin : g_style STYLE_must_be_block_or_ultra u_refused (); end
    endgenerate

`ifdef FOVEATE_ECP5
    localparam ECP5 = OUTPUT_STAGE && STYLE == "block";
`else
    localparam ECP5 = 0;
`endif

    generate
        if (!ECP5) begin : g_inferred
            (* ram_style = STYLE, no_rw_check *) reg [WIDTH-1:0] words_q[0:WORDS-1];
            reg [WIDTH-1:0] read_q;

            always @(posedge clk_i) begin
                if (write_i) words_q[write_address_i] <= data_i;
                if (read_i) read_q <= words_q[read_address_i];
            end

            if (OUTPUT_STAGE) begin : g_stage
                reg [WIDTH-1:0] output_q;
                always @(posedge clk_i) if (output_i) output_q <= read_q;
                assign data_o = output_q;
            end else begin : g_direct
                wire unused_output = output_i;
                assign data_o = read_q;
            end
        end
`ifdef FOVEATE_ECP5
        else begin : g_blocks
            // A block has 2^14 words of 1 bit, 2^13 of 2, 2^12 of 4, 2^11 of 9 or 2^10 of 18. The chosen width needs the
            // fewest blocks, with at most 8 banks, and among these the fewest banks. The address of a block is that of a bit,
            // so wide words leave out its lowest bits. With 18 bits, the two lowest bits enable the halves that are written.
            localparam BANKS_1 = (WORDS + (1 << 14) - 1) >> 14, BLOCKS_1 = BANKS_1 * WIDTH;
            localparam BANKS_2 = (WORDS + (1 << 13) - 1) >> 13, BLOCKS_2 = BANKS_2 > 8 ? BLOCKS_1 : BANKS_2 * ((WIDTH + 1) / 2);
            localparam BANKS_4 = (WORDS + (1 << 12) - 1) >> 12, BLOCKS_4 = BANKS_4 > 8 ? BLOCKS_1 : BANKS_4 * ((WIDTH + 3) / 4);
            localparam BANKS_9 = (WORDS + (1 << 11) - 1) >> 11, BLOCKS_9 = BANKS_9 > 8 ? BLOCKS_1 : BANKS_9 * ((WIDTH + 8) / 9);
            localparam BANKS_18 = (WORDS + (1 << 10) - 1) >> 10, BLOCKS_18 = BANKS_18 > 8 ? BLOCKS_1 : BANKS_18 * ((WIDTH + 17) / 18);
            localparam FEWEST_2 = BLOCKS_2 < BLOCKS_1 ? BLOCKS_2 : BLOCKS_1;
            localparam FEWEST_4 = BLOCKS_4 < FEWEST_2 ? BLOCKS_4 : FEWEST_2;
            localparam FEWEST_9 = BLOCKS_9 < FEWEST_4 ? BLOCKS_9 : FEWEST_4;
            localparam BITS = BLOCKS_18 < FEWEST_9 ? 18 : BLOCKS_9 < FEWEST_4 ? 9 : BLOCKS_4 < FEWEST_2 ? 4 : BLOCKS_2 < BLOCKS_1 ? 2 : 1;
            localparam SHIFT = BITS == 18 ? 4 : BITS == 9 ? 3 : BITS == 4 ? 2 : BITS == 2 ? 1 : 0;
            localparam PLACE_BITS = 14 - SHIFT;
            localparam BLOCKS = (WIDTH + BITS - 1) / BITS;
            localparam BANKS = (WORDS + (1 << PLACE_BITS) - 1) >> PLACE_BITS;
            wire [BLOCKS*BITS-1:0] given_all = {{(BLOCKS * BITS - WIDTH) {1'b0}}, data_i};
            wire [BANKS*BLOCKS*BITS-1:0] found_all;
            wire [ADDRESS_BITS+13:0] write_address = {14'd0, write_address_i};
            wire [ADDRESS_BITS+13:0] read_address = {14'd0, read_address_i};
            wire [13:0] write_at = write_address[13:0] << SHIFT | (BITS == 18 ? 14'd3 : 14'd0);
            wire [13:0] read_at = read_address[13:0] << SHIFT;
            genvar bank, block;
            for (bank = 0; bank < BANKS; bank = bank + 1) begin : g_bank
                wire write = write_i && write_address >> PLACE_BITS == bank;
                for (block = 0; block < BLOCKS; block = block + 1) begin : g_block
                    wire [17:0] given = {{(18 - BITS) {1'b0}}, given_all[block*BITS+:BITS]};
                    wire [17:0] found;
                    assign found_all[(bank*BLOCKS+block)*BITS+:BITS] = found[BITS-1:0];
                    DP16KD #(
                        .DATA_WIDTH_A(BITS), .DATA_WIDTH_B(BITS), .REGMODE_A("NOREG"), .REGMODE_B("OUTREG"), .RESETMODE("SYNC"),
                        .ASYNC_RESET_RELEASE("SYNC"), .CSDECODE_A("0b000"), .CSDECODE_B("0b000"), .WRITEMODE_A("NORMAL"),
                        .WRITEMODE_B("NORMAL"), .GSR("DISABLED")
                    ) u_block (
                        .CLKA(clk_i), .CEA(1'b1), .OCEA(1'b1), .WEA(write), .RSTA(1'b0), .CSA0(1'b0), .CSA1(1'b0), .CSA2(1'b0),
                        .CLKB(clk_i), .CEB(read_i), .OCEB(output_i), .WEB(1'b0), .RSTB(1'b0), .CSB0(1'b0), .CSB1(1'b0), .CSB2(1'b0),
                        .ADA0(write_at[0]), .ADA1(write_at[1]), .ADA2(write_at[2]), .ADA3(write_at[3]), .ADA4(write_at[4]),
                        .ADA5(write_at[5]), .ADA6(write_at[6]), .ADA7(write_at[7]), .ADA8(write_at[8]), .ADA9(write_at[9]),
                        .ADA10(write_at[10]), .ADA11(write_at[11]), .ADA12(write_at[12]), .ADA13(write_at[13]),
                        .ADB0(read_at[0]), .ADB1(read_at[1]), .ADB2(read_at[2]), .ADB3(read_at[3]), .ADB4(read_at[4]),
                        .ADB5(read_at[5]), .ADB6(read_at[6]), .ADB7(read_at[7]), .ADB8(read_at[8]), .ADB9(read_at[9]),
                        .ADB10(read_at[10]), .ADB11(read_at[11]), .ADB12(read_at[12]), .ADB13(read_at[13]),
                        .DIA0(given[0]), .DIA1(given[1]), .DIA2(given[2]), .DIA3(given[3]), .DIA4(given[4]), .DIA5(given[5]),
                        .DIA6(given[6]), .DIA7(given[7]), .DIA8(given[8]), .DIA9(given[9]), .DIA10(given[10]), .DIA11(given[11]),
                        .DIA12(given[12]), .DIA13(given[13]), .DIA14(given[14]), .DIA15(given[15]), .DIA16(given[16]), .DIA17(given[17]),
                        .DOB0(found[0]), .DOB1(found[1]), .DOB2(found[2]), .DOB3(found[3]), .DOB4(found[4]), .DOB5(found[5]),
                        .DOB6(found[6]), .DOB7(found[7]), .DOB8(found[8]), .DOB9(found[9]), .DOB10(found[10]), .DOB11(found[11]),
                        .DOB12(found[12]), .DOB13(found[13]), .DOB14(found[14]), .DOB15(found[15]), .DOB16(found[16]), .DOB17(found[17]),
                        .DIB0(1'b0), .DIB1(1'b0), .DIB2(1'b0), .DIB3(1'b0), .DIB4(1'b0), .DIB5(1'b0),
                        .DIB6(1'b0), .DIB7(1'b0), .DIB8(1'b0), .DIB9(1'b0), .DIB10(1'b0), .DIB11(1'b0),
                        .DIB12(1'b0), .DIB13(1'b0), .DIB14(1'b0), .DIB15(1'b0), .DIB16(1'b0), .DIB17(1'b0)
                    );
                end
            end
            if (BANKS == 1) begin : g_one
                assign data_o = found_all[WIDTH-1:0];
            end else begin : g_some
                reg [ADDRESS_BITS-PLACE_BITS-1:0] read_bank_q, bank_q;
                reg [WIDTH-1:0] chosen;
                integer number;
                always @(posedge clk_i) begin
                    if (read_i) read_bank_q <= read_address_i[ADDRESS_BITS-1:PLACE_BITS];
                    if (output_i) bank_q <= read_bank_q;
                end
                always @* begin
                    chosen = {WIDTH{1'b0}};
                    for (number = 0; number < BANKS; number = number + 1)
                        if (bank_q == number) chosen = found_all[number*BLOCKS*BITS+:WIDTH];
                end
                assign data_o = chosen;
            end
        end
`endif
    endgenerate

endmodule

`default_nettype wire
