// SPDX-License-Identifier: MIT OR Apache-2.0
// Delays the ports that go with scores and pixels by as many clocks as the lanes take.
`default_nettype none

module serial_shown #(
    parameter WIDTH = 12,  // number of bits that are delayed together
    parameter LATE = 0     // clocks from an address to the accumulator
) (
    input  wire             clk_i,   // clock, rising edge
    input  wire             rst_i,   // synchronous reset, active high
    input  wire [WIDTH-1:0] bits_i,  // bits from the sequencer
    output wire [WIDTH-1:0] next_o,  // bits that are on the ports at the next clock
    output wire [WIDTH-1:0] bits_o   // bits that are on the ports now
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LATE < 0) begin : g_late LATE_must_be_0_or_more u_refused (); end
    endgenerate

    // The newest bits are the lowest. The initial value keeps synthesis from
    // moving these registers into the address port of a memory.
    reg [(LATE+1)*WIDTH-1:0] bits_q = {(LATE + 1) * WIDTH{1'b0}};
    wire [(LATE+2)*WIDTH-1:0] bits = {bits_q, bits_i};
    wire unused_last = |bits[(LATE+1)*WIDTH+:WIDTH];

    always @(posedge clk_i) begin
        if (rst_i) bits_q <= {(LATE + 1) * WIDTH{1'b0}};
        else bits_q <= bits[(LATE+1)*WIDTH-1:0];
    end

    assign next_o = bits[LATE*WIDTH+:WIDTH];
    assign bits_o = bits_q[LATE*WIDTH+:WIDTH];

endmodule

`default_nettype wire
