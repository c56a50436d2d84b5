// SPDX-License-Identifier: MIT OR Apache-2.0
// The temporal count of a frame whose reference was not known while it was counted: against the
// previous frame if that one turns out active, else against what was sent before.
`default_nettype none

module candidate_count #(
    parameter WIDTH = 7,   // bits of a count
    parameter PIXELS = 64  // pixels of a region: the count without any reference
) (
    input  wire             previous_sent_i,   // the previous frame is the reference
    input  wire             valid_i,           // there is a reference
    input  wire [WIDTH-1:0] previous_count_i,  // against the previous frame, 0..PIXELS
    input  wire [WIDTH-1:0] sent_count_i,      // against what was sent before, 0..PIXELS
    output wire [WIDTH-1:0] count_o            // the one that counts
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WIDTH < $clog2(PIXELS + 1)) begin : g_width WIDTH_must_hold_PIXELS u_refused (); end
    endgenerate

    localparam [WIDTH-1:0] ALL = PIXELS;

    assign count_o = previous_sent_i ? previous_count_i : valid_i ? sent_count_i : ALL;

endmodule

`default_nettype wire
