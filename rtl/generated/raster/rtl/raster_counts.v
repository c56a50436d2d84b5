// SPDX-License-Identifier: MIT OR Apache-2.0
// Counts the hits of regions, all features in parallel. done_o and counts_o come two clocks after the last hits of a region,
// with DEEP three. The regions of one row of regions are counted at a time.
//
// The hits of a row of a region are counted in registers, and added to those of the rows above it from a memory with one
// word per column of regions. The sum of a region's last row is never written, so the words of the memory are too narrow
// for it.
`default_nettype none

module raster_counts #(
    parameter LANES = 1,        // pixels of a word
    parameter FEATURES = 2,     // number of hits that are counted in parallel
    parameter SIDE = 8,         // rows of a region
    parameter COUNT_BITS = 7,   // bits of a count, 0..SIDE * SIDE
    parameter COLUMNS = 240,    // regions in a row of regions
    parameter COLUMN_BITS = 8,  // ceil(log2(COLUMNS))
    parameter DEEP = 0          // 0: counts come two clocks after the last hits; 1: three clocks
) (
    input  wire                           clk_i,            // clock, rising edge
    input  wire                           rst_i,            // synchronous reset, active high
    input  wire                           step_i,           // the hits of a word come in
    input  wire [     FEATURES*LANES-1:0] hits_i,           // hits of the word: LANES bits per feature, the first feature lowest
    input  wire                           segment_end_i,    // the word is the last of a row of its region
    input  wire                           row_end_i,        // the word is the last of its row of the frame
    input  wire                           region_top_i,     // the word is in the first row of its region
    input  wire                           region_bottom_i,  // the word is in the last row of its region
    output wire                           done_o,           // counts_o is that of a whole region
    output wire [FEATURES*COUNT_BITS-1:0] counts_o          // counts of that region, the first feature lowest
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COUNT_BITS != $clog2(SIDE * SIDE + 1)) begin : g_count_bits
            COUNT_BITS_must_hold_SIDE_squared u_refused ();
        end
        if (COLUMNS < 4) begin : g_columns COLUMNS_must_be_4_or_more u_refused (); end
    endgenerate

    localparam ROW_BITS = $clog2(SIDE + 1);                 // bits of the hits of a row of a region
    localparam KEPT_BITS = $clog2((SIDE - 1) * SIDE + 1);   // bits of the hits of all rows except the last
    localparam EARLY = SIDE > LANES;                        // 1: a row of a region takes more than one word

    // The hits of the current row of a region.
    reg [FEATURES*ROW_BITS-1:0] row_q;
    reg fresh_q;  // the next word is the first of a row of its region
    reg ended_q, top_q, bottom_q;
    reg [COLUMN_BITS-1:0] column_q, old_column_q;

    integer feature, lane;
    reg [FEATURES*ROW_BITS-1:0] row;
    always @* begin
        row = fresh_q ? {FEATURES * ROW_BITS{1'b0}} : row_q;
        for (feature = 0; feature < FEATURES; feature = feature + 1)
            for (lane = 0; lane < LANES; lane = lane + 1)
                row[feature*ROW_BITS+:ROW_BITS] = row[feature*ROW_BITS+:ROW_BITS]
                    + {{(ROW_BITS - 1) {1'b0}}, hits_i[feature*LANES+lane]};
    end

    always @(posedge clk_i) begin
        ended_q      <= step_i && segment_end_i && !rst_i;
        top_q        <= region_top_i;
        bottom_q     <= region_bottom_i;
        old_column_q <= column_q;
        if (step_i) begin
            fresh_q <= segment_end_i;
            row_q   <= row;
            if (segment_end_i) column_q <= row_end_i ? {COLUMN_BITS{1'b0}} : column_q + 1'b1;
        end
        if (rst_i) begin
            fresh_q  <= 1'b1;
            column_q <= {COLUMN_BITS{1'b0}};
        end
    end

    // The hits of the rows above it.
    wire [FEATURES*KEPT_BITS-1:0] kept_above;
    wire [FEATURES*KEPT_BITS-1:0] above;
    wire [FEATURES*KEPT_BITS-1:0] kept;
    wire write;
    wire [COLUMN_BITS-1:0] write_column;

    raster_memory #(
        .WIDTH(FEATURES * KEPT_BITS), .WORDS(COLUMNS), .ADDRESS_BITS(COLUMN_BITS), .OUTPUT_STAGE(DEEP)
    ) u_rows (
        .clk_i(clk_i), .write_i(write), .write_address_i(write_column), .data_i(kept),
        .read_i(1'b1), .read_address_i(column_q), .output_i(1'b1), .data_o(kept_above)
    );
    // Nothing is above the first row of a region. If a row of a region takes several words, its column is known early, and the
    // memory, which may be far from here, has one clock for the way.
    wire top;
    word_delay #(.WIDTH(1), .DEPTH(DEEP && !EARLY ? 1 : 0)) u_top (.clk_i(clk_i), .data_i(top_q), .data_o(top));
    word_delay #(.WIDTH(FEATURES * KEPT_BITS), .DEPTH(DEEP && EARLY ? 1 : 0)) u_above (
        .clk_i(clk_i), .data_i(top ? {FEATURES * KEPT_BITS{1'b0}} : kept_above), .data_o(above)
    );

    wire [FEATURES*ROW_BITS-1:0] last_row;
    wire ended, bottom;
    wire [COLUMN_BITS-1:0] column;
    bit_delay #(.DEPTH(DEEP)) u_ended (.clk_i(clk_i), .rst_i(rst_i), .bit_i(ended_q), .bit_o(ended));
    word_delay #(.WIDTH(FEATURES * ROW_BITS + COLUMN_BITS + 1), .DEPTH(DEEP)) u_row (
        .clk_i(clk_i), .data_i({row_q, old_column_q, bottom_q}), .data_o({last_row, column, bottom})
    );

    reg [FEATURES*COUNT_BITS-1:0] counts_q;
    reg written_q, done_q;
    reg [COLUMN_BITS-1:0] write_column_q;
    genvar each;
    generate
        for (each = 0; each < FEATURES; each = each + 1) begin : g_feature
            wire [COUNT_BITS-1:0] hits = {{(COUNT_BITS - ROW_BITS) {1'b0}}, last_row[each*ROW_BITS+:ROW_BITS]};
            wire [KEPT_BITS-1:0] others = above[each*KEPT_BITS+:KEPT_BITS];
            always @(posedge clk_i)
                counts_q[each*COUNT_BITS+:COUNT_BITS] <= hits + {{(COUNT_BITS - KEPT_BITS) {1'b0}}, others};
            assign kept[each*KEPT_BITS+:KEPT_BITS] = counts_q[each*COUNT_BITS+:KEPT_BITS];
        end
    endgenerate

    always @(posedge clk_i) begin
        written_q      <= ended && !rst_i;
        done_q         <= ended && bottom && !rst_i;
        write_column_q <= column;
    end

    assign write = written_q;
    assign write_column = write_column_q;
    assign done_o = done_q;
    assign counts_o = counts_q;

endmodule

`default_nettype wire
