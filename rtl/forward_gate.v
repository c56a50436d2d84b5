// SPDX-License-Identifier: MIT OR Apache-2.0
// The output register of the pixels that leave: those of an active frame, zero otherwise.
`default_nettype none

module forward_gate #(
    parameter WIDTH = 8  // bits of a pixel
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             rst_i,      // synchronous reset, active high
    input  wire             step_i,     // a pixel comes out of the store
    input  wire             forward_i,  // its frame was active
    input  wire [WIDTH-1:0] pixel_i,    // that pixel
    output reg              valid_o,    // a pixel of an active frame leaves
    output reg  [WIDTH-1:0] pixel_o     // that pixel, else 0
);

    // Limits: out of them elaboration stops at a module that does not exist.
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
