// SPDX-License-Identifier: MIT OR Apache-2.0
// Numbers the pixels of a region, for designs whose last stage before the store has no window. address_o is the number of
// the pixel of this step.
`default_nettype none

module position_counter #(
    parameter PIXELS = 64,      // pixels of a region
    parameter ADDRESS_BITS = 6  // ceil(log2(PIXELS))
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    step_i,     // a pixel enters the store
    output wire [ADDRESS_BITS-1:0] address_o,  // number of the pixel of this step
    output wire                    last_o      // the pixel is the last of the frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (PIXELS < 2) begin : g_pixels PIXELS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(PIXELS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_PIXELS u_refused ();
        end
    endgenerate

    localparam LAST = PIXELS - 1;

    // The initial value keeps synthesis from moving this register into the address port of the store, which would give the
    // store a second port.
    reg [ADDRESS_BITS-1:0] address_q = {ADDRESS_BITS{1'b0}};

    always @(posedge clk_i) begin
        if (rst_i) address_q <= {ADDRESS_BITS{1'b0}};
        else if (step_i) address_q <= last_o ? {ADDRESS_BITS{1'b0}} : address_q + 1'b1;
    end

    assign address_o = address_q;
    assign last_o = address_q == LAST[ADDRESS_BITS-1:0];

endmodule

`default_nettype wire
