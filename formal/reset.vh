// SPDX-License-Identifier: MIT OR Apache-2.0
// For a property module with clk_i and rst_i: the first clock is a reset, and every later one may be a reset.
reg started = 1'b0;
always @(posedge clk_i) started <= 1'b1;
always @* if (!started) assume(rst_i);
