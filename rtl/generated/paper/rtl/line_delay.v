// SPDX-License-Identifier: MIT OR Apache-2.0
// Delays a word by DEPTH advances. It has no reset, so that it maps to shift-register LUTs.
`default_nettype none

module line_delay #(
    parameter WIDTH = 8,  // bits of one word
    parameter DEPTH = 8   // advances from data_i to data_o, at least 1
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             advance_i,  // the line moves by one word
    input  wire [WIDTH-1:0] data_i,     // the word that enters
    output wire [WIDTH-1:0] data_o      // data_i of DEPTH advances ago
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (DEPTH < 1) begin : g_depth DEPTH_must_be_1_or_more u_refused (); end
    endgenerate

    generate
        if (DEPTH == 1) begin : g_one
            reg [WIDTH-1:0] word_q;
            always @(posedge clk_i) if (advance_i) word_q <= data_i;
            assign data_o = word_q;
        end else begin : g_some
            reg [WIDTH*DEPTH-1:0] line_q;
            always @(posedge clk_i) begin
                if (advance_i) line_q <= {line_q[WIDTH*(DEPTH-1)-1:0], data_i};
            end
            assign data_o = line_q[WIDTH*(DEPTH-1)+:WIDTH];
        end
    endgenerate

endmodule

`default_nettype wire
