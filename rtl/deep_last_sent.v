// SPDX-License-Identifier: MIT OR Apache-2.0
// Keeps the pixels of a region as they were when it was last active, for a tail that compares one clock before it counts
// (DEEP).
//
// The reference of a pixel is read in the clock of the comparison. The decision that may replace it comes with the count,
// one clock later, and the memory is written then. So the memory has a write port and a read port.
`default_nettype none

module deep_last_sent #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter PIXELS = 64,       // pixels of a region
    parameter ADDRESS_BITS = 6,  // ceil(log2(PIXELS))
    parameter BLANKS = 1         // 1: a region with SRS = 0 is blanked and loses its reference
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire [ADDRESS_BITS-1:0] address_i,  // number of the pixel that is compared
    input  wire [       WIDTH-1:0] pixel_i,    // the pixel with this number in the frame decided last, or about to be decided
    output wire [       WIDTH-1:0] sent_o,     // the pixel with this number that was sent last before that frame
    input  wire                    step_i,     // the pixel compared a clock ago is counted
    input  wire                    decided_i,  // a decision is made in this clock
    input  wire                    srs_i,      // SRS of that decision
    input  wire                    forward_i,  // the frame decided last is active, so that its pixels become the reference
    output wire                    valid_o     // the pixel that is counted has a valid reference
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (PIXELS < 2) begin : g_pixels PIXELS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(PIXELS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_PIXELS u_refused ();
        end
        if (BLANKS != 0 && BLANKS != 1) begin : g_blanks BLANKS_must_be_0_or_1 u_refused (); end
    endgenerate

    (* ram_style = "distributed" *)
    reg [WIDTH-1:0] pixels_q[0:PIXELS-1];
    reg [WIDTH-1:0] pixel_q;
    // The initial value keeps synthesis from moving this register into the memory's address port.
    reg [ADDRESS_BITS-1:0] address_q = {ADDRESS_BITS{1'b0}};
    reg valid_q;

    wire blanked = BLANKS != 0 && decided_i && !srs_i;

    assign sent_o  = pixels_q[address_i];
    assign valid_o = forward_i || (valid_q && !blanked);

    always @(posedge clk_i) begin
        pixel_q   <= pixel_i;
        address_q <= address_i;
        if (step_i && forward_i) pixels_q[address_q] <= pixel_q;
        if (rst_i) valid_q <= 1'b0;
        else valid_q <= valid_o;
    end

endmodule

`default_nettype wire
