// SPDX-License-Identifier: MIT OR Apache-2.0
// When thresholds that were written reach an array of RPUs (docs/boards.md). Frames follow each other at once, so several are on
// their way: each threshold has a clock of its own at which it changes between what it does to one frame and to the next.
`default_nettype none

module array_turn #(
    parameter LEVEL_AT = 20,     // clocks from the first pixel of a frame until its windows step
    parameter TEMPORAL_AT = 20,  // until it is compared with its reference; LEVEL_AT or more
    parameter MINIMUM_AT = 21,   // until the frame before has been decided; more than TEMPORAL_AT
    parameter COUNT_BITS = 5     // ceil(log2(MINIMUM_AT + 1))
) (
    input  wire clk_i,       // clock, rising edge
    input  wire rst_i,       // synchronous reset, active high
    input  wire soon_i,      // two clocks from now the first pixel of a frame is there
    output wire begin_o,     // all thresholds of that frame are taken; none while those before are on their way
    output wire level_o,     // its levels take effect behind this edge
    output wire temporal_o,  // its temporal level does
    output wire minimum_o    // all others do
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (LEVEL_AT < 0) begin : g_level LEVEL_AT_must_be_0_or_more u_refused (); end
        if (TEMPORAL_AT < LEVEL_AT) begin : g_temporal TEMPORAL_AT_must_be_LEVEL_AT_or_more u_refused (); end
        if (MINIMUM_AT <= TEMPORAL_AT) begin : g_minimum MINIMUM_AT_must_be_above_TEMPORAL_AT u_refused (); end
        if (COUNT_BITS != $clog2(MINIMUM_AT + 1)) begin : g_bits COUNT_BITS_must_be_clog2_of_MINIMUM_AT_plus_1 u_refused (); end
    endgenerate

    // The first clock behind begin_o is that before the first pixel.
    reg busy_q;
    reg [COUNT_BITS-1:0] count_q;
    assign begin_o = soon_i && !busy_q;
    assign level_o = busy_q && count_q == LEVEL_AT[COUNT_BITS-1:0];
    assign temporal_o = busy_q && count_q == TEMPORAL_AT[COUNT_BITS-1:0];
    assign minimum_o = busy_q && count_q == MINIMUM_AT[COUNT_BITS-1:0];
    always @(posedge clk_i) begin
        count_q <= busy_q ? count_q + 1'b1 : {COUNT_BITS{1'b0}};
        busy_q  <= !rst_i && (begin_o || (busy_q && !minimum_o));
    end

endmodule

`default_nettype wire
