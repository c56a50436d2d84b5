// SPDX-License-Identifier: MIT OR Apache-2.0
// Gives the displacements of `flow` one after the other, from the last in the order of the search to 0. The order of the
// search is by |dx| + |dy|, then by dy, then by dx (docs/contract.md, "Flow"). The outputs are those of the step of the
// same clock, except preceding_o.
//
// The weight of a displacement is a * a / ((SIDE - |dx|) * (SIDE - |dy|)), where SIDE is the side of a region in pixels, and a the least
// common multiple of SIDE and the RADIUS numbers below it. So sums over different numbers of pixels, times their weights, compare like
// their means.
`default_nettype none

module serial_flow #(
    parameter RADIUS = 1,           // largest |dx| and |dy|, 1 to 3
    parameter FACTOR_BITS = 4,      // bits of a factor
    parameter [(RADIUS+1)*FACTOR_BITS-1:0] FACTORS = 8'h87,  // a / (SIDE - i) for i = 0..RADIUS, the first in the lowest bits
    parameter COORDINATE_BITS = 2   // bits of dx and of dy, in two's complement
) (
    input  wire                         clk_i,      // clock, rising edge
    input  wire                         restart_i,  // the next displacement is the first one
    input  wire                         next_i,     // the displacement has been compared
    output wire [                  1:0] columns_o,  // |dx|
    output wire [                  1:0] rows_o,     // |dy|
    output wire                         right_o,    // dx is not negative
    output wire                         down_o,     // dy is not negative
    output wire                         last_o,     // the displacement is the last one, 0
    output wire [    2*FACTOR_BITS-1:0] weight_o,   // weight of the displacement
    output wire [2*COORDINATE_BITS-1:0] preceding_o    // the displacement that was compared last: {dy, dx}
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (RADIUS < 1 || RADIUS > 3) begin : g_radius RADIUS_must_be_1_to_3 u_refused (); end
        if (FACTOR_BITS < 1) begin : g_factor_bits FACTOR_BITS_must_be_1_or_more u_refused (); end
        if (COORDINATE_BITS != (RADIUS > 1 ? 3 : 2)) begin : g_coordinate_bits
            COORDINATE_BITS_must_hold_RADIUS u_refused ();
        end
    endgenerate

    localparam PLACES = (2 * RADIUS + 1) * (2 * RADIUS + 1);  // number of displacements
    localparam PLACE_BITS = $clog2(PLACES);
    localparam LAST = PLACES - 1;

    // Returns the displacement at a place of the search, as 8 * (dy + RADIUS) + dx + RADIUS.
    function integer displacement_at(input integer place);
        integer far, row, column, dy, dx, count;
        begin
            count = 0;
            displacement_at = 0;
            for (far = 2 * RADIUS; far >= 0; far = far - 1)
                for (row = 2 * RADIUS; row >= 0; row = row - 1)
                    for (column = 2 * RADIUS; column >= 0; column = column - 1) begin
                        dy = row - RADIUS;
                        dx = column - RADIUS;
                        if ((dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy) == far) begin
                            if (count == place) displacement_at = 8 * row + column;
                            count = count + 1;
                        end
                    end
        end
    endfunction

    reg [PLACE_BITS-1:0] place_q;
    assign last_o = place_q == LAST[PLACE_BITS-1:0];

    always @(posedge clk_i) begin
        if (restart_i) place_q <= {PLACE_BITS{1'b0}};
        else if (next_i && !last_o) place_q <= place_q + 1'b1;
    end

    // The displacements, by place. A place behind the last one is 0.
    wire [(1<<PLACE_BITS)*COORDINATE_BITS-1:0] table_x;
    wire [(1<<PLACE_BITS)*COORDINATE_BITS-1:0] table_y;

    genvar i;
    generate
        for (i = 0; i < (1 << PLACE_BITS); i = i + 1) begin : g_place
            localparam integer BOTH = displacement_at(i < PLACES ? i : LAST);
            localparam integer X = BOTH % 8 - RADIUS;
            localparam integer Y = BOTH / 8 - RADIUS;
            assign table_x[i*COORDINATE_BITS+:COORDINATE_BITS] = X[COORDINATE_BITS-1:0];
            assign table_y[i*COORDINATE_BITS+:COORDINATE_BITS] = Y[COORDINATE_BITS-1:0];
        end
    endgenerate

    wire [COORDINATE_BITS-1:0] x = table_x[place_q*COORDINATE_BITS+:COORDINATE_BITS];
    wire [COORDINATE_BITS-1:0] y = table_y[place_q*COORDINATE_BITS+:COORDINATE_BITS];
    wire left = x[COORDINATE_BITS-1];
    wire up = y[COORDINATE_BITS-1];

    assign columns_o = (x[1:0] ^ {2{left}}) + {1'b0, left};
    assign rows_o    = (y[1:0] ^ {2{up}}) + {1'b0, up};
    assign right_o   = !left;
    assign down_o    = !up;

    reg [2*COORDINATE_BITS-1:0] preceding_q;
    assign preceding_o = preceding_q;
    always @(posedge clk_i) if (next_i) preceding_q <= {y, x};

    // The weights, by {|dy|, |dx|}. One that is above RADIUS does not come.
    wire [16*2*FACTOR_BITS-1:0] weights;

    generate
        for (i = 0; i < 16; i = i + 1) begin : g_weight
            if (FACTOR_BITS > 0 && i / 4 <= RADIUS && i % 4 <= RADIUS) begin : g_product
                localparam [2*FACTOR_BITS-1:0] BY_ROW = {{FACTOR_BITS{1'b0}}, FACTORS[(i/4)*FACTOR_BITS+:FACTOR_BITS]};
                localparam [2*FACTOR_BITS-1:0] BY_COLUMN = {{FACTOR_BITS{1'b0}}, FACTORS[(i%4)*FACTOR_BITS+:FACTOR_BITS]};
                localparam [2*FACTOR_BITS-1:0] WEIGHT = BY_ROW * BY_COLUMN;
                assign weights[i*2*FACTOR_BITS+:2*FACTOR_BITS] = WEIGHT;
            end else begin : g_none
                assign weights[i*2*FACTOR_BITS+:2*FACTOR_BITS] = {2 * FACTOR_BITS{1'b0}};
            end
        end
    endgenerate

    wire [3:0] distance = {rows_o, columns_o};
    assign weight_o = weights[distance*2*FACTOR_BITS+:2*FACTOR_BITS];

endmodule

`default_nettype wire
