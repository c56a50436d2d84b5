// SPDX-License-Identifier: MIT OR Apache-2.0
// Registers the controls of the lanes for a group of lanes: one clock, and LATE more for controls whose operands come later.
// A control that the design does not use is 0, so that synthesis leaves no register for it.
`default_nettype none

module serial_control #(
    parameter WIDTH = 1,                // bits of the controls, at least 1
    parameter [WIDTH-1:0] USED = 1'b1,  // one bit per control: the design uses it
    parameter LATE = 0                  // clocks by which the controls come later
) (
    input  wire             clk_i,   // clock, rising edge
    input  wire             rst_i,   // synchronous reset, active high
    input  wire [WIDTH-1:0] bits_i,  // controls from the sequencer
    output wire [WIDTH-1:0] bits_o   // controls to the lanes
);

    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LATE < 0) begin : g_late LATE_must_be_0_or_more u_refused (); end
    endgenerate

    // The newest controls are in the lowest bits.
    reg [(LATE+1)*WIDTH-1:0] bits_q;
    wire [(LATE+2)*WIDTH-1:0] bits = {bits_q, bits_i & USED};
    wire unused_last = |bits[(LATE+1)*WIDTH+:WIDTH];

    always @(posedge clk_i) begin
        if (rst_i) bits_q <= {(LATE + 1) * WIDTH{1'b0}};
        else bits_q <= bits[(LATE+1)*WIDTH-1:0];
    end

    assign bits_o = bits_q[LATE*WIDTH+:WIDTH];

endmodule

`default_nettype wire
