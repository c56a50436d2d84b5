// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes frames for modules behind a window: steps with gaps anywhere, and `last_o` with the last of PIXELS steps.
module frames #(
    parameter PIXELS = 4
) (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire        step_i,
    output wire        last_o,
    output reg         done_o,   // one clock after the last step
    output reg  [15:0] place_o,  // place of the next step in its frame
    output reg  [15:0] seen_o    // number of steps of the frame; PIXELS while done_o
);
    `include "reset.vh"
    assign last_o = place_o == PIXELS - 1;
    always @(posedge clk_i) begin
        if (rst_i) begin
            done_o  <= 1'b0;
            place_o <= 16'd0;
            seen_o  <= 16'd0;
        end else begin
            done_o <= step_i && last_o;
            if (step_i) place_o <= last_o ? 16'd0 : place_o + 16'd1;
            seen_o <= (done_o ? 16'd0 : seen_o) + step_i;
        end
    end
    always @* if (started) begin
        assert(place_o < PIXELS);
        assert(seen_o == (done_o ? PIXELS : place_o));
        assert(!done_o || place_o == 16'd0);
    end
endmodule
