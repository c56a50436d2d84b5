// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the binomial means of 3x3 windows for every pixel of a word at once: the sum of the pixels with the weights 1, 2, 1 in
// both directions plus 8, divided by 16. The result comes three clocks after its step, with DEEP six, as that of
// median_columns.v.
//
// Each column is added up once, when it comes in, together with 2. The weights of the three columns are 4 in all, which makes 8.
`default_nettype none

module binomial_columns #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter LANES = 1,  // pixels of a word
    parameter DEEP = 0    // 0: the result comes three clocks after its step; 1: six clocks
) (
    input  wire                   clk_i,     // clock, rising edge
    input  wire                   step_i,    // columns come in; the centers are the columns of the step before
    input  wire                   left_i,    // the first center has nothing on its left
    input  wire                   right_i,   // the last center has nothing on its right
    input  wire                   top_i,     // the incoming columns have nothing at the top: upper_i may hold any word
    input  wire                   bottom_i,  // the incoming columns have nothing at the bottom: lower_i may hold any word
    input  wire [LANES*WIDTH-1:0] upper_i,   // upper pixels of the incoming columns
    input  wire [LANES*WIDTH-1:0] middle_i,  // middle pixels of the incoming columns
    input  wire [LANES*WIDTH-1:0] lower_i,   // lower pixels of the incoming columns
    output wire [LANES*WIDTH-1:0] mean_o     // binomial means of the centers, one per pixel of the word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LANES < 1) begin : g_lanes LANES_must_be_1_or_more u_refused (); end
    endgenerate

    localparam COLUMN = WIDTH + 2;  // bits of the sum of a column, which is at most 4 * (2^WIDTH - 1) + 2
    localparam TOTAL = WIDTH + 4;   // bits of the sum of a window

    // The sums of the columns: of the newest word, of the centers, and of the one on their left.
    wire column_step, column_left, column_right;
    wire [LANES*COLUMN-1:0] incoming;
    reg [LANES*COLUMN-1:0] newest_q, center_q;
    reg [COLUMN-1:0] left_q;
    reg no_left_q, no_right_q;
    word_delay #(.WIDTH(3), .DEPTH(DEEP)) u_step (
        .clk_i(clk_i), .data_i({step_i, left_i, right_i}), .data_o({column_step, column_left, column_right})
    );
    always @(posedge clk_i) begin
        if (column_step) begin
            newest_q   <= incoming;
            center_q   <= newest_q;
            left_q     <= center_q[(LANES-1)*COLUMN+:COLUMN];
            no_left_q  <= column_left;
            no_right_q <= column_right;
        end
    end
    wire [COLUMN-1:0] first = no_left_q ? center_q[COLUMN-1:0] : left_q;
    wire [COLUMN-1:0] last = no_right_q ? center_q[(LANES-1)*COLUMN+:COLUMN] : newest_q[COLUMN-1:0];
    wire [(LANES+2)*COLUMN-1:0] columns = {last, center_q, first};

    genvar lane;
    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            wire [WIDTH-1:0] center = middle_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] top = top_i ? center : upper_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] bottom = bottom_i ? center : lower_i[lane*WIDTH+:WIDTH];
            wire [WIDTH:0] outer;
            wire [WIDTH-1:0] middle;
            word_delay #(.WIDTH(2 * WIDTH + 1), .DEPTH(DEEP)) u_outer (
                .clk_i(clk_i), .data_i({{1'b0, top} + {1'b0, bottom}, center}), .data_o({outer, middle})
            );
            // The 2 is a carry into the second bit.
            carry_adder #(.WIDTH(COLUMN - 1)) u_column (
                .plain_i({1'b0, middle}), .other_i({1'b0, outer[WIDTH:1]}), .carry_i(1'b1),
                .sum_o(incoming[lane*COLUMN+1+:COLUMN-1])
            );
            assign incoming[lane*COLUMN] = outer[0];

            reg [COLUMN:0] sides_q;
            reg [COLUMN-1:0] center_2q;
            wire [TOTAL-1:0] total = {1'b0, sides_q} + {1'b0, center_2q, 1'b0};
            wire unused_remainder = |total[3:0];
            always @(posedge clk_i) begin
                sides_q   <= {1'b0, columns[lane*COLUMN+:COLUMN]} + {1'b0, columns[(lane+2)*COLUMN+:COLUMN]};
                center_2q <= columns[(lane+1)*COLUMN+:COLUMN];
            end
            word_delay #(.WIDTH(WIDTH), .DEPTH(DEEP ? 3 : 1)) u_mean (
                .clk_i(clk_i), .data_i(total[4+:WIDTH]), .data_o(mean_o[lane*WIDTH+:WIDTH])
            );
        end
    endgenerate

endmodule

`default_nettype wire
