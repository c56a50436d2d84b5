// SPDX-License-Identifier: MIT OR Apache-2.0
// The displacements come in the opposite order of the preference in docs/contract.md, each once, and stop at 0. A weight times the number
// of pairs of pixels is the same for all of them.
module properties #(parameter RADIUS = 1, parameter BITS = 2, parameter SIDE = 8, parameter FACTOR_BITS = 4, parameter FACTORS = 135) (
    input wire clk_i, rst_i, next
);
    `include "reset.vh"
    localparam PLACES = (2 * RADIUS + 1) * (2 * RADIUS + 1);
    localparam [31:0] ALL_FACTORS = FACTORS;
    wire [1:0] columns, rows;
    wire right, down, last;
    wire [2*FACTOR_BITS-1:0] weight;
    wire [2*BITS-1:0] preceding;
    serial_flow #(
        .RADIUS(RADIUS), .FACTOR_BITS(FACTOR_BITS), .FACTORS(ALL_FACTORS[(RADIUS+1)*FACTOR_BITS-1:0]), .COORDINATE_BITS(BITS)
    ) dut (
        .clk_i(clk_i), .restart_i(rst_i), .next_i(next), .columns_o(columns), .rows_o(rows), .right_o(right), .down_o(down),
        .last_o(last), .weight_o(weight), .preceding_o(preceding)
    );
    wire signed [4:0] dx = right ? columns : -columns;
    wire signed [4:0] dy = down ? rows : -rows;
    reg [5:0] passed;
    reg signed [4:0] dx_before, dy_before;
    reg [2:0] far_before;
    reg any;  // there is a displacement before
    always @(posedge clk_i) begin
        if (rst_i) begin
            passed <= 0;
            any    <= 0;
        end else if (next) begin
            if (passed != PLACES - 1) passed <= passed + 1;
            any        <= 1;
            dx_before  <= dx;
            dy_before  <= dy;
            far_before <= columns + rows;
        end
    end
    wire [2:0] far = columns + rows;
    wire nearer = far < far_before || (far == far_before && (dy < dy_before || (dy == dy_before && dx < dx_before)));
    always @* if (started) begin
        assert(columns <= RADIUS && rows <= RADIUS);
        if (passed == 0) assert(columns == RADIUS && rows == RADIUS && right && down);
        assert(last == (passed == PLACES - 1));
        if (last) assert(far == 0);
        if (any) begin
            assert(preceding == {dy_before[BITS-1:0], dx_before[BITS-1:0]});
            assert(nearer || (far == 0 && far_before == 0));
        end
        assert(weight * (SIDE - columns) * (SIDE - rows) == ALL_FACTORS[FACTOR_BITS-1:0] * ALL_FACTORS[FACTOR_BITS-1:0] * SIDE * SIDE);
    end
endmodule
