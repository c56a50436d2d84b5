// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the means of the blocks of every region, and whether one of them differs by more than level_i from the mean of
// that block that was sent last. differs_o and shown_o come four clocks after the last word of a region, with DEEP five.
//
// A sum is in a register while the words of a row of a block come. Between these rows it waits in a memory with one word per
// column of blocks. The sum starts with half of a block's pixels, so that the mean is floor(sum / pixels), a multiplication
// and a shift that are exact for every sum that can occur. One more bit waits with the sum: whether a mean of that column
// of the region differs.
`default_nettype none

module raster_summary #(
    parameter WIDTH = 8,             // bits of a pixel
    parameter LANES = 1,             // pixels of a word
    parameter SIDE = 8,              // rows of a region
    parameter BLOCKS = 2,            // blocks of a region's side
    parameter COLUMNS = 240,         // regions in a row of regions
    parameter COLUMN_BITS = 8,       // ceil(log2(COLUMNS))
    parameter REGIONS = 32400,       // regions of the frame
    parameter REGION_BITS = 15,      // ceil(log2(REGIONS))
    parameter MEAN_BITS = 2,         // ceil(log2(BLOCKS * BLOCKS)), at least 1
    parameter SUM_BITS = 12,         // bits of the sum of a block plus half of its pixels
    parameter FACTOR_BITS = 1,       // bits of FACTOR
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // (sum * FACTOR) >> SHIFT is the sum divided by the pixels of a block
    parameter SHIFT = 4,             // bits of the product that are dropped
    parameter DEEP = 0               // 1: all outputs come one clock later
) (
    input  wire                   clk_i,           // clock, rising edge
    input  wire                   rst_i,           // synchronous reset, active high
    input  wire                   step_i,          // a word comes at the next edge
    input  wire                   row_end_i,       // that word is the last of its row of the frame
    input  wire [LANES*WIDTH-1:0] word_i,          // that word, one clock later
    input  wire [      WIDTH-1:0] level_i,         // a mean that differs by more than this level is sent again
    output wire                   mean_valid_o,    // a block is complete, and its mean is on mean_o
    output wire [COLUMN_BITS-1:0] mean_region_o,   // low bits of the number of the region of that block
    output wire [            1:0] mean_row_o,      // row of regions of that block, modulo 4
    output wire [  MEAN_BITS-1:0] mean_number_o,   // number of that block in its region
    output wire [      WIDTH-1:0] mean_o,          // mean of that block
    output wire                   differs_o,       // a mean of a region differs, four clocks (DEEP: five) after its last word
    output wire                   shown_o,         // with differs_o: the screen shows a summary of that region
    input  wire                   decided_i,       // a region is decided
    input  wire [REGION_BITS-1:0] decided_region_i,  // number of the decided region
    input  wire                   decided_shown_i, // the screen shows a summary of that region from now on
    input  wire                   done_i,          // a region has fetched all that it sends, or it was lost
    input  wire                   done_lost_i,     // with done_i: that region was lost
    input  wire [REGION_BITS-1:0] done_region_i,   // number of that region
    input  wire                   sent_i,          // a mean has been sent
    input  wire [REGION_BITS-1:0] sent_region_i,   // number of the region of that mean
    input  wire [  MEAN_BITS-1:0] sent_number_i,   // number of the block of that mean in its region
    input  wire [      WIDTH-1:0] sent_mean_i      // the mean that was sent
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SUM_BITS < WIDTH + $clog2(LANES)) begin : g_sum_bits SUM_BITS_must_hold_a_word u_refused (); end
        if (SHIFT < 0 || SHIFT + WIDTH > SUM_BITS + FACTOR_BITS) begin : g_shift
            SHIFT_and_WIDTH_must_lie_in_the_product u_refused ();
        end
        if (MEAN_BITS != $clog2(BLOCKS * BLOCKS) && (BLOCKS > 1 || MEAN_BITS != 1)) begin : g_mean_bits
            MEAN_BITS_must_be_clog2_of_the_blocks u_refused ();
        end
        if (DEEP != 0 && DEEP != 1) begin : g_deep DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam BLOCK = SIDE / BLOCKS;
    localparam HALF = BLOCK * BLOCK / 2;
    localparam SIDE_BITS = $clog2(BLOCKS);               // bits of the number of a column of blocks in a region
    localparam PLACE_BITS = COLUMN_BITS + SIDE_BITS;     // bits of the number of a column of blocks in the frame
    localparam MEANS = BLOCKS * BLOCKS;
    localparam SENT_BITS = $clog2(REGIONS * MEANS);
    localparam MARKS = BLOCKS > 1 ? 1 : 0;               // number of bits that wait with a sum
    localparam PRODUCT_BITS = SUM_BITS + FACTOR_BITS;
    localparam SUM_CLOCKS = 1 + DEEP;                    // clocks from the place of a word to its sum
    integer lane;

    // ---- The place of a word, one clock before the word is there
    // The low bits of its number distinguish the regions of a row of regions.
    wire start, ends, upper, lower;
    wire [1:0] line, column;
    wire [PLACE_BITS-1:0] place;
    wire [REGION_BITS-1:0] region;
    wire [1:0] row;
    wire frame_end;
    raster_blocks #(
        .LANES(LANES), .SIDE(SIDE), .BLOCKS(BLOCKS), .COLUMNS(COLUMNS), .REGIONS(REGIONS), .REGION_BITS(REGION_BITS)
    ) u_place (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .row_end_i(row_end_i), .start_o(start), .end_o(ends),
        .upper_o(upper), .lower_o(lower), .column_o(column), .line_o(line), .region_o(region), .row_o(row),
        .frame_end_o(frame_end)
    );
    wire [MEAN_BITS-1:0] number;
    wire [SENT_BITS-1:0] sent_place, given_place;
    generate
        if (BLOCKS == 1) begin : g_one_number
            assign number = 1'b0;
            assign place = region[COLUMN_BITS-1:0];
            assign sent_place = region;
            assign given_place = sent_region_i;
            wire unused_numbers = |line || |column || |sent_number_i;
        end else begin : g_number
            localparam BOTH = REGION_BITS + MEAN_BITS;
            wire [BOTH-1:0] sent_at = {region, number};
            wire [BOTH-1:0] given_at = {sent_region_i, sent_number_i};
            assign number = {line[SIDE_BITS-1:0], column[SIDE_BITS-1:0]};
            assign place = {region[COLUMN_BITS-1:0], column[SIDE_BITS-1:0]};
            assign sent_place = sent_at[SENT_BITS-1:0];
            assign given_place = given_at[SENT_BITS-1:0];
        end
    endgenerate

    // ---- Sums
    wire sum_step, sum_start, sum_upper;
    bit_delay #(.DEPTH(SUM_CLOCKS)) u_sum_step (.clk_i(clk_i), .rst_i(rst_i), .bit_i(step_i), .bit_o(sum_step));
    word_delay #(.WIDTH(2), .DEPTH(SUM_CLOCKS)) u_sum_place (
        .clk_i(clk_i), .data_i({start, upper}), .data_o({sum_start, sum_upper})
    );

    reg [SUM_BITS-1:0] word_sum;
    wire [SUM_BITS-1:0] value;
    always @* begin
        word_sum = {SUM_BITS{1'b0}};
        for (lane = 0; lane < LANES; lane = lane + 1)
            word_sum = word_sum + {{(SUM_BITS - WIDTH) {1'b0}}, word_i[lane*WIDTH+:WIDTH]};
    end
    word_delay #(.WIDTH(SUM_BITS), .DEPTH(DEEP)) u_value (.clk_i(clk_i), .data_i(word_sum), .data_o(value));

    wire write;
    wire [PLACE_BITS-1:0] write_place;
    wire [SUM_BITS+MARKS-1:0] waiting, to_wait;
    wire [SUM_BITS-1:0] sum;
    reg [SUM_BITS-1:0] sum_q;
    adder #(.WIDTH(SUM_BITS)) u_sum (
        .plain_i(value), .other_i(!sum_start ? sum_q : sum_upper ? HALF[SUM_BITS-1:0] : waiting[SUM_BITS-1:0]), .sum_o(sum)
    );
    always @(posedge clk_i) if (sum_step) sum_q <= sum;

    // ---- The mean of a block, and the mean of that block that was sent last
    wire complete;
    // The bits below SHIFT are the remainder. The bits above the mean are never set.
    /* verilator lint_off UNUSEDSIGNAL */
    wire [PRODUCT_BITS-1:0] product = {{FACTOR_BITS{1'b0}}, sum_q} * {{SUM_BITS{1'b0}}, FACTOR};
    /* verilator lint_on UNUSEDSIGNAL */
    reg [WIDTH-1:0] mean_q;
    always @(posedge clk_i) mean_q <= product[SHIFT+:WIDTH];

    bit_delay #(.DEPTH(SUM_CLOCKS + 2)) u_complete (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(step_i && ends && lower), .bit_o(complete)
    );
    wire [PLACE_BITS-1:0] mean_place;
    word_delay #(.WIDTH(PLACE_BITS + 2 + MEAN_BITS), .DEPTH(SUM_CLOCKS + 2)) u_mean_place (
        .clk_i(clk_i), .data_i({place, row, number}), .data_o({mean_place, mean_row_o, mean_number_o})
    );
    assign mean_valid_o = complete;
    assign mean_region_o = mean_place[SIDE_BITS+:COLUMN_BITS];
    assign mean_o = mean_q;

    wire [WIDTH-1:0] early_sent, sent;
    raster_memory #(.WIDTH(WIDTH), .WORDS(REGIONS * MEANS), .ADDRESS_BITS(SENT_BITS), .OUTPUT_STAGE(DEEP)) u_sent (
        .clk_i(clk_i), .write_i(sent_i), .write_address_i(given_place), .data_i(sent_mean_i), .read_i(1'b1),
        .read_address_i(sent_place), .output_i(1'b1), .data_o(early_sent)
    );
    word_delay #(.WIDTH(WIDTH), .DEPTH(2)) u_early_sent (.clk_i(clk_i), .data_i(early_sent), .data_o(sent));

    reg [WIDTH:0] difference_q;
    reg complete_q;
    always @(posedge clk_i) begin
        difference_q <= {1'b0, mean_q} - {1'b0, sent};
        complete_q   <= complete && !rst_i;
    end
    wire above_level;
    magnitude_above #(.WIDTH(WIDTH + 1)) u_above (
        .value_i(difference_q), .level_i(level_i), .above_o(above_level)
    );

    // ---- Test whether a mean of a region differs
    reg differs_q;
    assign differs_o = differs_q;
    generate
        if (BLOCKS == 1) begin : g_one
            // The sum is written back to the memory at once.
            wire unused_complete = complete_q;
            bit_delay #(.DEPTH(SUM_CLOCKS + 1)) u_write (
                .clk_i(clk_i), .rst_i(rst_i), .bit_i(step_i && ends), .bit_o(write)
            );
            word_delay #(.WIDTH(PLACE_BITS), .DEPTH(SUM_CLOCKS + 1)) u_write_place (
                .clk_i(clk_i), .data_i(place), .data_o(write_place)
            );
            assign to_wait = sum_q;
            always @(posedge clk_i) differs_q <= above_level;
        end else begin : g_some
            // The sum waits for the bit that says whether its mean differs.
            wire early_mark, first, region_start;
            wire mark = (early_mark && !first) || (above_level && complete_q);
            bit_delay #(.DEPTH(SUM_CLOCKS + 3)) u_write (
                .clk_i(clk_i), .rst_i(rst_i), .bit_i(step_i && ends), .bit_o(write)
            );
            word_delay #(.WIDTH(PLACE_BITS), .DEPTH(1)) u_write_place (
                .clk_i(clk_i), .data_i(mean_place), .data_o(write_place)
            );
            word_delay #(.WIDTH(SUM_BITS), .DEPTH(2)) u_written (.clk_i(clk_i), .data_i(sum_q), .data_o(to_wait[SUM_BITS-1:0]));
            assign to_wait[SUM_BITS] = mark;
            word_delay #(.WIDTH(2), .DEPTH(SUM_CLOCKS + 3)) u_first (
                .clk_i(clk_i), .data_i({~|line, ~|column}), .data_o({first, region_start})
            );
            word_delay #(.WIDTH(1), .DEPTH(3)) u_mark (.clk_i(clk_i), .data_i(waiting[SUM_BITS]), .data_o(early_mark));
            always @(posedge clk_i) if (complete_q) differs_q <= mark || (differs_q && !region_start);
        end
    endgenerate

    raster_memory #(
        .WIDTH(SUM_BITS + MARKS), .WORDS(BLOCKS << COLUMN_BITS), .ADDRESS_BITS(PLACE_BITS), .OUTPUT_STAGE(DEEP)
    ) u_sums (
        .clk_i(clk_i), .write_i(write), .write_address_i(write_place), .data_i(to_wait), .read_i(1'b1),
        .read_address_i(place), .output_i(1'b1), .data_o(waiting)
    );

    // ---- Test whether the screen shows a summary: it was decided to, and what was sent was not lost. A region that is decided
    // to show a summary sends one or has sent one, so its bit of losses has been written.
    reg none_q;  // this is the first frame, in which no summary is shown
    wire shown_read, lost_read, shown;
    raster_memory #(.WIDTH(1), .WORDS(REGIONS), .ADDRESS_BITS(REGION_BITS), .OUTPUT_STAGE(DEEP)) u_shown (
        .clk_i(clk_i), .write_i(decided_i), .write_address_i(decided_region_i), .data_i(decided_shown_i), .read_i(1'b1),
        .read_address_i(region), .output_i(1'b1), .data_o(shown_read)
    );
    raster_memory #(.WIDTH(1), .WORDS(REGIONS), .ADDRESS_BITS(REGION_BITS), .OUTPUT_STAGE(DEEP)) u_lost (
        .clk_i(clk_i), .write_i(done_i), .write_address_i(done_region_i), .data_i(done_lost_i), .read_i(1'b1),
        .read_address_i(region), .output_i(1'b1), .data_o(lost_read)
    );
    wire over;  // the words that are compared are not of the first frame
    word_delay #(.WIDTH(1), .DEPTH(SUM_CLOCKS)) u_over (.clk_i(clk_i), .data_i(!none_q), .data_o(over));
    assign shown = shown_read && !lost_read && over;
    word_delay #(.WIDTH(1), .DEPTH(4)) u_shown_later (.clk_i(clk_i), .data_i(shown), .data_o(shown_o));
    always @(posedge clk_i) none_q <= rst_i || (none_q && !frame_end);

endmodule

`default_nettype wire
