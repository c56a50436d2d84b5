// SPDX-License-Identifier: MIT OR Apache-2.0
// A center steps with the pixel below and right of it; clamps apply only at the sides named by border.
module properties #(parameter SIDE = 10) (input wire clk_i, rst_i, valid, input wire [3:0] border);
    `include "reset.vh"
    localparam INNER = SIDE - 2;
    localparam SLOT_BITS = $clog2(INNER * INNER);
    wire advance, step, last, top, bottom, left, right;
    wire [SLOT_BITS-1:0] slot;
    window_shared #(.SIDE(SIDE), .SIDE_BITS($clog2(SIDE)), .SLOT_BITS(SLOT_BITS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .border_i(border), .advance_o(advance), .step_o(step),
        .slot_o(slot), .last_o(last), .top_o(top), .bottom_o(bottom), .left_o(left), .right_o(right)
    );
    reg [15:0] x, y;  // of the pixel that comes next
    always @(posedge clk_i) begin
        if (rst_i) begin
            x <= 0;
            y <= 0;
        end else if (valid) begin
            x <= x == SIDE - 1 ? 0 : x + 1;
            if (x == SIDE - 1) y <= y == SIDE - 1 ? 0 : y + 1;
        end
    end
    // The center is that of pixel (x - 1, y - 1); (1, 1) is the first of the region.
    wire inside = x >= 2 && y >= 2;
    wire [15:0] given = y < 2 ? 0 : (y - 2) * INNER + (x < 2 ? 0 : x - 2);  // centers before this pixel
    always @* if (started) begin
        assert(x < SIDE && y < SIDE);
        assert(advance == valid);
        assert(step == (valid && inside));
        assert(slot == (given == INNER * INNER ? 0 : given));
        if (step) begin
            assert(last == (given == INNER * INNER - 1));
            assert(right == (border[1] && x - 1 == INNER));  // center in the last column
            assert(top == (border[2] && y - 1 == 1));
            assert(bottom == (border[3] && y - 1 == INNER));
        end
        // The column of the first center comes one pixel before it does.
        if (valid && x == 1 && y >= 2) begin
            assert(left == border[0]);
            assert(top == (border[2] && y - 1 == 1));
            assert(bottom == (border[3] && y - 1 == INNER));
        end
        if (valid && x > 1) assert(!left);
    end
endmodule
