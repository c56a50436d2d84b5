// SPDX-License-Identifier: MIT OR Apache-2.0
// Row and column of a region from its number: a division by the regions of a row, a bit of the quotient at a clock.
`default_nettype none

module packet_place #(
    parameter COLUMNS = 240,    // regions side by side, at least 2
    parameter COLUMN_BITS = 8,  // ceil(log2(COLUMNS))
    parameter REGION_BITS = 15  // bits of the number of a region, at least COLUMN_BITS
) (
    input  wire                               clk_i,     // clock, rising edge
    input  wire                               rst_i,     // synchronous reset, active high
    input  wire                               start_i,   // begins with this number
    input  wire [            REGION_BITS-1:0] region_i,  // that number
    output wire                               busy_o,    // row and column are not yet those of the number given last
    output wire [REGION_BITS-COLUMN_BITS:0]   row_o,     // the row of regions
    output wire [            COLUMN_BITS-1:0] column_o   // the column
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (COLUMNS < 2) begin : g_columns COLUMNS_must_be_2_or_more u_refused (); end
        if (COLUMN_BITS != $clog2(COLUMNS)) begin : g_column_bits COLUMN_BITS_must_be_clog2_of_COLUMNS u_refused (); end
        if (REGION_BITS < COLUMN_BITS) begin : g_region_bits REGION_BITS_must_be_COLUMN_BITS_or_more u_refused (); end
    endgenerate

    // The highest COLUMN_BITS - 1 bits of a number are less than COLUMNS, so they are the first remainder.
    localparam STEPS = REGION_BITS - COLUMN_BITS + 1;
    localparam STEP_BITS = $clog2(STEPS + 1);
    localparam DIVISOR = COLUMNS;

    reg [COLUMN_BITS-1:0] rest_q;
    reg [STEPS-1:0] digits_q;  // bits of the number that are left, and behind them those of the quotient
    reg [STEP_BITS-1:0] steps_q;
    wire [COLUMN_BITS:0] next = {rest_q, digits_q[STEPS-1]};
    wire fits = next >= DIVISOR[COLUMN_BITS:0];
    wire [COLUMN_BITS-1:0] less = next[COLUMN_BITS-1:0] - DIVISOR[COLUMN_BITS-1:0];

    // The quotient comes from the right as the number leaves on the left.
    wire [STEPS:0] moved = {digits_q, fits};
    wire unused_digit = moved[STEPS];

    always @(posedge clk_i) begin
        if (start_i) begin
            {rest_q, digits_q} <= {1'b0, region_i};
            steps_q            <= STEPS[STEP_BITS-1:0];
        end else if (busy_o) begin
            rest_q   <= fits ? less : next[COLUMN_BITS-1:0];
            digits_q <= moved[STEPS-1:0];
            steps_q  <= steps_q - 1'b1;
        end
        if (rst_i) steps_q <= {STEP_BITS{1'b0}};
    end

    assign busy_o = steps_q != {STEP_BITS{1'b0}};
    assign row_o = digits_q;
    assign column_o = rest_q;

endmodule

`default_nettype wire
