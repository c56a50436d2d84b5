// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes row and column of a region from its number, by a division by COLUMNS that gives one bit of the quotient per clock.
`default_nettype none

module packet_place #(
    parameter COLUMNS = 240,    // regions side by side, at least 2
    parameter COLUMN_BITS = 8,  // ceil(log2(COLUMNS))
    parameter REGION_BITS = 15  // bits of the number of a region, at least COLUMN_BITS
) (
    input  wire                               clk_i,     // clock, rising edge
    input  wire                               rst_i,     // synchronous reset, active high
    input  wire                               start_i,   // a division begins with region_i at this edge
    input  wire [            REGION_BITS-1:0] region_i,  // number of the region
    output wire                               busy_o,    // row_o and column_o are not yet those of the last region_i
    output wire [REGION_BITS-COLUMN_BITS:0]   row_o,     // row of the region
    output wire [            COLUMN_BITS-1:0] column_o   // column of the region
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
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
    reg [STEPS-1:0] digits_q;  // the remaining bits of the number, followed by the bits of the quotient
    reg [STEP_BITS-1:0] steps_q;
    wire [COLUMN_BITS:0] next = {rest_q, digits_q[STEPS-1]};
    wire fits = next >= DIVISOR[COLUMN_BITS:0];
    wire [COLUMN_BITS-1:0] less = next[COLUMN_BITS-1:0] - DIVISOR[COLUMN_BITS-1:0];

    // Bits of the quotient enter on the right while bits of the number leave on the left.
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
