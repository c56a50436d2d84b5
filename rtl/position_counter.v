// SPDX-License-Identifier: MIT OR Apache-2.0
// Numbers the pixels of a region, for designs whose last stage before the store has no window.
`default_nettype none

module position_counter #(
    parameter PIXELS = 64,   // pixels of a region
    parameter SLOT_BITS = 6  // ceil(log2(PIXELS))
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    input  wire                 step_i,
    output wire [SLOT_BITS-1:0] slot_o,  // number of the pixel that steps
    output wire                 last_o   // it is the last of the frame
);

    localparam LAST = PIXELS - 1;

    // The initial value keeps synthesis from moving this register into the store's address port,
    // which would cost the store a second port.
    reg [SLOT_BITS-1:0] slot_q = {SLOT_BITS{1'b0}};

    always @(posedge clk_i) begin
        if (rst_i) slot_q <= {SLOT_BITS{1'b0}};
        else if (step_i) slot_q <= last_o ? {SLOT_BITS{1'b0}} : slot_q + 1'b1;
    end

    assign slot_o = slot_q;
    assign last_o = slot_q == LAST[SLOT_BITS-1:0];

endmodule

`default_nettype wire
