// SPDX-License-Identifier: MIT OR Apache-2.0
// Decides when thresholds that were written reach an array of RPUs (docs/boards.md). Frames follow each other without a gap,
// so several are under way. Each threshold has a clock of its own at which it changes from one frame to the next.
`default_nettype none

module array_turn #(
    parameter LEVEL_AT = 20,     // clocks from the first pixel of a frame until its windows step
    parameter TEMPORAL_AT = 20,  // clocks until its pixels are compared with their references; LEVEL_AT or more
    parameter MINIMUM_AT = 21,   // clocks until the frame before has been decided; more than TEMPORAL_AT
    parameter COUNT_BITS = 5     // ceil(log2(MINIMUM_AT + 1))
) (
    input  wire clk_i,       // clock, rising edge
    input  wire rst_i,       // synchronous reset, active high
    input  wire soon_i,      // the first pixel of a frame comes two clocks from now
    output wire begin_o,     // all thresholds of that frame are taken over; 0 while others are under way
    output wire level_o,     // the levels of that frame take effect after this edge
    output wire temporal_o,  // the temporal level of that frame takes effect after this edge
    output wire minimum_o    // the other thresholds of that frame take effect after this edge
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (LEVEL_AT < 0) begin : g_level LEVEL_AT_must_be_0_or_more u_refused (); end
        if (TEMPORAL_AT < LEVEL_AT) begin : g_temporal TEMPORAL_AT_must_be_LEVEL_AT_or_more u_refused (); end
        if (MINIMUM_AT <= TEMPORAL_AT) begin : g_minimum MINIMUM_AT_must_be_above_TEMPORAL_AT u_refused (); end
        if (COUNT_BITS != $clog2(MINIMUM_AT + 1)) begin : g_bits COUNT_BITS_must_be_clog2_of_MINIMUM_AT_plus_1 u_refused (); end
    endgenerate

    // The first clock after begin_o is the one before the first pixel.
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
