// SPDX-License-Identifier: MIT OR Apache-2.0
// A queue of two rows of decisions. Frames have two rows. Parts of 16 bits are read in any order.
module properties #(parameter COLUMNS = 3, DECISION_BITS = 2) (
    input wire clk_i, rst_i, decision, srs, trs, summary, read, take, input wire [1:0] part
);
    `include "reset.vh"
    localparam ROWS = 2, BITS = COLUMNS * DECISION_BITS;
    wire frame, last, dropped, valid, valid_frame, row;
    wire [15:0] found;
    packet_rows #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .COLUMN_BITS($clog2(COLUMNS)), .ROW_BITS(1), .DECISION_BITS(DECISION_BITS), .BITS(16), .PART_BITS(2)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .decision_i(decision), .srs_i(srs), .trs_i(trs), .summary_i(summary), .frame_o(frame), .last_o(last),
        .dropped_o(dropped), .valid_o(valid), .valid_frame_o(valid_frame), .row_o(row), .read_i(read), .part_i(part), .part_o(found),
        .take_i(take)
    );
    // Only a waiting row is taken.
    always @* assume(!take || valid);

    // The region that is decided next, the row that is collected, and the rows that wait.
    reg [3:0] column;
    reg own_row, own_frame, drops;
    reg [63:0] row_bits, oldest, second;
    reg [1:0] count;
    reg [1:0] oldest_of, second_of;  // frame and row of the waiting rows
    wire [63:0] code = {srs, 1'b0} >> 1 | {trs, 1'b0} | (DECISION_BITS == 4 && summary ? 64'd4 : 64'd0);
    wire [63:0] now = (column == 0 ? 64'd0 : row_bits) | code << column * DECISION_BITS;
    wire drop_now = column == 0 ? count == 2 : drops;
    wire ends = decision && column == COLUMNS - 1;
    wire keeps = ends && !drop_now;
    always @(posedge clk_i) begin
        if (decision) begin
            row_bits <= now;
            drops    <= drop_now;
            column   <= ends ? 0 : column + 1;
        end
        if (ends) own_row <= !own_row;
        if (ends && own_row) own_frame <= !own_frame;
        count <= count + keeps - take;
        if (take) {oldest, oldest_of} <= {second, second_of};
        if (keeps) begin
            if (count - take == 0) {oldest, oldest_of} <= {now, own_frame, own_row};
            else {second, second_of} <= {now, own_frame, own_row};
        end
        if (rst_i) {column, own_row, own_frame, count} <= 0;
    end

    // The part that was read one clock ago, of the row that waited then.
    reg was_read;
    reg [15:0] wanted;
    always @(posedge clk_i) begin
        if (read) wanted <= oldest >> part * 16;
        was_read <= !rst_i && ((read && valid) || (was_read && !read));
    end

    always @* if (started) begin
        assert(count <= 2);
        assert(valid == (count != 0));
        assert(frame == own_frame);
        assert(last == (ends && own_row));
        assert(dropped == (ends && drop_now));
        if (valid) assert({valid_frame, row} == oldest_of);
        if (was_read) assert(found == wanted);
    end
endmodule
