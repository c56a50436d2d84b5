// SPDX-License-Identifier: MIT OR Apache-2.0
// Follows the slot that is worked on, the score that passes the decision, and the region of that score. The outputs are
// those of the step of the same clock.
`default_nettype none

module serial_regions #(
    parameter FOLD = 1,             // regions of a lane
    parameter LANES = 784,          // lanes of the array
    parameter FEATURES = 1,         // spatial features, 1 to 8
    parameter EDGE_INDEX = 1,       // number of the score of `edge`, from 1 on in the order of the ports; 0: there is none
    parameter CORNER_INDEX = 0,     // number of the score of `corner`; 0: there is none
    parameter MAD_INDEX = 0,        // number of the score of `mad`; 0: there is none
    parameter VARIANCE_INDEX = 0,   // number of the score of `variance`; 0: there is none
    parameter RANGE_INDEX = 0,      // number of the score of `range`; 0: there is none
    parameter SURFACE_INDEX = 0,    // number of the score of `surface`; 0: there is none
    parameter SEGMENT_INDEX = 0,    // number of the score of `segment`; 0: there is none
    parameter FLOW_INDEX = 0,       // number of the score of `flow`; 0: there is none
    parameter MEANS = 0,            // blocks of a region whose means are sent: 1, 4 or 16; 0: none
    parameter BLOCK_BITS = 1,       // bits of the number of a block, at least 1
    parameter SLOT_BITS = 1,        // bits of the number of a slot, at least 1
    parameter REGION_BITS = 10,     // bits of the number of a region, empty slots included
    parameter INDEX_BITS = 1,       // bits of the number of a score
    parameter ZONES = 0             // 1: a slot begins with the classes of its regions
) (
    input  wire                   clk_i,         // clock, rising edge
    input  wire                   loading_i,     // a frame enters
    input  wire                   rotating_i,    // a score passes the decision
    input  wire                   shifting_i,    // a score or a pixel moves on by one lane
    input  wire                   classing_i,    // a class passes (ZONES)
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
    output wire                   next_edge_o,   // the feature that comes next is `edge`
    output wire                   next_corner_o, // the feature that comes next is `corner`
    output wire                   next_range_o,  // the feature that comes next is `range`
    output wire                   next_surface_o, // the feature that comes next is `surface`
    output wire                   next_flow_o,   // the feature that comes next is `flow`
    output wire                   ranges_o,      // the feature under way is `range`
    output wire                   squares_o,     // the feature under way is `variance`
    output wire                   surfaces_o,    // the feature under way is `surface`
    output wire                   segments_o,    // the feature under way is `segment`
    output wire                   flows_o,       // the feature under way is `flow`
    output wire [REGION_BITS-1:0] region_o,      // number of the region whose score passes
    output wire                   last_lane_o    // the region is that of the last lane
);

    /* verilator lint_off WIDTH */
    localparam [REGION_BITS-1:0] LAST_LANE = (LANES - 1) * FOLD;
    localparam [REGION_BITS-1:0] REGION_STEP = FOLD;
    localparam [INDEX_BITS-1:0] LAST_SCORE = FEATURES;
    localparam [INDEX_BITS-1:0] BEFORE_EDGE = EDGE_INDEX - 1;
    localparam [INDEX_BITS-1:0] BEFORE_CORNER = CORNER_INDEX - 1;
    localparam [INDEX_BITS-1:0] BEFORE_VARIANCE = VARIANCE_INDEX - 1;
    localparam [INDEX_BITS-1:0] BEFORE_RANGE = RANGE_INDEX - 1;
    localparam [INDEX_BITS-1:0] BEFORE_SURFACE = SURFACE_INDEX - 1;
    localparam [INDEX_BITS-1:0] BEFORE_SEGMENT = SEGMENT_INDEX - 1;
    localparam [INDEX_BITS-1:0] BEFORE_FLOW = FLOW_INDEX - 1;
    /* verilator lint_on WIDTH */

    // Scores.
    reg [INDEX_BITS-1:0] index_q;
    reg squares_q, ranges_q, surfaces_q, segments_q, flows_q;
    wire next_variance = VARIANCE_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_VARIANCE);
    wire next_segment = SEGMENT_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_SEGMENT);

    // With means, the temporal count is done only when the sums of all blocks have passed.
    wire waits = MEANS != 0 && (averaging_i ? !last_block_o : first_score_o);

    assign index_o = index_q;
    assign first_score_o = index_q == {INDEX_BITS{1'b0}};
    assign last_score_o = index_q == LAST_SCORE;
    assign next_edge_o = EDGE_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_EDGE);
    assign next_corner_o = CORNER_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_CORNER);
    assign next_range_o = RANGE_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_RANGE);
    assign next_surface_o = SURFACE_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_SURFACE);
    assign next_flow_o = FLOW_INDEX != 0 && (FEATURES == 1 || index_q == BEFORE_FLOW);
    // `mad`, `variance` and `segment` begin with the same step, so nothing asks which of them comes next. Only their steps and
    // those of `range`, `surface` and `flow` ask which of the six is under way, so a design that has one of them needs no register.
    localparam ALONE = (MAD_INDEX != 0) + (VARIANCE_INDEX != 0) + (RANGE_INDEX != 0) + (SURFACE_INDEX != 0) + (SEGMENT_INDEX != 0)
        + (FLOW_INDEX != 0) == 1;
    assign ranges_o = RANGE_INDEX != 0 && (ALONE || ranges_q);
    assign squares_o = VARIANCE_INDEX != 0 && (ALONE || squares_q);
    assign surfaces_o = SURFACE_INDEX != 0 && (ALONE || surfaces_q);
    assign segments_o = SEGMENT_INDEX != 0 && (ALONE || segments_q);
    assign flows_o = FLOW_INDEX != 0 && (ALONE || flows_q);

    always @(posedge clk_i) begin
        if (loading_i || slot_ends_i) index_q <= {INDEX_BITS{1'b0}};
        else if (rotating_i && last_lane_o && !last_score_o && !waits) begin
            index_q   <= index_q + 1'b1;
            squares_q <= next_variance;
            ranges_q  <= next_range_o;
            surfaces_q <= next_surface_o;
            segments_q <= next_segment;
            flows_q <= next_flow_o;
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

    // Classes pass at the first step of a slot already, so the number of its first region is ready one clock early.
    generate
        if (ZONES) begin : g_classes
            always @(posedge clk_i) begin
                if (slot_ends_i) region_q <= first_region + 1'b1;
                else if (rotating_i || shifting_i || classing_i) region_q <= region_q + REGION_STEP;
                else region_q <= first_region;
            end
        end else begin : g_no_classes
            wire unused_classing = classing_i;
            always @(posedge clk_i) begin
                if (rotating_i || shifting_i) region_q <= region_q + REGION_STEP;
                else region_q <= first_region;
            end
        end
    endgenerate

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
