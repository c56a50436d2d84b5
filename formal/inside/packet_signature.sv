// SPDX-License-Identifier: MIT OR Apache-2.0
// The sum by the page of the packets whose last word has passed, which is on the port three clocks later.
reg f_started = 1'b0;  // the first clock is a reset
reg f_inside;
reg [3:0] f_kind;
wire f_passes = valid_i && ready_i;
wire f_end = f_passes && last_i && f_kind == 4'd5;
wire f_counts = f_passes && last_i && (f_kind == 4'd2 || f_kind == 4'd4 || f_kind == 4'd5);
reg [31:0] f_sum, f_sum_1, f_sum_2, f_number, f_number_1, f_number_2;
reg f_end_1, f_end_2, f_end_3, f_counts_1, f_counts_2;
always @(posedge clk_i) begin
    f_started <= 1'b1;
    if (f_passes) f_inside <= !last_i;
    if (f_passes && !f_inside) f_kind <= data_i[11:8];
    if (f_counts) f_sum <= f_sum + data_i[63:32];
    if (f_end) f_number <= f_number + 1;
    {f_sum_1, f_sum_2, f_number_1, f_number_2} <= {f_sum, f_sum_1, f_number, f_number_1};
    {f_end_1, f_end_2, f_end_3, f_counts_1, f_counts_2} <= {f_end, f_end_1, f_end_2, f_counts, f_counts_1};
    if (rst_i) begin
        {f_inside, f_end_1, f_end_2, f_end_3, f_counts_1, f_counts_2} <= 0;
        {f_sum, f_sum_1, f_sum_2, f_number, f_number_1, f_number_2} <= 0;
    end
end
// Packets have two words or more.
always @* if (!f_inside) assume(!last_i);
always @* if (f_started) begin
    assert(sum_o == f_sum_2 && frames_o == f_number_2);
    assert(done_o == f_end_3);
    // An invariant that the induction needs.
    assert(inside_q == f_inside);
    if (f_inside || tail_q) assert(end_q == (f_kind == 4'd5) && counts_q == (f_kind == 4'd2 || f_kind == 4'd4 || f_kind == 4'd5));
    assert(add_q == f_counts_2 && add_end_q == f_end_2);
    assert((tail_q && counts_q) == f_counts_1 && (tail_q && end_q) == f_end_1);
    assert(f_sum_1 == f_sum_2 + (add_q ? added_q : 32'd0) && f_sum == f_sum_1 + (f_counts_1 ? crc_q : 32'd0));
    assert(f_number_1 == f_number_2 + add_end_q && f_number == f_number_1 + f_end_1);
end
