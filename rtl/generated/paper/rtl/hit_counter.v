// SPDX-License-Identifier: MIT OR Apache-2.0
// Counts the hits of a frame. In the clock after a frame's last step count_o is the count of that frame. The edge that ends
// this clock restarts the count, with the first hit of the next frame if it comes at that edge.
`default_nettype none

module hit_counter #(
    parameter WIDTH = 7  // bits of the count
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             rst_i,      // synchronous reset, active high
    input  wire             restart_i,  // the count is that of a whole frame
    input  wire             hit_i,      // adds one to the count
    output reg  [WIDTH-1:0] count_o     // hits so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    wire [WIDTH-1:0] hit = {{(WIDTH - 1) {1'b0}}, hit_i};

    always @(posedge clk_i) begin
        if (rst_i) count_o <= {WIDTH{1'b0}};
        else if (restart_i) count_o <= hit;
        else count_o <= count_o + hit;
    end

endmodule

`default_nettype wire
