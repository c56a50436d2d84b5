// SPDX-License-Identifier: MIT OR Apache-2.0
// One control of the lanes, registered for a group of them: once, or twice where what it works on comes
// a clock later. A control that the design does not use has no register and is 0.
`default_nettype none

module serial_control #(
    parameter WIDTH = 1,  // bits of the control, at least 1
    parameter USED = 1,   // 0: the design does not use it
    parameter LATE = 0    // 1: registered twice
) (
    input  wire             clk_i,   // clock, rising edge
    input  wire             rst_i,   // synchronous reset, active high
    input  wire [WIDTH-1:0] bits_i,  // from the sequencer
    output wire [WIDTH-1:0] bits_o   // to the lanes
);

    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end

        if (USED == 0) begin : g_unused
            wire unused_inputs = clk_i && rst_i && |bits_i;
            assign bits_o = {WIDTH{1'b0}};
        end else begin : g_used
            reg [WIDTH-1:0] bits_q;

            always @(posedge clk_i) begin
                if (rst_i) bits_q <= {WIDTH{1'b0}};
                else bits_q <= bits_i;
            end

            if (LATE != 0) begin : g_late
                reg [WIDTH-1:0] late_q;

                always @(posedge clk_i) begin
                    if (rst_i) late_q <= {WIDTH{1'b0}};
                    else late_q <= bits_q;
                end
                assign bits_o = late_q;
            end else begin : g_at_once
                assign bits_o = bits_q;
            end
        end
    endgenerate

endmodule

`default_nettype wire
