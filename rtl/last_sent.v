// SPDX-License-Identifier: MIT OR Apache-2.0
// The region as it was when it was last active. It is brought up to date as it is used: at each
// step the pixel of the frame decided last replaces the one kept, if that frame was active.
`default_nettype none

module last_sent #(
    parameter WIDTH = 8,      // bits of a pixel
    parameter PIXELS = 64,    // pixels of a region
    parameter SLOT_BITS = 6,  // ceil(log2(PIXELS))
    parameter BLANKS = 1      // 1: a region with SRS = 0 is blanked, so that nothing sent is left
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    input  wire                 step_i,
    input  wire [SLOT_BITS-1:0] slot_i,
    input  wire                 decided_i,    // a decision is made in this clock
    input  wire                 srs_i,        // its SRS
    input  wire                 forward_i,    // the frame decided last is active
    input  wire [    WIDTH-1:0] pixel_i,      // pixel of the frame decided last
    output wire [    WIDTH-1:0] reference_o,
    output wire                 valid_o       // there is a reference
);

    wire [WIDTH-1:0] kept;
    reg valid_q;

    frame_store #(.WIDTH(WIDTH), .PIXELS(PIXELS), .SLOT_BITS(SLOT_BITS)) u_kept (
        .clk_i(clk_i), .write_i(step_i), .slot_i(slot_i), .data_i(reference_o), .data_o(kept)
    );

    wire blanked = BLANKS != 0 && decided_i && !srs_i;

    assign reference_o = forward_i ? pixel_i : kept;
    assign valid_o = forward_i || (valid_q && !blanked);

    always @(posedge clk_i) begin
        if (rst_i) valid_q <= 1'b0;
        else valid_q <= valid_o;
    end

endmodule

`default_nettype wire
