// SPDX-License-Identifier: MIT OR Apache-2.0
// The output register of a region's pixels. After each edge it holds the pixel of an active frame, otherwise zeros.
`default_nettype none

module forward_gate #(
    parameter WIDTH = 8  // bits of a pixel
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             rst_i,      // synchronous reset, active high
    input  wire             step_i,     // a pixel comes out of the store
    input  wire             forward_i,  // the frame of that pixel was active
    input  wire [WIDTH-1:0] pixel_i,    // the pixel that comes out of the store
    output reg              valid_o,    // a pixel of an active frame leaves
    output reg  [WIDTH-1:0] pixel_o     // the pixel that leaves, otherwise 0
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    always @(posedge clk_i) begin
        if (rst_i || !step_i || !forward_i) begin
            valid_o <= 1'b0;
            pixel_o <= {WIDTH{1'b0}};
        end else begin
            valid_o <= 1'b1;
            pixel_o <= pixel_i;
        end
    end

endmodule

`default_nettype wire
