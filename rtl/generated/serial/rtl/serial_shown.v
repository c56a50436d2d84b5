// SPDX-License-Identifier: MIT OR Apache-2.0
// What the ports say beside scores and pixels, as late as the lanes are.
`default_nettype none

module serial_shown #(
    parameter WIDTH = 12,  // bits that are shown together
    parameter BLOCK = 0    // 1: a word comes a clock after its address
) (
    input  wire             clk_i,   // clock, rising edge
    input  wire             rst_i,   // synchronous reset, active high
    input  wire [WIDTH-1:0] bits_i,  // from the sequencer
    output wire [WIDTH-1:0] bits_o   // at the ports
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    // The initial values keep synthesis from moving these registers into a memory's address port.
    reg [WIDTH-1:0] bits_q = {WIDTH{1'b0}};

    always @(posedge clk_i) begin
        if (rst_i) bits_q <= {WIDTH{1'b0}};
        else bits_q <= bits_i;
    end

    generate
        if (BLOCK != 0) begin : g_late
            reg [WIDTH-1:0] late_q = {WIDTH{1'b0}};
            always @(posedge clk_i) begin
                if (rst_i) late_q <= {WIDTH{1'b0}};
                else late_q <= bits_q;
            end
            assign bits_o = late_q;
        end else begin : g_at_once
            assign bits_o = bits_q;
        end
    endgenerate

endmodule

`default_nettype wire
