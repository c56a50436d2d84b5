// SPDX-License-Identifier: MIT OR Apache-2.0
// A frame has FOLD * PIXELS pixels: the feed is ready until the last one is taken, and then not before the frame is done. The
// place is that of the pixel after the next one, and always inside a slot.
module properties #(parameter PIXELS = 16, parameter FOLD = 1) (input wire clk_i, rst_i, valid, reopen);
    `include "reset.vh"
    localparam WORD_BITS = $clog2(PIXELS), SLOT_BITS = FOLD > 1 ? $clog2(FOLD) : 1;
    localparam FRAME = PIXELS * FOLD;
    wire ready, open, last;
    wire [SLOT_BITS-1:0] slot;
    wire [WORD_BITS-1:0] word;
    serial_parallel_feed #(.PIXELS(PIXELS), .FOLD(FOLD), .WORD_BITS(WORD_BITS), .SLOT_BITS(SLOT_BITS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .reopen_i(reopen), .ready_o(ready), .open_o(open),
        .last_o(last), .slot_o(slot), .word_o(word)
    );
    always @* if (started && ready) assume(!reopen);  // the sequencer reopens only a closed feed
    reg [9:0] taken;
    reg closed;
    wire takes = valid && !closed;
    always @(posedge clk_i) begin
        if (rst_i) begin
            taken  <= 0;
            closed <= 0;
        end else begin
            if (takes) taken <= taken == FRAME - 1 ? 0 : taken + 1;
            if (takes && taken == FRAME - 1) closed <= 1;
            else if (reopen) closed <= 0;
        end
    end
    wire [9:0] place = closed ? 0 : taken == FRAME - 1 ? 0 : taken + 1;
    always @* if (started) begin
        assert(taken < FRAME);
        assert(!closed || taken == 0);
        assert(ready == !closed);
        assert(last == (takes && taken == FRAME - 1));
        assert(word == place % PIXELS);
        assert(slot == place / PIXELS);
        if (!rst_i) assert(open == (reopen || (ready && !last)));
    end
endmodule
