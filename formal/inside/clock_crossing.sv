// SPDX-License-Identifier: MIT OR Apache-2.0
// A counter that the other clock samples changes by at most one bit at an edge of its own clock.
reg [DEPTH_BITS:0] f_write_before, f_read_before;
initial {f_write_before, f_read_before} = 0;
always @(posedge write_clk_i) f_write_before <= write_gray_q;
always @(posedge read_clk_i) f_read_before <= read_gray_q;
wire [DEPTH_BITS:0] f_written = f_write_before ^ write_gray_q;
wire [DEPTH_BITS:0] f_taken = f_read_before ^ read_gray_q;
always @* assert((f_written & (f_written - 1'b1)) == 0 && (f_taken & (f_taken - 1'b1)) == 0);
