// SPDX-License-Identifier: MIT OR Apache-2.0
// Collects the decisions of a row of regions for its ROW packet (docs/packets.md). One row is collected while the row
// before it leaves. A row that begins while both places are taken is dropped. A part is on part_o one clock after its read.
`default_nettype none

module packet_rows #(
    parameter COLUMNS = 240,      // regions in a row of regions
    parameter ROWS = 135,         // rows of regions
    parameter COLUMN_BITS = 8,    // ceil(log2(COLUMNS))
    parameter ROW_BITS = 8,       // bits of the number of a row
    parameter DECISION_BITS = 2,  // bits of a region in the packet, 2 or 4
    parameter BITS = 16,          // bits of a part of the packet
    parameter PART_BITS = 6       // bits of the number of a part
) (
    input  wire                 clk_i,           // clock, rising edge
    input  wire                 rst_i,           // synchronous reset, active high
    input  wire                 decision_i,      // a region is decided at this edge, in the order of the regions
    input  wire                 srs_i,           // SRS of that decision
    input  wire                 trs_i,           // TRS of that decision
    input  wire                 summary_i,       // the region sends its summary (only with DECISION_BITS = 4)
    output wire                 frame_o,         // lowest bit of the number since reset of the frame that is decided
    output wire                 last_o,          // the last region of a frame is decided at this edge
    output wire                 dropped_o,       // the last region of a row that is dropped is decided at this edge
    output wire                 valid_o,         // a whole row waits; the ports below are of this row
    output wire                 valid_frame_o,   // lowest bit of the number since reset of the waiting row's frame
    output wire [ ROW_BITS-1:0] row_o,           // number of the waiting row
    input  wire                 read_i,          // a part is read at this edge; otherwise part_o stays
    input  wire [PART_BITS-1:0] part_i,          // number of the part that is read
    output wire [     BITS-1:0] part_o,          // the part that is read, a clock after read_i
    input  wire                 take_i           // all parts of the waiting row have been read
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (DECISION_BITS != 2 && DECISION_BITS != 4) begin : g_decision_bits DECISION_BITS_must_be_2_or_4 u_refused (); end
        if (COLUMN_BITS != $clog2(COLUMNS)) begin : g_column_bits COLUMN_BITS_must_be_clog2_of_COLUMNS u_refused (); end
    endgenerate

    localparam EACH_BITS = $clog2(BITS / DECISION_BITS);  // log2 of the regions of a part
    localparam DECISION_LOG = $clog2(DECISION_BITS);
    localparam PARTS = (COLUMNS * DECISION_BITS + BITS - 1) / BITS;
    localparam AT_BITS = PARTS > 1 ? $clog2(PARTS) : 1;
    localparam SENT = (COLUMNS * DECISION_BITS + 63) / 64 * (64 / BITS);  // parts of the packet, padding included
    localparam LAST_COLUMN = COLUMNS - 1;
    localparam LAST_ROW = ROWS - 1;

    // The region that is decided.
    reg [COLUMN_BITS-1:0] column_q;
    reg [ROW_BITS-1:0] row_q;
    reg frame_q;
    wire row_end = decision_i && column_q == LAST_COLUMN[COLUMN_BITS-1:0];
    wire frame_end = row_q == LAST_ROW[ROW_BITS-1:0];

    // The two places for rows: one for the row that is collected, one for the row that leaves.
    reg collect_q, leave_q;  // which place is collected into; which place leaves
    reg [1:0] full_q, frames_q;
    reg [2*ROW_BITS-1:0] rows_q;
    reg drops_q;
    wire drops = column_q == {COLUMN_BITS{1'b0}} ? full_q[collect_q] : drops_q;
    wire keep = row_end && !drops;

    // The bits of the regions of a part so far. The part is written with each region, so that nothing is left to do at the
    // end of a row.
    reg [BITS-1:0] part_q;
    wire [BITS-1:0] bits = {{(BITS - 3) {1'b0}}, DECISION_BITS == 4 && summary_i, trs_i, srs_i};
    localparam WIDE = (AT_BITS + EACH_BITS > COLUMN_BITS ? AT_BITS + EACH_BITS : COLUMN_BITS) + 1;
    wire [WIDE-1:0] column = {{(WIDE - COLUMN_BITS) {1'b0}}, column_q};
    wire unused_column = column[WIDE-1];
    wire [EACH_BITS-1:0] in_part = column[EACH_BITS-1:0];
    wire [BITS-1:0] part = (in_part == {EACH_BITS{1'b0}} ? {BITS{1'b0}} : part_q) | bits << {in_part, {DECISION_LOG{1'b0}}};

    always @(posedge clk_i) begin
        if (decision_i) begin
            part_q   <= part;
            drops_q  <= drops;
            column_q <= row_end ? {COLUMN_BITS{1'b0}} : column_q + 1'b1;
        end
        if (row_end) row_q <= frame_end ? {ROW_BITS{1'b0}} : row_q + 1'b1;
        if (last_o) frame_q <= !frame_q;
        if (take_i) begin
            leave_q         <= !leave_q;
            full_q[leave_q] <= 1'b0;
        end
        if (keep) begin
            collect_q           <= !collect_q;
            full_q[collect_q]   <= 1'b1;
            frames_q[collect_q] <= frame_q;
            if (collect_q) rows_q[ROW_BITS+:ROW_BITS] <= row_q;
            else rows_q[0+:ROW_BITS] <= row_q;
        end
        if (rst_i) begin
            column_q  <= {COLUMN_BITS{1'b0}};
            row_q     <= {ROW_BITS{1'b0}};
            frame_q   <= 1'b0;
            collect_q <= 1'b0;
            leave_q   <= 1'b0;
            full_q    <= 2'd0;
        end
    end

    wire [BITS-1:0] found;
    wire [AT_BITS-1:0] collect_at = column[EACH_BITS+:AT_BITS];
    raster_memory #(.WIDTH(BITS), .WORDS(2 << AT_BITS), .ADDRESS_BITS(AT_BITS + 1)) u_parts (
        .clk_i(clk_i), .write_i(decision_i && !drops), .write_address_i({collect_q, collect_at}), .data_i(part),
        .read_i(read_i), .read_address_i({leave_q, part_i[AT_BITS-1:0]}), .output_i(1'b1), .data_o(found)
    );

    // The parts of the last word that hold no region are 0.
    generate
        if (SENT == PARTS) begin : g_full
            assign part_o = found;
        end else begin : g_rest
            localparam LAST = PARTS - 1;
            reg beyond_q;
            always @(posedge clk_i) if (read_i) beyond_q <= part_i > LAST[PART_BITS-1:0];
            assign part_o = beyond_q ? {BITS{1'b0}} : found;
        end
        if (DECISION_BITS == 2) begin : g_pixels
            wire unused_summary = summary_i;
        end
        if (PART_BITS > AT_BITS && SENT == PARTS) begin : g_bits
            wire unused_part = |part_i[PART_BITS-1:AT_BITS];
        end
    endgenerate

    assign frame_o = frame_q;
    assign last_o = row_end && frame_end;
    assign dropped_o = row_end && drops;
    assign valid_o = full_q[leave_q];
    assign valid_frame_o = frames_q[leave_q];
    assign row_o = leave_q ? rows_q[ROW_BITS+:ROW_BITS] : rows_q[0+:ROW_BITS];

endmodule

`default_nettype wire
