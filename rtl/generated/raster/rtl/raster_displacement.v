// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares every pixel of a word with four of its neighbors, those on the right, below, on the lower right and on the lower left,
// and adds the absolute differences up over the word. The four values come four clocks after their step, with DEEP five.
//
// A missing neighbor is a copy of a pixel of the center's column.
`default_nettype none

module raster_displacement #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter LANES = 1,       // pixels of a word: 1, 2 or 4
    parameter VALUE_BITS = 8,  // bits of a value: WIDTH + log2(LANES)
    parameter DEEP = 0         // 0: values come four clocks after their step; 1: five clocks
) (
    input  wire                    clk_i,     // clock, rising edge
    input  wire                    step_i,    // columns come in; the centers are the columns of the step before
    input  wire                    left_i,    // the first center has nothing on its left
    input  wire                    right_i,   // the last center has nothing on its right
    input  wire                    bottom_i,  // the incoming columns have nothing at the bottom: lower_i may hold any word
    input  wire [ LANES*WIDTH-1:0] middle_i,  // middle pixels of the incoming columns
    input  wire [ LANES*WIDTH-1:0] lower_i,   // lower pixels of the incoming columns
    output wire [4*VALUE_BITS-1:0] values_o   // sums of the differences: right lowest, then lower, lower right, lower left
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (LANES != 1 && LANES != 2 && LANES != 4) begin : g_lanes LANES_must_be_1_2_or_4 u_refused (); end
        if (VALUE_BITS != WIDTH + $clog2(LANES)) begin : g_value_bits
            VALUE_BITS_must_hold_LANES_pixels u_refused ();
        end
    endgenerate

    // The columns {lower, middle}: of the newest word, of the centers, and the lower pixel of the one on their left.
    localparam COLUMN = 2 * WIDTH;
    reg [LANES*COLUMN-1:0] newest_q, center_q;
    reg [WIDTH-1:0] left_q;
    reg no_left_q, no_right_q;
    integer each;
    always @(posedge clk_i) begin
        if (step_i) begin
            for (each = 0; each < LANES; each = each + 1)
                newest_q[each*COLUMN+:COLUMN] <= {
                    bottom_i ? middle_i[each*WIDTH+:WIDTH] : lower_i[each*WIDTH+:WIDTH], middle_i[each*WIDTH+:WIDTH]
                };
            center_q   <= newest_q;
            left_q     <= center_q[LANES*COLUMN-1-:WIDTH];
            no_left_q  <= left_i;
            no_right_q <= right_i;
        end
    end
    wire [WIDTH-1:0] preceding = no_left_q ? center_q[WIDTH+:WIDTH] : left_q;
    wire [COLUMN-1:0] following = no_right_q ? center_q[(LANES-1)*COLUMN+:COLUMN] : newest_q[COLUMN-1:0];
    wire [(LANES+1)*COLUMN-1:0] columns = {following, center_q};

    // With DEEP the values of a word with four pixels are added up in two steps, over halves of the word first.
    localparam PARTS = DEEP && LANES == 4 ? 2 : 1;
    localparam PART_LANES = LANES / PARTS;
    genvar way, lane, part;
    generate
        for (way = 0; way < 4; way = way + 1) begin : g_way
            wire [LANES*WIDTH-1:0] differences;
            for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
                wire [WIDTH-1:0] center = columns[lane*COLUMN+:WIDTH];
                wire [WIDTH-1:0] neighbor;
                if (way == 0) begin : g_right
                    assign neighbor = columns[(lane+1)*COLUMN+:WIDTH];
                end else if (way == 1) begin : g_lower
                    assign neighbor = columns[lane*COLUMN+WIDTH+:WIDTH];
                end else if (way == 2) begin : g_lower_right
                    assign neighbor = columns[(lane+1)*COLUMN+WIDTH+:WIDTH];
                end else if (lane == 0) begin : g_lower_before
                    assign neighbor = preceding;
                end else begin : g_lower_left
                    assign neighbor = columns[(lane-1)*COLUMN+WIDTH+:WIDTH];
                end

                // The bits of a negative difference are inverted, which gives one less than its magnitude.
                reg [WIDTH:0] difference_q;
                reg [WIDTH-1:0] magnitude_q;
                wire negative = difference_q[WIDTH];
                wire [WIDTH-1:0] inverted = difference_q[WIDTH-1:0] ^ {WIDTH{negative}};
                always @(posedge clk_i) begin
                    difference_q <= {1'b0, center} - {1'b0, neighbor};
                    magnitude_q  <= inverted + {{(WIDTH - 1) {1'b0}}, negative};
                end
                assign differences[lane*WIDTH+:WIDTH] = magnitude_q;
            end

            wire [PARTS*VALUE_BITS-1:0] sums, parts;
            for (part = 0; part < PARTS; part = part + 1) begin : g_part
                integer i;
                reg [VALUE_BITS-1:0] sum;
                always @* begin
                    sum = {VALUE_BITS{1'b0}};
                    for (i = part * PART_LANES; i < (part + 1) * PART_LANES; i = i + 1)
                        sum = sum + {{(VALUE_BITS - WIDTH) {1'b0}}, differences[i*WIDTH+:WIDTH]};
                end
                assign sums[part*VALUE_BITS+:VALUE_BITS] = sum;
            end
            word_delay #(.WIDTH(PARTS * VALUE_BITS), .DEPTH(DEEP)) u_parts (
                .clk_i(clk_i), .data_i(sums), .data_o(parts)
            );
            reg [VALUE_BITS-1:0] value_q;
            always @(posedge clk_i)
                value_q <= parts[VALUE_BITS-1:0] + (PARTS == 2 ? parts[PARTS*VALUE_BITS-1-:VALUE_BITS] : {VALUE_BITS{1'b0}});
            assign values_o[way*VALUE_BITS+:VALUE_BITS] = value_q;
        end
    endgenerate

endmodule

`default_nettype wire
