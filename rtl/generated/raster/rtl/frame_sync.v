// SPDX-License-Identifier: MIT OR Apache-2.0
// Finds the frames of a stream whose first beats are marked, and gives only whole frames to the core behind it
// (docs/sync.md). Pixels do not pass through this module: the core takes its pixel port at every edge at which valid_o
// and the core's ready are 1. The handshake is combinational; error_o is a register.
`default_nettype none

module frame_sync #(
    parameter BEATS = 64,    // beats of a frame, at least 2
    parameter BEAT_BITS = 6  // ceil(log2(BEATS))
) (
    input  wire clk_i,    // clock, rising edge
    input  wire rst_i,    // synchronous reset, active high
    input  wire valid_i,  // a beat comes from outside
    input  wire sof_i,    // the beat is the first of a frame; means something only with valid_i
    input  wire open_i,   // the core would take a beat at this edge
    output wire ready_o,  // a beat from outside would be taken
    output wire valid_o,  // a beat is there for the core
    output wire error_o   // a beat came that fits no frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (BEATS < 2) begin : g_beats BEATS_must_be_2_or_more u_refused (); end
        if (BEAT_BITS != $clog2(BEATS)) begin : g_beat_bits BEAT_BITS_must_be_clog2_of_BEATS u_refused (); end
    endgenerate

    localparam BEFORE_LAST = BEATS - 2;

    reg inside_q;                // a frame is under way
    reg fill_q;                  // a frame was cut short, and the core completes it without beats from outside
    reg start_q;                 // a frame has just received all its beats
    reg error_q;
    reg [BEAT_BITS-1:0] beat_q;  // number of the next beat of the current frame; 0 without a frame
    reg last_q;                  // the next beat is the last of its frame

    // Inside a frame a beat must not be a first one. Between two frames it must be one.
    wire fits = inside_q != sof_i;
    wire comes = open_i && valid_i && !fill_q;
    wire passes = open_i && valid_o;

    assign ready_o = open_i && !fill_q;
    assign valid_o = fill_q || (valid_i && fits);
    assign error_o = error_q;

    always @(posedge clk_i) begin
        if (passes) begin
            beat_q   <= last_q ? {BEAT_BITS{1'b0}} : beat_q + 1'b1;
            last_q   <= beat_q == BEFORE_LAST[BEAT_BITS-1:0];
            inside_q <= !last_q;
            start_q  <= last_q && !fill_q;
            if (last_q) fill_q <= 1'b0;
        end
        if (comes && !fits) begin
            fill_q  <= inside_q;
            start_q <= 1'b0;
        end
        error_q <= comes && !fits && (inside_q || start_q);
        if (rst_i) begin
            inside_q <= 1'b0;
            fill_q   <= 1'b0;
            start_q  <= 1'b0;
            error_q  <= 1'b0;
            beat_q   <= {BEAT_BITS{1'b0}};
            last_q   <= 1'b0;
        end
    end

endmodule

`default_nettype wire
