// SPDX-License-Identifier: MIT OR Apache-2.0
// Keeps the pixels of a region as they were when it was last active. The memory is updated as it is read: at each step the
// pixel of the frame decided last replaces the stored one, if that frame was active. Outputs are combinational.
`default_nettype none

module last_sent #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter PIXELS = 64,       // pixels of a region
    parameter ADDRESS_BITS = 6,  // ceil(log2(PIXELS))
    parameter BLANKS = 1         // 1: a region with SRS = 0 is blanked and loses its reference
) (
    input  wire                    clk_i,        // clock, rising edge
    input  wire                    rst_i,        // synchronous reset, active high
    input  wire                    step_i,       // a pixel enters the store
    input  wire [ADDRESS_BITS-1:0] address_i,    // address of that pixel in the store
    input  wire                    decided_i,    // a decision is made in this clock
    input  wire                    srs_i,        // SRS of that decision
    input  wire                    forward_i,    // the frame decided last is active
    input  wire [       WIDTH-1:0] pixel_i,      // pixel of the frame decided last
    output wire [       WIDTH-1:0] reference_o,  // reference of that pixel: its value when it was last sent
    output wire                    valid_o       // the region has a valid reference
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (BLANKS != 0 && BLANKS != 1) begin : g_blanks BLANKS_must_be_0_or_1 u_refused (); end
    endgenerate

    wire [WIDTH-1:0] sent;
    reg valid_q;

    frame_store #(.WIDTH(WIDTH), .PIXELS(PIXELS), .ADDRESS_BITS(ADDRESS_BITS)) u_sent (
        .clk_i(clk_i), .write_i(step_i), .address_i(address_i), .data_i(reference_o), .data_o(sent)
    );

    wire blanked = BLANKS != 0 && decided_i && !srs_i;

    assign reference_o = forward_i ? pixel_i : sent;
    assign valid_o = forward_i || (valid_q && !blanked);

    always @(posedge clk_i) begin
        if (rst_i) valid_q <= 1'b0;
        else valid_q <= valid_o;
    end

endmodule

`default_nettype wire
