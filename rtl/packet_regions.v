// SPDX-License-Identifier: MIT OR Apache-2.0
// Collects the words of a region, so that its REGION packet (docs/packets.md) is sent whole or not at all. Its memory
// has 2^PLACE_BITS places, each for one region. A region that is lost in the middle gives its place back. A part of the
// oldest whole region is on part_o one clock after its read.
`default_nettype none

module packet_regions #(
    parameter WIDTH = 8,        // bits of a pixel
    parameter LANES = 1,        // pixels of a word
    parameter PIXELS = 64,      // pixels of a region
    parameter MEANS = 0,        // means of a summary; 0: the design has no summaries
    parameter COLUMNS = 240,    // regions in a row of regions
    parameter COLUMN_BITS = 8,  // ceil(log2(COLUMNS))
    parameter REGION_BITS = 15, // bits of the number of a region
    parameter BITS = 16,        // bits of a part of the packet, 16 or 32
    parameter PART_BITS = 6,    // bits of the number of a part
    parameter PLACE_BITS = 2    // log2 of the number of regions that are kept
) (
    input  wire                               clk_i,           // clock, rising edge
    input  wire                               rst_i,           // synchronous reset, active high
    input  wire                               valid_i,         // a word of a region is offered
    input  wire [            REGION_BITS-1:0] region_i,        // number of the region of that word
    input  wire [            LANES*WIDTH-1:0] pixel_i,         // the offered word
    input  wire                               first_i,         // the word is the first of its region
    input  wire                               last_i,          // the word is the last that comes of its region
    input  wire                               abort_i,         // the word is the last because its region was lost
    input  wire                               frame_i,         // lowest bit of the number since reset of the region's frame
    input  wire                               summary_i,       // the word is a mean (MEANS)
    output wire                               ready_o,         // the offered word is taken
    output wire                               whole_o,         // a region is whole at this edge
    output wire                               whole_frame_o,   // lowest bit of the number since reset of that region's frame
    output wire                               valid_o,         // a whole region waits; the ports below are of the oldest
    output wire                               valid_frame_o,   // lowest bit of the number since reset of the waiting region's frame
    output wire                               summary_o,       // the waiting region is a summary
    output wire [REGION_BITS-COLUMN_BITS:0]   row_o,           // row of the waiting region
    output wire [            COLUMN_BITS-1:0] column_o,        // column of the waiting region
    input  wire                               read_i,          // a part is read at this edge; otherwise part_o stays
    input  wire [              PART_BITS-1:0] part_i,          // number of the part that is read
    output wire [                   BITS-1:0] part_o,          // the part that is read, a clock after read_i
    input  wire                               take_i           // all parts of the waiting region have been read
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (BITS != 16 && BITS != 32) begin : g_bits BITS_must_be_16_or_32 u_refused (); end
        if (WIDTH > 16) begin : g_width WIDTH_must_be_16_or_less u_refused (); end
    endgenerate

    localparam LANE = WIDTH > 8 ? 16 : 8;                              // bits of a value in the packet
    localparam ROW = LANES * LANE > BITS ? LANES : BITS / LANE;        // values at an address of the memory
    localparam ROW_LOG = $clog2(ROW);
    localparam VALUE_BITS = $clog2(PIXELS);
    localparam ADDRESSES = (PIXELS + ROW - 1) / ROW;
    localparam AT_BITS = ADDRESSES > 1 ? $clog2(ADDRESSES) : 1;
    localparam PER_PART = BITS / LANE;                                 // values of a part
    localparam PLACE_ROW_BITS = REGION_BITS - COLUMN_BITS + 1;         // bits of a row of regions, as packet_place gives it
    localparam ENTRY_BITS = 2 + PLACE_ROW_BITS + COLUMN_BITS;

    // Places are used in turn. The counters of kept and taken regions have one bit more than a place, to tell full from empty.
    reg [PLACE_BITS:0] kept_q, taken_q;
    wire full = kept_q == {!taken_q[PLACE_BITS], taken_q[PLACE_BITS-1:0]};
    reg ending_q;  // all words of a region have come, but its row and column are not known yet
    wire take = valid_i && ready_o;
    wire ends = take && last_i && !abort_i;

    // Row and column of a region are computed while its words come.
    wire busy;
    wire [PLACE_ROW_BITS-1:0] row;
    wire [COLUMN_BITS-1:0] column;
    packet_place #(.COLUMNS(COLUMNS), .COLUMN_BITS(COLUMN_BITS), .REGION_BITS(REGION_BITS)) u_place (
        .clk_i(clk_i), .rst_i(rst_i), .start_i(take && first_i), .region_i(region_i), .busy_o(busy), .row_o(row), .column_o(column)
    );
    wire unknown = busy || (first_i && take);
    assign whole_o = (ends || ending_q) && !unknown;

    reg frame_q, summary_q;
    localparam ONE = 1;
    wire summary = MEANS > 0 && summary_i;
    reg [VALUE_BITS:0] value_q;  // number of values that have come
    wire [VALUE_BITS:0] value = first_i ? {(VALUE_BITS + 1) {1'b0}} : value_q;
    always @(posedge clk_i) begin
        if (take) begin
            value_q <= value + (summary ? ONE[VALUE_BITS:0] : LANES[VALUE_BITS:0]);
            if (first_i) {frame_q, summary_q} <= {frame_i, summary};
        end
        ending_q <= (ends || ending_q) && unknown;
        if (whole_o) kept_q <= kept_q + 1'b1;
        if (take_i) taken_q <= taken_q + 1'b1;
        if (rst_i) begin
            kept_q   <= {(PLACE_BITS + 1) {1'b0}};
            taken_q  <= {(PLACE_BITS + 1) {1'b0}};
            ending_q <= 1'b0;
        end
    end

    // The entry of a kept region holds everything except its values.
    reg [ENTRY_BITS-1:0] entries_q[0:(1<<PLACE_BITS)-1];
    always @(posedge clk_i) if (whole_o) entries_q[kept_q[PLACE_BITS-1:0]] <= {frame_q, summary_q, row, column};
    assign {valid_frame_o, summary_o, row_o, column_o} = entries_q[taken_q[PLACE_BITS-1:0]];

    // The values. A mean is on all pixels of a word, so any one of them may be kept. The lowest bits of `at` and `from` number a
    // value or a part within an address, the next ones are the address, and more zeros are above, so that both always exist.
    localparam SPLIT = $clog2(ROW / PER_PART);
    wire [VALUE_BITS+AT_BITS+ROW_LOG:0] at = {{(AT_BITS + ROW_LOG) {1'b0}}, value};
    wire [PART_BITS+AT_BITS+SPLIT-1:0] from = {{(AT_BITS + SPLIT) {1'b0}}, part_i};
    wire [AT_BITS-1:0] write_at = at[ROW_LOG+:AT_BITS];
    wire [AT_BITS-1:0] read_at = from[SPLIT+:AT_BITS];
    wire unused_places = |at || |from;
    wire [ROW*LANE-1:0] found;
    genvar lane;
    generate
        for (lane = 0; lane < ROW; lane = lane + 1) begin : g_lane
            wire chosen;
            wire [WIDTH-1:0] word;
            if (ROW == 1) begin : g_only
                assign chosen = 1'b1;
            end else begin : g_some
                // The bits in which the number of this value differs from that of the incoming value. A word has LANES values at once.
                localparam NUMBER = lane;
                localparam WITHIN = LANES - 1;  // the bits in which the numbers of a word's values differ
                wire [ROW_LOG-1:0] differs = value[ROW_LOG-1:0] ^ NUMBER[ROW_LOG-1:0];
                assign chosen = (summary ? differs : differs & ~WITHIN[ROW_LOG-1:0]) == {ROW_LOG{1'b0}};
            end
            raster_memory #(.WIDTH(WIDTH), .WORDS(1 << (PLACE_BITS + AT_BITS)), .ADDRESS_BITS(PLACE_BITS + AT_BITS)) u_values (
                .clk_i(clk_i), .write_i(take && chosen), .write_address_i({kept_q[PLACE_BITS-1:0], write_at}),
                .data_i(pixel_i[lane%LANES*WIDTH+:WIDTH]), .read_i(read_i),
                .read_address_i({taken_q[PLACE_BITS-1:0], read_at}), .output_i(1'b1), .data_o(word)
            );
            assign found[lane*LANE+:LANE] = {{(LANE - WIDTH) {1'b0}}, word};
        end
    endgenerate

    // The values of a part. Values beyond the last one of the region are 0.
    wire [BITS-1:0] part;
    wire [PER_PART-1:0] counts;
    generate
        if (ROW == PER_PART) begin : g_whole
            assign part = found;
        end else begin : g_choose
            localparam CHOICE_BITS = $clog2(ROW / PER_PART);
            reg [CHOICE_BITS-1:0] choice_q;
            always @(posedge clk_i) if (read_i) choice_q <= part_i[CHOICE_BITS-1:0];
            localparam PART_LOG = $clog2(BITS);
            wire [CHOICE_BITS+PART_LOG-1:0] first_bit = {choice_q, {PART_LOG{1'b0}}};
            assign part = found[first_bit+:BITS];
        end
        if (PIXELS * LANE % 64 == 0 && MEANS * LANE % 64 == 0) begin : g_full
            assign counts = {PER_PART{1'b1}};
        end else begin : g_rest
            reg [PER_PART-1:0] counts_q;
            assign counts = counts_q;
            for (lane = 0; lane < PER_PART; lane = lane + 1) begin : g_count
                // The numbers of parts in which this lane holds a value of the region.
                localparam OF_PIXELS = (PIXELS + PER_PART - 1 - lane) / PER_PART;
                localparam OF_MEANS = (MEANS + PER_PART - 1 - lane) / PER_PART;
                always @(posedge clk_i) if (read_i) counts_q[lane] <= {1'b0, part_i} < (summary_o ? OF_MEANS[PART_BITS:0] : OF_PIXELS[PART_BITS:0]);
            end
        end
        for (lane = 0; lane < PER_PART; lane = lane + 1) begin : g_part
            assign part_o[lane*LANE+:LANE] = counts[lane] ? part[lane*LANE+:LANE] : {LANE{1'b0}};
        end
    endgenerate

    assign ready_o = !full && !ending_q;
    assign whole_frame_o = frame_q;
    assign valid_o = kept_q != taken_q;

endmodule

`default_nettype wire
