// SPDX-License-Identifier: MIT OR Apache-2.0
// Delays a word by DEPTH clocks. It has no reset.
`default_nettype none

module word_delay #(
    parameter WIDTH = 8,  // bits of a word
    parameter DEPTH = 4   // clocks from data_i to data_o; 0 is a wire
) (
    input  wire             clk_i,   // clock, rising edge
    input  wire [WIDTH-1:0] data_i,  // the word that enters
    output wire [WIDTH-1:0] data_o   // data_i of DEPTH clocks ago
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (DEPTH < 0) begin : g_depth DEPTH_must_be_0_or_more u_refused (); end

        if (DEPTH == 0) begin : g_none
            wire unused_clock = clk_i;
            assign data_o = data_i;
        end else if (DEPTH == 1) begin : g_one
            reg [WIDTH-1:0] data_q;
            always @(posedge clk_i) data_q <= data_i;
            assign data_o = data_q;
        end else begin : g_some
            reg [WIDTH*DEPTH-1:0] line_q;
            always @(posedge clk_i) line_q <= {line_q[WIDTH*(DEPTH-1)-1:0], data_i};
            assign data_o = line_q[WIDTH*(DEPTH-1)+:WIDTH];
        end
    endgenerate

endmodule

`default_nettype wire
