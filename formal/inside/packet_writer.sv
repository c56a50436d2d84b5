// SPDX-License-Identifier: MIT OR Apache-2.0
// Properties inside of packet_writer: the place of each part of a word in the pipeline, and the sum of the parts that have gone in.
`include "reset.vh"
localparam [IN_WORD_BITS-1:0] FIRST = 0;
reg [IN_WORD_BITS-1:0] read_at, at, next_at;  // the part that was read; the part that was selected; the part that comes into the word next
reg read_tail, tail_part;
reg [31:0] before;                            // the sum of the words of the packet that have left
wire [31:0] sums[0:PARTS];
wire [IN_WORD_BITS-1:0] parts = next_at;      // number of parts of the incomplete word
wire [63:0] so_far = data_valid_q ? data_q : data_q >> (PARTS - parts) * BITS;
assign sums[0] = before;
genvar step_at;
generate
    for (step_at = 0; step_at < PARTS; step_at = step_at + 1) begin : g_sum
        packet_crc #(.BITS(BITS)) u_sum (.crc_i(sums[step_at]), .data_i(so_far[step_at*BITS+:BITS]), .crc_o(sums[step_at+1]));
    end
endgenerate
always @(posedge clk_i) begin
    if (step) begin
        read_at   <= in_word;
        read_tail <= phase_q == TAIL;
        at        <= read_at;
        tail_part <= read_tail;
        if (valid_q) next_at <= at + 1;
        if (data_valid_q) before <= data_last_q ? 32'hFFFFFFFF : sums[PARTS];
    end
    if (rst_i) begin
        next_at <= 0;
        before  <= 32'hFFFFFFFF;
    end
end

// The last word whose parts come in or have come is the tail.
wire in_tail = valid_q ? tail_part : read_valid_q ? read_tail : phase_q == TAIL;
wire [IN_WORD_BITS-1:0] due = next_at;
always @* if (started) begin
    if (valid_q) begin
        assert(at == due && word_q == &at && high_q == at[0]);
        assert(crc_part_q == (tail_part && at[IN_WORD_BITS-1]) && last_q == (tail_part && &at));
    end
    if (read_valid_q) begin
        assert(read_at == due + valid_q && read_word_q == &read_at && read_high_q == read_at[0]);
        assert(read_crc_q == (read_tail && read_at[IN_WORD_BITS-1]) && read_last_q == (read_tail && &read_at));
        if (valid_q && at != PARTS - 1) assert(read_tail == tail_part);
    end
    if (phase_q != IDLE) begin
        assert(in_word == due + valid_q + read_valid_q);
        if (read_valid_q && read_at != PARTS - 1) assert((phase_q == TAIL) == read_tail);
        if (!read_valid_q) assert(in_word == 0 && phase_q == HEAD);
    end else begin
        assert(due + valid_q + read_valid_q == FIRST);
    end
    if (read_valid_q && !valid_q) assert(read_at == 0 && !read_tail);
    // A word on the port is complete, and the next word has not begun with its last part.
    if (data_valid_q) assert(next_at == 0);
    // The sum so far.
    if (data_valid_q) begin
        assert(crc_q == (data_last_q ? 32'hFFFFFFFF : sums[PARTS]));
        if (data_last_q) assert(data_q[63:32] == ~sums[PARTS/2]);
    end else if (parts != 0 && in_tail && parts > PARTS / 2) begin
        assert(crc_q == sums[PARTS/2]);
        if (PARTS == 4) assert(so_far[47:32] == ~sums[PARTS/2][15:0]);
    end else assert(crc_q == sums[parts]);
end
