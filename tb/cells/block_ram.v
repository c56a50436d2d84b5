// SPDX-License-Identifier: MIT OR Apache-2.0
// A model of the {= name =} of UltraScale+, as far as Yosys uses it for a memory with a single port: port A
// reads and writes with one width, READ_FIRST, without output register; port B is not used. Written from UG573,
// "UltraScale Architecture Memory Resources": a word of 8 bits and more has a parity bit per byte beside its
// data, a port of 2^k data bits leaves the k lowest address bits out, and READ_FIRST shows the word that a
// write at the same edge replaces.
//
// Memory and output start unknown. Values of parameters that are not modelled are an error of elaboration;
// so must be parameters that are not declared here. What is not modelled of the inputs (a reset, a part
// of a word, an address or enable that is unknown while something may be written) makes the memory unknown.
`default_nettype none

module {= name =} #(
    parameter DOA_REG = 1,
    parameter DOB_REG = 1,
    parameter READ_WIDTH_A = 0,
    parameter READ_WIDTH_B = 0,
    parameter WRITE_WIDTH_A = 0,
    parameter WRITE_WIDTH_B = 0,
    parameter WRITE_MODE_A = "NO_CHANGE",
    parameter WRITE_MODE_B = "NO_CHANGE",
    parameter IS_CLKARDCLK_INVERTED = 0,
    parameter IS_CLKBWRCLK_INVERTED = 0,
    parameter IS_ENARDEN_INVERTED = 0,
    parameter IS_ENBWREN_INVERTED = 0,
    parameter IS_RSTRAMARSTRAM_INVERTED = 0,
    parameter IS_RSTRAMB_INVERTED = 0,
    parameter IS_RSTREGARSTREG_INVERTED = 0,
    parameter IS_RSTREGB_INVERTED = 0,
    // What the output shows after the start or a reset; unknown is modelled.
    parameter INIT_A = 0,
    parameter INIT_B = 0,
    parameter SRVAL_A = 0,
    parameter SRVAL_B = 0,
    // Contents at the start; unknown ones are modelled.
{%- for start in contents %}
    parameter [255:0] {= start =} = 0{% if !loop.last %},{% endif %}
{%- endfor %}
) (
    input  wire CLKARDCLK,
    input  wire CLKBWRCLK,
    input  wire ENARDEN,
    input  wire ENBWREN,
    input  wire [{= address_bits - 1 =}:0] ADDRARDADDR,
    input  wire [{= address_bits - 1 =}:0] ADDRBWRADDR,
    input  wire ADDRENA,
    input  wire ADDRENB,
    input  wire [{= bytes - 1 =}:0] WEA,
    input  wire [{= 2 * bytes - 1 =}:0] WEBWE,
    input  wire [{= 8 * bytes - 1 =}:0] DINADIN,
    input  wire [{= 8 * bytes - 1 =}:0] DINBDIN,
    input  wire [{= bytes - 1 =}:0] DINPADINP,
    input  wire [{= bytes - 1 =}:0] DINPBDINP,
    output wire [{= 8 * bytes - 1 =}:0] DOUTADOUT,
    output wire [{= 8 * bytes - 1 =}:0] DOUTBDOUT,
    output wire [{= bytes - 1 =}:0] DOUTPADOUTP,
    output wire [{= bytes - 1 =}:0] DOUTPBDOUTP,
    input  wire REGCEAREGCE,
    input  wire REGCEB,
    input  wire RSTRAMARSTRAM,
    input  wire RSTRAMB,
    input  wire RSTREGARSTREG,
    input  wire RSTREGB,
    input  wire SLEEP
);

    // 2^SHIFT data bits and BYTES parity bits at a time.
    localparam SHIFT = READ_WIDTH_A == 36 ? 5 : READ_WIDTH_A == 18 ? 4 : READ_WIDTH_A == 9 ? 3
        : READ_WIDTH_A == 4 ? 2 : READ_WIDTH_A == 2 ? 1 : READ_WIDTH_A == 1 ? 0 : -1;
    localparam MOST = {= bytes =};
    localparam DATA = SHIFT < 0 ? 1 : 1 << SHIFT;
    localparam BYTES = DATA / 8;
    localparam WORDS = (1 << {= address_bits =}) / DATA;
    localparam [{= contents.len() * 256 - 1 =}:0] START = {
{%- for start in contents %}
        {= start =}{% if !loop.last %},{% endif %}
{%- endfor %}
    };

    generate
        if (SHIFT < 0 || BYTES > MOST || WRITE_WIDTH_A != READ_WIDTH_A) begin : g_width
            {= name =}_must_read_and_write_at_port_A_with_one_width refused ();
        end
        if (READ_WIDTH_B != 0 || WRITE_WIDTH_B != 0) begin : g_port
            {= name =}_port_B_is_not_modelled refused ();
        end
        if (DOA_REG != 0 || DOB_REG != 0) begin : g_register
            {= name =}_output_registers_are_not_modelled refused ();
        end
        if (IS_CLKARDCLK_INVERTED != 0 || IS_CLKBWRCLK_INVERTED != 0 || IS_ENARDEN_INVERTED != 0
            || IS_ENBWREN_INVERTED != 0 || IS_RSTRAMARSTRAM_INVERTED != 0 || IS_RSTRAMB_INVERTED != 0
            || IS_RSTREGARSTREG_INVERTED != 0 || IS_RSTREGB_INVERTED != 0) begin : g_inverted
            {= name =}_inverted_inputs_are_not_modelled refused ();
        end
        if (WRITE_MODE_A != "READ_FIRST") begin : g_mode
            {= name =}_must_be_READ_FIRST refused ();
        end
        if (START !== { {= contents.len() * 256 =} {1'bx} }) begin : g_start
            {= name =}_must_start_unknown refused ();
        end
    endgenerate

    reg [MOST*9-1:0] words[0:WORDS-1];
    reg [MOST*9-1:0] word_q;
    wire [{= address_bits - 1 =}:0] address = ADDRARDADDR / DATA;
    wire quiet = {RSTRAMARSTRAM, RSTREGARSTREG, SLEEP, ADDRENA} === 4'b0001;
    wire reads = quiet && ENARDEN === 1'b1 && ^address !== 1'bx;
    integer i;

    always @(posedge CLKARDCLK) begin
        if (!quiet || ENARDEN !== 1'b0) begin
            word_q <= reads ? words[address] : {MOST * 9{1'bx}};
            if (reads && WEA === {MOST{1'b1}}) words[address] <= {DINPADINP, DINADIN};
            else if (!quiet || WEA !== {MOST{1'b0}}) begin
                for (i = 0; i < WORDS; i = i + 1) words[i] <= {MOST * 9{1'bx}};
            end
        end
    end

    // Bits beyond the width say nothing.
    genvar bit;
    generate
        for (bit = 0; bit < MOST * 8; bit = bit + 1) begin : g_data
            assign DOUTADOUT[bit] = bit < DATA ? word_q[bit] : 1'bx;
        end
        for (bit = 0; bit < MOST; bit = bit + 1) begin : g_parity
            assign DOUTPADOUTP[bit] = bit < BYTES ? word_q[MOST*8+bit] : 1'bx;
        end
    endgenerate
    assign DOUTBDOUT = {MOST * 8{1'bx}};
    assign DOUTPBDOUTP = {MOST{1'bx}};

endmodule

`default_nettype wire
