// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the words beyond the right border of a frame: copies of the last pixel of the row. word_o belongs to the same step.
`default_nettype none

module raster_pad #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter LANES = 1,  // pixels of a word
    parameter REST = 0,   // pixels of the last word taken that are in the frame; 0: all of them
    parameter PADS = 0    // 1: the padded frame has words beyond the last one taken
) (
    input  wire                   clk_i,   // clock, rising edge
    input  wire                   step_i,  // the core advances
    input  wire                   pad_i,   // the core advances without taking a word
    input  wire                   end_i,   // the word is the last that is taken of its row
    input  wire [LANES*WIDTH-1:0] word_i,  // the word that is taken
    output wire [LANES*WIDTH-1:0] word_o   // the word of the padded frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (REST < 0 || REST >= LANES) begin : g_rest REST_must_be_0_to_LANES_less_1 u_refused (); end
    endgenerate

    wire [LANES*WIDTH-1:0] filled;
    genvar lane;
    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            if (REST != 0 && lane >= REST) begin : g_beyond
                assign filled[lane*WIDTH+:WIDTH] =
                    end_i ? word_i[(REST-1)*WIDTH+:WIDTH] : word_i[lane*WIDTH+:WIDTH];
            end else begin : g_inside
                assign filled[lane*WIDTH+:WIDTH] = word_i[lane*WIDTH+:WIDTH];
            end
        end

        if (REST == 0) begin : g_whole
            wire unused_end = end_i;
        end

        if (PADS) begin : g_pads
            reg [WIDTH-1:0] last_q;
            always @(posedge clk_i) if (step_i && !pad_i) last_q <= filled[(LANES-1)*WIDTH+:WIDTH];
            assign word_o = pad_i ? {LANES{last_q}} : filled;
        end else begin : g_none
            wire unused_inputs = clk_i || step_i || pad_i || end_i;
            assign word_o = filled;
        end
    endgenerate

endmodule

`default_nettype wire
