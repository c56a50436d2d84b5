// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes what the irrelevant regions of the serial array send in place of their pixels: the means of their blocks, if the
// screen shows no summary, or if a mean differs from the shown one by more than level_i. summary_o comes with the decision.
//
// The sums of blocks pass, one region after the other, and become means. They are written to one of two memories, while the
// other one has the means that the screen shows. If a summary is sent, the memories of that region change roles. No step
// waits for a mean, because a whole pass of a feature lies before the decision.
`default_nettype none

module serial_summary #(
    parameter WIDTH = 8,                     // bits of a pixel
    parameter MEANS = 4,                     // blocks of a region: 1, 4 or 16
    parameter BLOCK_BITS = 2,                // bits of the number of a block, at least 1
    parameter SUM_BITS = 12,                 // bits of the sum of a block plus half of its pixels
    parameter FACTOR_BITS = 1,               // bits of FACTOR
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // (sum * FACTOR) >> SHIFT is the sum divided by the pixels of a block
    parameter SHIFT = 4,                     // bits of the product that are dropped
    parameter SLOTS = 784,                   // number of regions plus empty slots
    parameter REGION_BITS = 10,              // bits of the number of a slot of the array
    parameter ZONES = 0                      // 1: regions have classes
) (
    input  wire                   clk_i,           // clock, rising edge
    input  wire                   rst_i,           // synchronous reset, active high
    input  wire                   frame_i,         // all scores of a frame have passed
    input  wire [REGION_BITS-1:0] next_region_i,   // region_i at the next clock
    input  wire [ BLOCK_BITS-1:0] next_block_i,    // block_i at the next clock
    input  wire [REGION_BITS-1:0] region_i,        // number of the region that passes
    input  wire [ BLOCK_BITS-1:0] block_i,         // number of the block that passes
    input  wire                   average_i,       // the sum of that block passes
    input  wire [   SUM_BITS-1:0] sum_i,           // the sum of that block
    input  wire                   decided_i,       // the decision for region_i is made
    input  wire                   srs_i,           // SRS of that decision
    input  wire                   active_i,        // SRS and TRS of that decision are both 1
    input  wire [      WIDTH-1:0] level_i,         // a mean that differs by more than this level is sent again
    input  wire [      WIDTH-1:0] keen_level_i,    // level_i of keen regions (ZONES)
    input  wire [      WIDTH-1:0] off_level_i,     // level_i of regions that are off (ZONES)
    input  wire [            1:0] class_i,         // class of region_i (ZONES)
    output wire                   summary_o,       // the summary of region_i is sent; 0 unless decided_i
    output wire [      WIDTH-1:0] mean_o           // the mean of block_i that region_i shows
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (MEANS != 1 && MEANS != 4 && MEANS != 16) begin : g_means MEANS_must_be_1_4_or_16 u_refused (); end
        if (BLOCK_BITS != (MEANS > 1 ? $clog2(MEANS) : 1)) begin : g_block_bits
            BLOCK_BITS_must_number_the_blocks u_refused ();
        end
        if (SUM_BITS < WIDTH) begin : g_sum_bits SUM_BITS_must_be_WIDTH_or_more u_refused (); end
        if (SHIFT < 0 || SHIFT + WIDTH > SUM_BITS + FACTOR_BITS) begin : g_shift
            SHIFT_and_WIDTH_must_lie_in_the_product u_refused ();
        end
        if (REGION_BITS != (SLOTS > 1 ? $clog2(SLOTS) : 1)) begin : g_region_bits
            REGION_BITS_must_number_the_slots u_refused ();
        end
    endgenerate

    localparam PLACES = SLOTS > 1 ? SLOTS : 2;
    localparam WORDS = PLACES * MEANS;
    localparam WORD_BITS = REGION_BITS + $clog2(MEANS);
    localparam PRODUCT_BITS = SUM_BITS + FACTOR_BITS;

    wire [WORD_BITS-1:0] next, passing;
    generate
        if (MEANS > 1) begin : g_blocks
            assign next = {next_region_i, next_block_i};
            assign passing = {region_i, block_i};
        end else begin : g_block
            wire unused_blocks = |next_block_i || |block_i;
            assign next = next_region_i;
            assign passing = region_i;
        end
    endgenerate

    // Two flags per region: the screen shows a summary, and this summary is in the second memory. In the first frame it shows
    // none, and the new means go to the first memory.
    reg  first_q;
    wire was_shown, was_second;
    wire shows = was_shown && !first_q;
    wire second = was_second && !first_q;
    wire to_second = !was_second && !first_q;

    always @(posedge clk_i) begin
        if (rst_i) first_q <= 1'b1;
        else if (frame_i) first_q <= 1'b0;
    end

    frame_store #(.WIDTH(2), .PIXELS(PLACES), .ADDRESS_BITS(REGION_BITS)) u_shown (
        .clk_i(clk_i), .write_i(decided_i), .address_i(region_i),
        .data_i({!active_i && (summary_o || shows), summary_o ? to_second : !to_second}),
        .data_o({was_shown, was_second})
    );

    // The means, read one clock before their region passes.
    reg passed_q, to_second_q;
    reg [WORD_BITS-1:0] passed_at_q;
    reg [SUM_BITS-1:0] sum_q;
    reg [WIDTH-1:0] shown_q;
    wire [WIDTH-1:0] in_first, in_second;
    // The bits below SHIFT are the remainder. The bits above the mean are never set.
    /* verilator lint_off UNUSEDSIGNAL */
    wire [PRODUCT_BITS-1:0] product = {{FACTOR_BITS{1'b0}}, sum_q} * {{SUM_BITS{1'b0}}, FACTOR};
    /* verilator lint_on UNUSEDSIGNAL */
    wire [WIDTH-1:0] mean = product[SHIFT+:WIDTH];
    assign mean_o = second ? in_second : in_first;

    serial_means #(.WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(WORD_BITS)) u_first (
        .clk_i(clk_i), .write_i(passed_q && !to_second_q), .write_address_i(passed_at_q), .data_i(mean),
        .read_address_i(next), .data_o(in_first)
    );
    serial_means #(.WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(WORD_BITS)) u_second (
        .clk_i(clk_i), .write_i(passed_q && to_second_q), .write_address_i(passed_at_q), .data_i(mean),
        .read_address_i(next), .data_o(in_second)
    );

    // The difference of a mean from the shown one, and per region whether a difference was above the level.
    reg compared_q, starts_q;
    reg [REGION_BITS-1:0] compared_at_q;
    reg [WIDTH:0] difference_q;
    wire above, differs;

    always @(posedge clk_i) begin
        passed_q   <= average_i && !rst_i;
        compared_q <= passed_q && !rst_i;
        to_second_q <= to_second;
        passed_at_q <= passing;
        sum_q <= sum_i;
        shown_q <= mean_o;
        compared_at_q <= passed_at_q[WORD_BITS-1-:REGION_BITS];
        difference_q <= {1'b0, mean} - {1'b0, shown_q};
    end

    generate
        if (MEANS > 1) begin : g_starts
            always @(posedge clk_i) starts_q <= ~|passed_at_q[0+:BLOCK_BITS];
        end else begin : g_always_starts
            always @(posedge clk_i) starts_q <= 1'b1;
        end
    endgenerate

    // The level of the class of the region whose mean is compared, which passed two clocks ago.
    wire [WIDTH-1:0] level;
    generate
        if (ZONES) begin : g_zones
            localparam [1:0] OFF = 2'd1;
            localparam [1:0] KEEN = 2'd2;
            reg [1:0] passed_class_q, compared_class_q;
            assign level = compared_class_q == KEEN ? keen_level_i : compared_class_q == OFF ? off_level_i : level_i;

            always @(posedge clk_i) begin
                passed_class_q   <= class_i;
                compared_class_q <= passed_class_q;
            end
        end else begin : g_no_zones
            wire unused_zones = |keen_level_i || |off_level_i || |class_i;
            assign level = level_i;
        end
    endgenerate

    magnitude_above #(.WIDTH(WIDTH + 1)) u_above (
        .value_i(difference_q), .level_i(level), .above_o(above)
    );

    frame_store #(.WIDTH(1), .PIXELS(PLACES), .ADDRESS_BITS(REGION_BITS)) u_differs (
        .clk_i(clk_i), .write_i(compared_q), .address_i(compared_q ? compared_at_q : region_i),
        .data_i(above || (!starts_q && differs)), .data_o(differs)
    );

    assign summary_o = decided_i && !srs_i && (!shows || differs);

endmodule

`default_nettype wire
