// SPDX-License-Identifier: MIT OR Apache-2.0
// A model of the DSP48E2 of UltraScale+, as far as Yosys uses it: a signed product of 27 and 18 bits, without a register.
// Written from UG579, "UltraScale Architecture DSP Slice": OPMODE 9'b00_000_01_01 sets W = 0 and Z = 0, and Y and X to the two
// halves of the product; ALUMODE 0000 adds them; INMODE 00000 multiplies A[26:0] with B.
//
// Values of parameters that are not modelled are an error of elaboration, and parameters that are not declared here must be
// one, too. Control inputs with other values make the product unknown.
`default_nettype none

module DSP48E2 #(
    parameter ACASCREG = 1,
    parameter ADREG = 1,
    parameter ALUMODEREG = 1,
    parameter AMULTSEL = "A",
    parameter AREG = 1,
    parameter A_INPUT = "DIRECT",
    parameter BCASCREG = 1,
    parameter BMULTSEL = "B",
    parameter BREG = 1,
    parameter B_INPUT = "DIRECT",
    parameter CARRYINREG = 1,
    parameter CARRYINSELREG = 1,
    parameter CREG = 1,
    parameter DREG = 1,
    parameter INMODEREG = 1,
    parameter MREG = 1,
    parameter OPMODEREG = 1,
    parameter PREG = 1,
    parameter USE_MULT = "MULTIPLY",
    parameter USE_SIMD = "ONE48"
) (
    input  wire [29:0] A,
    input  wire [29:0] ACIN,
    input  wire [ 3:0] ALUMODE,
    input  wire [17:0] B,
    input  wire [17:0] BCIN,
    input  wire [47:0] C,
    input  wire        CARRYIN,
    input  wire [ 2:0] CARRYINSEL,
    input  wire [26:0] D,
    input  wire [ 4:0] INMODE,
    input  wire [ 8:0] OPMODE,
    input  wire [47:0] PCIN,
    output wire [47:0] P
);

    generate
        if (ACASCREG != 0 || ADREG != 0 || ALUMODEREG != 0 || AREG != 0 || BCASCREG != 0 || BREG != 0
            || CARRYINREG != 0 || CARRYINSELREG != 0 || CREG != 0 || DREG != 0 || INMODEREG != 0
            || MREG != 0 || OPMODEREG != 0 || PREG != 0) begin : g_registers
            DSP48E2_registers_are_not_modelled refused ();
        end
        if (AMULTSEL != "A" || BMULTSEL != "B" || A_INPUT != "DIRECT" || B_INPUT != "DIRECT"
            || USE_MULT != "MULTIPLY" || USE_SIMD != "ONE48") begin : g_inputs
            DSP48E2_only_multiplies_A_and_B refused ();
        end
    endgenerate

    wire multiplies = {ALUMODE, CARRYINSEL, CARRYIN, INMODE, OPMODE} === {4'd0, 3'd0, 1'b0, 5'd0, 9'h005};
    wire signed [47:0] a = {{21{A[26]}}, A[26:0]};
    wire signed [47:0] b = {{30{B[17]}}, B};

    assign P = multiplies ? a * b : 48'bx;

endmodule

`default_nettype wire
