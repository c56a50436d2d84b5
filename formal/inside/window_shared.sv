// SPDX-License-Identifier: MIT OR Apache-2.0
// A center steps with the pixel below and right of it. Borders apply only at the sides named by border_i.
`include "reset.vh"
localparam F_INNER = SIDE - 2;
reg [15:0] f_x, f_y;  // coordinates of the pixel that comes next
always @(posedge clk_i) begin
    if (rst_i) begin
        f_x <= 0;
        f_y <= 0;
    end else if (valid_i) begin
        f_x <= f_x == SIDE - 1 ? 0 : f_x + 1;
        if (f_x == SIDE - 1) f_y <= f_y == SIDE - 1 ? 0 : f_y + 1;
    end
end
// The center is that of pixel (f_x - 1, f_y - 1); (1, 1) is the first pixel of the region.
wire f_inside = f_x >= 2 && f_y >= 2;
wire [15:0] f_given = f_y < 2 ? 0 : (f_y - 2) * F_INNER + (f_x < 2 ? 0 : f_x - 2);  // number of centers before this pixel
always @* if (started) begin
    assert(f_x < SIDE && f_y < SIDE);
    assert(column_q == f_x && row_q == f_y);
    assert(advance_o == valid_i);
    assert(step_o == (valid_i && f_inside));
    assert(address_o == (f_given == F_INNER * F_INNER ? 0 : f_given));
    if (step_o) begin
        assert(last_o == (f_given == F_INNER * F_INNER - 1));
        assert(right_o == (border_i[1] && f_x - 1 == F_INNER));  // the center is in the last column
        assert(top_o == (border_i[2] && f_y - 1 == 1));
        assert(bottom_o == (border_i[3] && f_y - 1 == F_INNER));
    end
    // The column of the first center comes one pixel before it does.
    if (valid_i && f_x == 1 && f_y >= 2) begin
        assert(left_o == border_i[0]);
        assert(top_o == (border_i[2] && f_y - 1 == 1));
        assert(bottom_o == (border_i[3] && f_y - 1 == F_INNER));
    end
    if (valid_i && f_x > 1) assert(!left_o);
end
