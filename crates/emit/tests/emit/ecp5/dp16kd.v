// SPDX-License-Identifier: MIT OR Apache-2.0
// A model of the block RAM of the ECP5 as far as raster_memory uses it: port A writes, port B reads, words of one width.
// Words and addresses are those with which Yosys maps memory to it (ecp5/brams_map.v): a word of 2^k or 9 * 2^k bits leaves the
// lowest k bits of the address out (18 bits: 4), and of 18 bits the two lowest enable the halves that are written. Memory and outputs start unknown; a word that is
// written and read at one edge is unknown. Values of parameters that are not modelled stop elaboration.
`default_nettype none

module DP16KD #(
    parameter DATA_WIDTH_A = 18,
    parameter DATA_WIDTH_B = 18,
    parameter REGMODE_A = "NOREG",
    parameter REGMODE_B = "NOREG",
    parameter RESETMODE = "SYNC",
    parameter ASYNC_RESET_RELEASE = "SYNC",
    parameter CSDECODE_A = "0b000",
    parameter CSDECODE_B = "0b000",
    parameter WRITEMODE_A = "NORMAL",
    parameter WRITEMODE_B = "NORMAL",
    parameter GSR = "ENABLED"
) (
    input  wire CLKA,
    input  wire CEA,
    input  wire OCEA,
    input  wire WEA,
    input  wire RSTA,
    input  wire CSA0,
    input  wire CSA1,
    input  wire CSA2,
    input  wire ADA0, ADA1, ADA2, ADA3, ADA4, ADA5, ADA6, ADA7, ADA8, ADA9, ADA10, ADA11, ADA12, ADA13,
    input  wire DIA0, DIA1, DIA2, DIA3, DIA4, DIA5, DIA6, DIA7, DIA8, DIA9, DIA10, DIA11, DIA12, DIA13, DIA14, DIA15, DIA16, DIA17,
    output wire DOA0, DOA1, DOA2, DOA3, DOA4, DOA5, DOA6, DOA7, DOA8, DOA9, DOA10, DOA11, DOA12, DOA13, DOA14, DOA15, DOA16, DOA17,
    input  wire CLKB,
    input  wire CEB,
    input  wire OCEB,
    input  wire WEB,
    input  wire RSTB,
    input  wire CSB0,
    input  wire CSB1,
    input  wire CSB2,
    input  wire ADB0, ADB1, ADB2, ADB3, ADB4, ADB5, ADB6, ADB7, ADB8, ADB9, ADB10, ADB11, ADB12, ADB13,
    input  wire DIB0, DIB1, DIB2, DIB3, DIB4, DIB5, DIB6, DIB7, DIB8, DIB9, DIB10, DIB11, DIB12, DIB13, DIB14, DIB15, DIB16, DIB17,
    output wire DOB0, DOB1, DOB2, DOB3, DOB4, DOB5, DOB6, DOB7, DOB8, DOB9, DOB10, DOB11, DOB12, DOB13, DOB14, DOB15, DOB16, DOB17
);

    generate
        if (DATA_WIDTH_A != DATA_WIDTH_B) begin : g_width widths_differ u_refused (); end
        if (CSDECODE_A != "0b000" || CSDECODE_B != "0b000") begin : g_select another_block_select u_refused (); end
        if (REGMODE_A != "NOREG" || REGMODE_B != "OUTREG") begin : g_mode another_register_mode u_refused (); end
        if (GSR != "DISABLED" || RESETMODE != "SYNC") begin : g_reset a_reset u_refused (); end
    endgenerate

    localparam BITS = DATA_WIDTH_A;
    localparam SHIFT = BITS == 18 ? 4 : BITS == 9 ? 3 : BITS == 4 ? 2 : BITS == 2 ? 1 : 0;
    wire [13:0] write_at = {ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0};
    wire [13:0] read_at = {ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0};
    wire [17:0] given = {DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2,
                         DIA1, DIA0};
    wire selected = !CSA0 && !CSA1 && !CSA2 && !CSB0 && !CSB1 && !CSB2 && !RSTA && !RSTB && !WEB;
    wire writes = selected === 1'b1 && CEA && WEA;
    reg [17:0] words[0:(1 << 14 - SHIFT) - 1];
    reg [17:0] read_q, output_q;

    always @(posedge CLKA) begin
        if (writes && BITS == 18) begin
            if (write_at[0]) words[write_at >> SHIFT][8:0] <= given[8:0];
            if (write_at[1]) words[write_at >> SHIFT][17:9] <= given[17:9];
        end else if (writes) words[write_at >> SHIFT] <= given;
    end
    always @(posedge CLKB) begin
        if (OCEB) output_q <= read_q;
        if (selected !== 1'b1) read_q <= 18'bx;
        else if (CEB) read_q <= writes && write_at >> SHIFT == read_at >> SHIFT ? 18'bx : words[read_at >> SHIFT];
    end

    assign {DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2, DOB1, DOB0} =
        output_q;
    assign {DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9, DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1, DOA0} =
        18'bx;

endmodule

`default_nettype wire
