// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds up a CRC of the outputs of each RPU of an array for each frame (docs/boards.md), as a short proof of these outputs. The
// array decides at every PIXELS-th clock, and forwards what it sends of that frame in the PIXELS clocks after that.
//
// When the next frame is decided, the CRCs of a row of regions become a chain, which moves by one region per clock. The CRCs
// that leave the chains are added in a tree. done_o comes with the sum of a frame.
`default_nettype none

module array_signature #(
    parameter COLUMNS = 4,     // regions in a row of regions
    parameter ROWS = 3,        // rows of regions
    parameter HEAD_BYTES = 3,  // bytes of a decision with its scores
    parameter PIXELS = 64      // clocks of a frame; COLUMNS or more, because a chain would be too slow otherwise
) (
    input  wire                                 clk_i,            // clock, rising edge
    input  wire                                 rst_i,            // synchronous reset, active high
    input  wire                                 decided_i,        // decisions and scores of a frame are on head_i
    input  wire [COLUMNS*ROWS*HEAD_BYTES*8-1:0] head_i,           // decisions and scores; element i is of region i
    input  wire [             COLUMNS*ROWS-1:0] forward_valid_i,  // one bit per region: a pixel or a mean of it leaves
    input  wire [           COLUMNS*ROWS*8-1:0] forward_pixel_i,  // that pixel or mean; element i is of region i
    output wire [                         31:0] sum_o,            // sum of all whole frames so far, modulo 2^32
    output wire [                         31:0] frames_o,         // number of whole frames so far
    output wire                                 done_o            // a frame is over, and sum_o is the sum after it
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (HEAD_BYTES < 1) begin : g_head HEAD_BYTES_must_be_1_or_more u_refused (); end
        if (COLUMNS > PIXELS) begin : g_slow COLUMNS_must_be_PIXELS_or_less u_refused (); end
    endgenerate

    localparam LEVELS = $clog2(ROWS);
    localparam LEAVES = 1 << LEVELS;
    localparam PIECES = (HEAD_BYTES + 3) / 4;
    localparam HEAD_BITS = HEAD_BYTES * 8;

    // Returns the CRC sum after the number of a region in four bytes.
    function [31:0] numbered(input [31:0] number);
        integer step;
        begin
            numbered = ~number;
            for (step = 0; step < 32; step = step + 1) numbered = numbered[0] ? (numbered >> 1) ^ 32'hEDB88320 : numbered >> 1;
        end
    endfunction

    // The nodes of the tree, starting with the leaves; level l begins at node START.
    wire [64*LEAVES-33:0] nodes;

    genvar row, column, piece, level, node;
    generate
        for (row = 0; row < ROWS; row = row + 1) begin : g_row
            wire [32*COLUMNS+31:0] chain;
            assign chain[32*COLUMNS+:32] = 32'd0;
            assign nodes[32*row+:32] = chain[31:0];
            for (column = 0; column < COLUMNS; column = column + 1) begin : g_column
                localparam REGION = row * COLUMNS + column;
                // The CRC sum after the number of the region, and that after a decision with its scores, four bytes at a time.
                localparam [31:0] NUMBERED = numbered(REGION[31:0]);
                wire [32*PIECES+31:0] parts;
                assign parts[31:0] = NUMBERED;
                for (piece = 0; piece < PIECES; piece = piece + 1) begin : g_piece
                    localparam BITS = HEAD_BITS - 32 * piece < 32 ? HEAD_BITS - 32 * piece : 32;
                    packet_crc #(.BITS(BITS)) u_head (
                        .crc_i(parts[32*piece+:32]), .data_i(head_i[REGION*HEAD_BITS+32*piece+:BITS]), .crc_o(parts[32*piece+32+:32])
                    );
                end
                // The sum so far, and the pixel that leaves now. With a new frame the sum moves on to the chain.
                reg [31:0] crc_q, chain_q;
                wire [31:0] more;
                packet_crc #(.BITS(8)) u_pixel (.crc_i(crc_q), .data_i(forward_pixel_i[REGION*8+:8]), .crc_o(more));
                wire [31:0] next = forward_valid_i[REGION] ? more : crc_q;
                always @(posedge clk_i) begin
                    crc_q   <= decided_i ? parts[32*PIECES+:32] : next;
                    chain_q <= decided_i ? ~next : chain[32*column+32+:32];
                end
                assign chain[32*column+:32] = chain_q;
            end
        end
        for (row = ROWS; row < LEAVES; row = row + 1) begin : g_none
            assign nodes[32*row+:32] = 32'd0;
        end
        for (level = 0; level < LEVELS; level = level + 1) begin : g_level
            // The number of nodes of all levels before this one, and before the next one.
            localparam FROM = 2 * LEAVES - (2 * LEAVES >> level);
            localparam TO = 2 * LEAVES - (2 * LEAVES >> (level + 1));
            for (node = 0; node < LEAVES >> (level + 1); node = node + 1) begin : g_node
                reg [31:0] node_q;
                always @(posedge clk_i) node_q <= nodes[32*(FROM+2*node)+:32] + nodes[32*(FROM+2*node+1)+:32];
                assign nodes[32*(TO+node)+:32] = node_q;
            end
        end
    endgenerate

    // Timing of the sums that leave the chains and the tree. Before the first decision there is no frame to add.
    localparam LEFT_BITS = $clog2(COLUMNS + 1);
    reg before_q;                // a frame has been decided
    reg [LEFT_BITS-1:0] left_q;  // number of sums that are left in a chain
    wire moves = left_q != {LEFT_BITS{1'b0}};
    wire [LEVELS:0] adds, ends;
    assign adds[0] = moves;
    assign ends[0] = moves && (left_q >> 1) == {LEFT_BITS{1'b0}};
    generate
        for (level = 0; level < LEVELS; level = level + 1) begin : g_when
            reg add_q, end_q;
            always @(posedge clk_i) begin
                add_q <= adds[level] && !rst_i;
                end_q <= ends[level] && !rst_i;
            end
            assign adds[level+1] = add_q;
            assign ends[level+1] = end_q;
        end
    endgenerate

    reg [31:0] sum_q, frames_q;
    reg done_q;
    always @(posedge clk_i) begin
        if (decided_i) before_q <= 1'b1;
        if (decided_i && before_q) left_q <= COLUMNS[LEFT_BITS-1:0];
        else if (moves) left_q <= left_q - 1'b1;
        if (adds[LEVELS]) sum_q <= sum_q + nodes[64*LEAVES-64+:32];
        if (ends[LEVELS]) frames_q <= frames_q + 1'b1;
        done_q <= ends[LEVELS];
        if (rst_i) begin
            before_q <= 1'b0;
            left_q   <= {LEFT_BITS{1'b0}};
            sum_q    <= 32'd0;
            frames_q <= 32'd0;
            done_q   <= 1'b0;
        end
    end
    assign sum_o = sum_q;
    assign frames_o = frames_q;
    assign done_o = done_q;

endmodule

`default_nettype wire
