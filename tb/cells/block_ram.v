// SPDX-License-Identifier: MIT OR Apache-2.0
// A model of the {= name =} of UltraScale+, as far as Yosys uses it. For a memory with a single port, port A reads and writes.
// For a memory with a port to write and a port to read, A writes and B reads; if a word is wider than a port, B writes and A
// reads, and both act as one port of twice the width. Both ports have one clock and one width, and no output register.
// Written from UG573, "UltraScale Architecture Memory Resources": a word of 8 bits and more has a parity bit per byte beside
// its data, a port of 2^k data bits leaves out the k lowest address bits, and if the port that writes is READ_FIRST, a word
// that is read at the same edge is shown as it was before, at either port.
//
// Memory and output are unknown at the start. Values of parameters that are not modelled are an error of elaboration, and
// parameters that are not declared here must be one, too. Inputs that are not modelled (a reset, an address or an enable that
// is unknown while a word may be written) make the memory unknown.
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
    // Values of the output after the start or a reset. Only unknown values are modelled.
    parameter INIT_A = 0,
    parameter INIT_B = 0,
    parameter SRVAL_A = 0,
    parameter SRVAL_B = 0,
    // Initial contents. Only unknown values are modelled.
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

    localparam MOST = {= bytes =};
    // The ports that read and write, and whether both act as one port of twice the width.
    localparam READ_WIDTH = READ_WIDTH_A != 0 ? READ_WIDTH_A : READ_WIDTH_B;
    localparam WRITE_WIDTH = WRITE_WIDTH_A != 0 ? WRITE_WIDTH_A : WRITE_WIDTH_B;
    localparam READ_B = READ_WIDTH_A == 0;
    localparam WRITE_B = WRITE_WIDTH_A == 0;
    localparam DOUBLE = !READ_B && WRITE_B;
    localparam TWO = READ_B != WRITE_B;
    // A port has 2^SHIFT data bits and BYTES parity bits.
    localparam SHIFT = READ_WIDTH == 72 ? 6 : READ_WIDTH == 36 ? 5 : READ_WIDTH == 18 ? 4 : READ_WIDTH == 9 ? 3
        : READ_WIDTH == 4 ? 2 : READ_WIDTH == 2 ? 1 : READ_WIDTH == 1 ? 0 : -1;
    localparam DATA = SHIFT < 0 ? 1 : 1 << SHIFT;
    localparam BYTES = DATA / 8;
    localparam WORDS = (1 << {= address_bits =}) / DATA;
    localparam [{= contents.len() * 256 - 1 =}:0] START = {
{%- for start in contents %}
        {= start =}{% if !loop.last %},{% endif %}
{%- endfor %}
    };

    generate
        if (SHIFT < 0 || READ_WIDTH != WRITE_WIDTH) begin : g_width
            {= name =}_must_read_and_write_with_one_width refused ();
        end
        if (DOUBLE ? BYTES != 2 * MOST : BYTES > MOST) begin : g_most
            {= name =}_must_use_port_B_to_write_for_twice_the_width_and_only_then refused ();
        end
        if ((READ_WIDTH_A != 0 && READ_WIDTH_B != 0) || (WRITE_WIDTH_A != 0 && WRITE_WIDTH_B != 0) || (READ_B && WRITE_B)) begin : g_port
            {= name =}_must_read_at_one_port_and_write_at_one_port refused ();
        end
        if (DOA_REG != 0 || DOB_REG != 0) begin : g_register
            {= name =}_output_registers_are_not_modelled refused ();
        end
        if (IS_CLKARDCLK_INVERTED != 0 || IS_CLKBWRCLK_INVERTED != 0 || IS_ENARDEN_INVERTED != 0
            || IS_ENBWREN_INVERTED != 0 || IS_RSTRAMARSTRAM_INVERTED != 0 || IS_RSTRAMB_INVERTED != 0
            || IS_RSTREGARSTREG_INVERTED != 0 || IS_RSTREGB_INVERTED != 0) begin : g_inverted
            {= name =}_inverted_inputs_are_not_modelled refused ();
        end
        if ((WRITE_B ? WRITE_MODE_B : WRITE_MODE_A) != "READ_FIRST") begin : g_mode
            {= name =}_must_be_READ_FIRST refused ();
        end
        if (START !== { {= contents.len() * 256 =} {1'bx} }) begin : g_start
            {= name =}_must_start_unknown refused ();
        end
    endgenerate

    localparam BITS = 2 * MOST * 9;
    reg [BITS-1:0] words[0:WORDS-1];
    reg [BITS-1:0] word_q;
    wire [{= address_bits - 1 =}:0] read_address = (READ_B ? ADDRBWRADDR : ADDRARDADDR) / DATA;
    wire [{= address_bits - 1 =}:0] write_address = (WRITE_B ? ADDRBWRADDR : ADDRARDADDR) / DATA;
    wire read_enable = READ_B ? ENBWREN : ENARDEN;
    wire write_enable = WRITE_B ? ENBWREN : ENARDEN;
    // One bit per byte. A port that is wider than the word repeats these bits.
    localparam ENABLES = WRITE_B ? 2 * MOST : MOST;
    localparam ENABLED = BYTES > 1 ? BYTES : 1;
    wire [ENABLES-1:0] enables = WRITE_B ? WEBWE : WEA;
    wire [BITS-1:0] data = {DINPBDINP, DINPADINP, DINBDIN, DINADIN};
    // Only these uses are modelled. A second port has the same clock, and only its own task.
    wire quiet_a = {RSTRAMARSTRAM, RSTREGARSTREG, SLEEP, ADDRENA} === 4'b0001;
    wire unwritten = READ_B ? WEBWE === {2 * MOST{1'b0}} : WEA === {MOST{1'b0}};
    wire quiet_b = {RSTRAMB, RSTREGB, ADDRENB} === 3'b001 && unwritten;
    integer i;
    reg quiet;
    reg apart = 1'b0;  // 1: the second port had a clock edge of its own
    always @(posedge CLKBWRCLK) if (CLKARDCLK !== 1'b1) apart <= 1'b1;
    reg [BITS-1:0] written;

    always @(posedge CLKARDCLK) begin
        quiet = quiet_a && (!TWO || (quiet_b && CLKBWRCLK === 1'b1 && !apart));
        if (!quiet || read_enable !== 1'b0) begin
            word_q <= quiet && read_enable === 1'b1 && ^read_address !== 1'bx ? words[read_address] : {BITS{1'bx}};
        end
        if (!quiet || (write_enable !== 1'b0 && enables !== {ENABLES{1'b0}})) begin
            if (quiet && write_enable === 1'b1 && ^write_address !== 1'bx && enables === {ENABLES / ENABLED{enables[ENABLED-1:0]}}) begin
                written = words[write_address];
                for (i = 0; i < ENABLED; i = i + 1) begin
                    if (enables[i] !== 1'b0) begin
                        written[8*i+:8] = enables[i] === 1'b1 ? data[8*i+:8] : 8'bx;
                        written[MOST*16+i] = enables[i] === 1'b1 ? data[MOST*16+i] : 1'bx;
                    end
                end
                words[write_address] <= written;
            end else begin
                for (i = 0; i < WORDS; i = i + 1) words[i] <= {BITS{1'bx}};
            end
        end
    end

    // Bits beyond the width are ignored, and so is a port that does not read.
    genvar bit;
    generate
        for (bit = 0; bit < MOST * 8; bit = bit + 1) begin : g_data
            assign DOUTADOUT[bit] = !READ_B && bit < DATA ? word_q[bit] : 1'bx;
            assign DOUTBDOUT[bit] = DOUBLE ? word_q[MOST*8+bit] : READ_B && bit < DATA ? word_q[bit] : 1'bx;
        end
        for (bit = 0; bit < MOST; bit = bit + 1) begin : g_parity
            assign DOUTPADOUTP[bit] = !READ_B && bit < BYTES ? word_q[MOST*16+bit] : 1'bx;
            assign DOUTPBDOUTP[bit] = DOUBLE ? word_q[MOST*17+bit] : READ_B && bit < BYTES ? word_q[MOST*16+bit] : 1'bx;
        end
    endgenerate

endmodule

`default_nettype wire
