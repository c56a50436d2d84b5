// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the scene of pattern_source for an array of RPUs (docs/boards.md): every region gets one of its pixels at each clock.
// Values that depend on a column or on a row alone are computed once for it, and each register has one addition or selection
// in front of it. The first pixels come three clocks after reset.
`default_nettype none

module array_pattern #(
    parameter COLUMNS = 4,   // regions in a row of regions
    parameter ROWS = 3,      // rows of regions
    parameter SIDE = 8,      // pixels of a side of a region, 2 to 64
    parameter SIDE_BITS = 3  // ceil(log2(SIDE))
) (
    input  wire                      clk_i,    // clock, rising edge
    input  wire                      rst_i,    // synchronous reset, active high
    output wire                      valid_o,  // pixels are on pixel_o; always 1 from three clocks after reset on
    output wire [COLUMNS*ROWS*8-1:0] pixel_o,  // one pixel per region, row by row; element i is of region i
    output wire                      soon_o    // the first pixel of a frame comes two clocks from now
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (SIDE < 2 || SIDE > 64) begin : g_side SIDE_must_be_2_to_64 u_refused (); end
        if (SIDE_BITS != $clog2(SIDE)) begin : g_side_bits SIDE_BITS_must_be_clog2_of_SIDE u_refused (); end
    endgenerate

    // Counters: the place in every region, and values at that place in the upper left region. All count modulo 2^9 or less.
    localparam LAST = SIDE - 1;
    reg [SIDE_BITS-1:0] column_q, line_q;  // u and v
    reg first_q;                           // u and v are both 0
    reg [8:0] x_q;                         // u
    reg [7:0] y_q;                         // v
    reg [7:0] mix_x_q, mix_y_q;            // 5 u; 19 v
    reg [6:0] right_q, start_q;            // u - 3 t; -3 t
    reg [6:0] down_q, top_q;               // v - t; -t
    wire line_ends = column_q == LAST[SIDE_BITS-1:0];
    wire frame_ends = line_ends && line_q == LAST[SIDE_BITS-1:0];
    wire [6:0] next_start = frame_ends ? start_q - 7'd3 : start_q;
    always @(posedge clk_i) begin
        first_q  <= frame_ends;
        column_q <= column_q + 1'b1;
        x_q      <= x_q + 1'b1;
        mix_x_q  <= mix_x_q + 8'd5;
        right_q  <= right_q + 1'b1;
        if (line_ends) begin
            column_q <= {SIDE_BITS{1'b0}};
            line_q   <= frame_ends ? {SIDE_BITS{1'b0}} : line_q + 1'b1;
            x_q      <= 9'd0;
            y_q      <= frame_ends ? 8'd0 : y_q + 1'b1;
            mix_x_q  <= 8'd0;
            mix_y_q  <= frame_ends ? 8'd0 : mix_y_q + 8'd19;
            right_q  <= next_start;
            start_q  <= next_start;
            down_q   <= frame_ends ? top_q - 1'b1 : down_q + 1'b1;
            if (frame_ends) top_q <= top_q - 1'b1;
        end
        if (rst_i) begin
            first_q  <= 1'b1;
            column_q <= {SIDE_BITS{1'b0}};
            line_q   <= {SIDE_BITS{1'b0}};
            x_q      <= 9'd0;
            y_q      <= 8'd0;
            mix_x_q  <= 8'd0;
            mix_y_q  <= 8'd0;
            right_q  <= 7'd0;
            start_q  <= 7'd0;
            down_q   <= 7'd0;
            top_q    <= 7'd0;
        end
    end

    // The stages behind the counters that hold something.
    reg second_q, third_q, fourth_q, soon_q;
    always @(posedge clk_i) begin
        second_q <= 1'b1;
        third_q  <= second_q;
        fourth_q <= third_q;
        soon_q   <= first_q;
        if (rst_i) begin
            second_q <= 1'b0;
            third_q  <= 1'b0;
            fourth_q <= 1'b0;
            soon_q   <= 1'b0;
        end
    end
    assign valid_o = fourth_q;
    assign soon_o = soon_q;

    // The second stage: values of each column of regions and of each row of regions.
    wire [COLUMNS*9-1:0] column_x;
    wire [COLUMNS*8-1:0] column_mix;
    wire [COLUMNS-1:0] column_square;
    wire [ROWS*8-1:0] row_y, row_mix;
    wire [ROWS-1:0] row_square;
    genvar row, column;
    generate
        for (column = 0; column < COLUMNS; column = column + 1) begin : g_of_column
            localparam X = column * SIDE;
            localparam MIX = 5 * X;
            reg [8:0] own_x_q;
            reg [7:0] own_mix_q;
            reg own_square_q;
            wire [6:0] right = right_q + X[6:0];
            wire unused_right = |right[3:0];
            always @(posedge clk_i) begin
                own_x_q      <= x_q + X[8:0];
                own_mix_q    <= mix_x_q + MIX[7:0];
                own_square_q <= right[6:4] == 3'd0;
            end
            assign column_x[column*9+:9] = own_x_q;
            assign column_mix[column*8+:8] = own_mix_q;
            assign column_square[column] = own_square_q;
        end
        for (row = 0; row < ROWS; row = row + 1) begin : g_of_row
            localparam Y = row * SIDE;
            localparam MIX = 19 * Y;
            reg [7:0] own_y_q, own_mix_q;
            reg own_square_q;
            wire [6:0] down = down_q + Y[6:0];
            wire unused_down = |down[3:0];
            always @(posedge clk_i) begin
                own_y_q      <= y_q + Y[7:0];
                own_mix_q    <= mix_y_q + MIX[7:0];
                own_square_q <= down[6:4] == 3'd0;
            end
            assign row_y[row*8+:8] = own_y_q;
            assign row_mix[row*8+:8] = own_mix_q;
            assign row_square[row] = own_square_q;
        end

        // The third and the fourth stage: values of each region, and its pixel.
        for (row = 0; row < ROWS; row = row + 1) begin : g_row
            for (column = 0; column < COLUMNS; column = column + 1) begin : g_column
                localparam REGION = row * COLUMNS + column;
                wire [8:0] x = column_x[column*9+:9];
                wire [7:0] y = row_y[row*8+:8];
                wire [8:0] ramp = x + {y, 1'b0};
                wire unused_ramp = |ramp[1:0];
                reg [6:0] gradient_q;
                reg [7:0] mix_q;
                reg [5:0] both_q;
                reg square_q, textured_q;
                wire [5:0] hash = mix_q[5:0] ^ {1'b0, mix_q[7:3]} ^ both_q;
                reg [7:0] pixel_q;
                always @(posedge clk_i) begin
                    gradient_q <= ramp[8:2];
                    mix_q      <= column_mix[column*8+:8] + row_mix[row*8+:8];
                    both_q     <= x[5:0] & y[5:0];
                    square_q   <= column_square[column] && row_square[row];
                    textured_q <= (x[7:6] ^ y[7:6]) == 2'd3;
                    if (square_q) pixel_q <= {3'b111, hash[4:0]};
                    else if (textured_q) pixel_q <= {2'b00, gradient_q[6:1]} + {2'b00, hash};
                    else pixel_q <= {1'b0, gradient_q};
                end
                assign pixel_o[REGION*8+:8] = pixel_q;
            end
        end
    endgenerate

endmodule

`default_nettype wire
