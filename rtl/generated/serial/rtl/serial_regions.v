// SPDX-License-Identifier: MIT OR Apache-2.0
// Follows the slot that is worked on, the score that passes the decision, and the region of that score. The outputs are
// those of the step of the same clock.
`default_nettype none

module serial_regions #(
    parameter FOLD = 1,             // regions of a lane
    parameter LANES = 784,          // lanes of the array
    parameter FEATURES = 1,         // spatial features, 1 to 4
    parameter [7:0] KINDS = 8'd0,   // two bits per feature, the first lowest: 0 edge, 1 corner, 2 mad, 3 variance
    parameter MAD = 0,              // 1: the design has the feature `mad`
    parameter VARIANCE = 0,         // 1: the design has the feature `variance`
    parameter MEANS = 0,            // blocks of a region whose means are sent: 1, 4 or 16; 0: none
    parameter BLOCK_BITS = 1,       // bits of the number of a block, at least 1
    parameter SLOT_BITS = 1,        // bits of the number of a slot, at least 1
    parameter REGION_BITS = 10,     // bits of the number of a region, empty slots included
    parameter INDEX_BITS = 1        // bits of the number of a score
) (
    input  wire                   clk_i,         // clock, rising edge
    input  wire                   loading_i,     // a frame enters
    input  wire                   rotating_i,    // a score passes the decision
    input  wire                   shifting_i,    // a score or a pixel moves on by one lane
    input  wire                   averaging_i,   // the score that passes is the sum of a block
    input  wire                   block_ends_i,  // the block is done
    input  wire                   slot_ends_i,   // the slot is done
    output wire [  SLOT_BITS-1:0] slot_o,        // number of the slot
    output wire                   last_slot_o,   // the slot is the last of the frame
    output wire [ INDEX_BITS-1:0] index_o,       // number of the score
    output wire                   first_score_o, // the score is the first of the slot
    output wire                   last_score_o,  // the score is the last of the slot
    output wire [ BLOCK_BITS-1:0] block_o,       // number of the block
    output wire                   last_block_o,  // the block is the last of the region
    output wire [            1:0] next_kind_o,   // kind of the feature that comes next: 0 edge, 1 corner, 2 mad, 3 variance
    output wire                   squares_o,     // the feature under way is `variance`
    output wire [REGION_BITS-1:0] region_o,      // number of the region whose score passes
    output wire                   last_lane_o    // the region is that of the last lane
);

    /* verilator lint_off WIDTH */
    localparam [REGION_BITS-1:0] LAST_LANE = (LANES - 1) * FOLD;
    localparam [REGION_BITS-1:0] REGION_STEP = FOLD;
    localparam [INDEX_BITS-1:0] LAST_SCORE = FEATURES;
    /* verilator lint_on WIDTH */

    // Scores.
    reg [INDEX_BITS-1:0] index_q;
    reg squares_q;
    wire [7:0] kinds = KINDS >> {index_q, 1'b0};
    wire unused_kinds = |kinds;

    // With means, the temporal count is done only when the sums of all blocks have passed.
    wire waits = MEANS != 0 && (averaging_i ? !last_block_o : first_score_o);

    assign index_o = index_q;
    assign first_score_o = index_q == {INDEX_BITS{1'b0}};
    assign last_score_o = index_q == LAST_SCORE;
    assign next_kind_o = FEATURES == 1 ? KINDS[1:0] : kinds[1:0];
    assign squares_o = VARIANCE && (!MAD || squares_q);

    always @(posedge clk_i) begin
        if (loading_i || slot_ends_i) index_q <= {INDEX_BITS{1'b0}};
        else if (rotating_i && last_lane_o && !last_score_o && !waits) begin
            index_q   <= index_q + 1'b1;
            squares_q <= next_kind_o == 2'd3;
        end
    end

    // Blocks.
    generate
        if (MEANS > 1) begin : g_block
            reg [BLOCK_BITS-1:0] block_q;
            assign block_o = block_q;
            assign last_block_o = &block_q;

            always @(posedge clk_i) begin
                if (loading_i) block_q <= {BLOCK_BITS{1'b0}};
                else if (block_ends_i) block_q <= block_q + 1'b1;
            end
        end else begin : g_no_block
            wire unused_block = block_ends_i;
            assign block_o = {BLOCK_BITS{1'b0}};
            assign last_block_o = 1'b1;
        end
    endgenerate

    // Slots.
    generate
        if (FOLD > 1) begin : g_slot
            localparam LAST_SLOT = FOLD - 1;
            reg [SLOT_BITS-1:0] slot_q;
            assign last_slot_o = slot_q == LAST_SLOT[SLOT_BITS-1:0];
            assign slot_o = slot_q;

            always @(posedge clk_i) begin
                if (loading_i) slot_q <= {SLOT_BITS{1'b0}};
                else if (slot_ends_i) slot_q <= slot_q + 1'b1;
            end
        end else begin : g_no_slot
            assign last_slot_o = 1'b1;
            assign slot_o = {SLOT_BITS{1'b0}};
        end
    endgenerate

    // Regions.
    reg [REGION_BITS-1:0] region_q;
    wire [REGION_BITS-1:0] first_region;
    assign region_o = region_q;

    always @(posedge clk_i) begin
        if (rotating_i || shifting_i) region_q <= region_q + REGION_STEP;
        else region_q <= first_region;
    end

    generate
        if (REGION_BITS > SLOT_BITS) begin : g_first
            assign first_region = {{(REGION_BITS - SLOT_BITS) {1'b0}}, slot_o};
        end else begin : g_first_narrow
            assign first_region = slot_o;
        end
        if (LANES > 1) begin : g_lanes
            assign last_lane_o = region_q >= LAST_LANE;
        end else begin : g_lane
            assign last_lane_o = 1'b1;
            wire unused_region = |LAST_LANE;
        end
    endgenerate

endmodule

`default_nettype wire
