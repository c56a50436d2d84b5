// SPDX-License-Identifier: MIT OR Apache-2.0
// The requested word is the one that was stored at its place in the frame before. Words are stored in the order of requests,
// 1 + DEEP clocks later, with gaps of any length; between two frames there are a few clocks.
module properties #(
    parameter WORDS = 7, parameter DEEP = 0
) (
    input wire clk_i, rst_i, step, input wire word
);
    `include "reset.vh"
    localparam PAUSE = 6;
    reg [3:0] asked = 4'd0;  // number of the requested word
    reg [2:0] pause = 3'd0;  // clocks until the next frame may begin
    reg frames = 1'b0;       // a frame has been stored since reset
    wire ask = step && pause == 3'd0;
    wire [DEEP:0] late;
    reg [DEEP:0] late_q = 0;
    always @(posedge clk_i) late_q <= rst_i ? 0 : {late_q, ask};
    assign late = late_q;
    wire store = late[DEEP];

    wire reference;
    raster_pairs #(.WORD_BITS(1), .WORDS(WORDS), .DEEP(DEEP)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .read_i(ask), .reference_o(reference), .write_i(store), .word_i(word)
    );

    (* anyconst *) wire [3:0] place;
    always @* assume(place < WORDS);
    reg [3:0] stored = 4'd0;  // number of the stored word
    reg last, kept;  // the word stored at the place, in this frame or the one before; the word of the frame before
    always @(posedge clk_i) begin
        if (ask) begin
            asked <= asked == WORDS - 1 ? 4'd0 : asked + 4'd1;
            if (asked == WORDS - 1) begin
                pause <= PAUSE;
                frames <= 1'b1;
            end
            if (asked == place) kept <= last;
        end
        if (pause != 3'd0) pause <= pause - 3'd1;
        if (store) begin
            stored <= stored == WORDS - 1 ? 4'd0 : stored + 4'd1;
            if (stored == place) last <= word;
        end
        if (rst_i) begin
            asked <= 4'd0;
            stored <= 4'd0;
            pause <= 3'd0;
            frames <= 1'b0;
        end
    end

    // 1 + DEEP clocks after the request.
    reg [DEEP:0] shown = 0;
    always @(posedge clk_i) shown <= rst_i ? 0 : {shown, ask && asked == place && frames};
    always @* if (shown[DEEP]) assert(reference == kept);
endmodule
