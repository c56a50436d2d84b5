// SPDX-License-Identifier: MIT OR Apache-2.0
// Selects the temporal count of a frame that was counted before its reference was known: the count against the previous
// frame if that frame was active, otherwise the count against the older reference. Combinational.
`default_nettype none

module candidate_count #(
    parameter WIDTH = 7,   // bits of a count
    parameter PIXELS = 64  // pixels of a region, which is the count without any reference
) (
    input  wire             previous_sent_i,   // the previous frame is the reference
    input  wire             valid_i,           // the older reference is valid
    input  wire [WIDTH-1:0] previous_count_i,  // count against the previous frame, 0..PIXELS
    input  wire [WIDTH-1:0] sent_count_i,      // count against the older reference, 0..PIXELS
    output wire [WIDTH-1:0] count_o            // the temporal count of the frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < $clog2(PIXELS + 1)) begin : g_width WIDTH_must_hold_PIXELS u_refused (); end
    endgenerate

    localparam [WIDTH-1:0] ALL = PIXELS;

    assign count_o = previous_sent_i ? previous_count_i : valid_i ? sent_count_i : ALL;

endmodule

`default_nettype wire
