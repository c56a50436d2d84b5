// SPDX-License-Identifier: MIT OR Apache-2.0
// The decision for a region whose scores are there: votes, SRS, TRS, and whether its reference is valid.
// Regions come in their order. A clock later (deep: two) their decision is on the ports.
`default_nettype none

// Parts that the design does not elaborate are left out, so some parameters have no use.
// verilator lint_off UNUSEDPARAM

module raster_decision #(
    parameter EDGE = 1,           // 1: edges are counted
    parameter CORNER = 0,         // 1: corners are counted
    parameter MAD = 0,            // 1: the mean absolute deviation is a score
    parameter VARIANCE = 0,       // 1: the variance is a score
    parameter ALL = 0,            // 1: every feature must vote; 0: one vote is enough
    parameter LAST_SENT = 0,      // 1: the reference is what was last sent; 0: the previous frame
    parameter BLANKS = 0,         // 1: a region without SRS loses its reference (LAST_SENT)
    parameter DEEP = 0,           // 1: a register more, for a faster clock
    parameter PIXELS = 64,        // pixels of a region
    parameter COUNT_BITS = 7,     // bits of a count, 0..PIXELS
    parameter REGIONS = 32400,    // regions of the frame
    parameter REGION_BITS = 15,   // ceil(log2(REGIONS))
    parameter MAD_BITS = 14,      // bits of the score of MAD
    parameter VARIANCE_BITS = 26  // bits of the score of VARIANCE
) (
    input  wire                                  clk_i,             // clock, rising edge
    input  wire                                  rst_i,             // synchronous reset, active high
    input  wire                                  judged_i,          // the scores of a region are there
    input  wire [(EDGE+CORNER+1)*COUNT_BITS-1:0] counts_i,          // corners, edges, changes: what is counted
    input  wire [                  MAD_BITS-1:0] mad_i,             // mean absolute deviation
    input  wire [             VARIANCE_BITS-1:0] variance_i,        // variance
    input  wire [                COUNT_BITS-1:0] edge_min_i,        // edges vote from this count on
    input  wire [                COUNT_BITS-1:0] corner_min_i,      // corners
    input  wire [                  MAD_BITS-1:0] mad_min_i,         // the mean absolute deviation
    input  wire [             VARIANCE_BITS-1:0] variance_min_i,    // the variance
    input  wire [                COUNT_BITS-1:0] temporal_min_i,    // TRS from this count on
    input  wire                                  lost_i,            // a region is lost, and its reference with it
    input  wire [               REGION_BITS-1:0] lost_region_i,     // which
    input  wire                                  lost_mark_i,       // its mark
    output wire                                  decided_o,         // the decision is on the ports after the next edge
    output wire                                  will_be_active_o,  // and active_o with it
    output wire                                  mark_o,            // with the decision: what comes back if the region is lost
    output reg                                   decision_valid_o,  // the decision for region_o
    output reg  [               REGION_BITS-1:0] region_o,          // the region that is decided
    output reg                                   last_region_o,     // with the decision: the last region of the frame
    output reg                                   srs_o,             // spatial relevance
    output reg                                   trs_o,             // temporal relevance
    output reg                                   active_o,          // both
    output reg  [                COUNT_BITS-1:0] edge_score_o,      // edges
    output reg  [                COUNT_BITS-1:0] corner_score_o,    // corners
    output reg  [                  MAD_BITS-1:0] mad_score_o,       // mean absolute deviation
    output reg  [             VARIANCE_BITS-1:0] variance_score_o,  // variance
    output reg  [                COUNT_BITS-1:0] temporal_count_o   // changed pixels
);

    localparam BEFORE_LAST = REGIONS - 2;
    localparam [3:0] PRESENT = {VARIANCE != 0, MAD != 0, CORNER != 0, EDGE != 0};
    localparam EDGE_PLACE = EDGE + CORNER > 0 ? 1 : 0;
    localparam CORNER_PLACE = EDGE + CORNER;

    reg [REGION_BITS-1:0] region_q;  // the region that is judged
    reg last_region_q;
    reg no_reference_q;              // in the first frame no region has one
    wire [REGION_BITS-1:0] next_region = last_region_q ? {REGION_BITS{1'b0}} : region_q + 1'b1;
    wire reference_valid;            // of that region (LAST_SENT)

    wire [COUNT_BITS-1:0] temporal_count =
        !LAST_SENT || reference_valid ? counts_i[COUNT_BITS-1:0] : PIXELS[COUNT_BITS-1:0];
    wire [COUNT_BITS-1:0] edge_count = counts_i[EDGE_PLACE*COUNT_BITS+:COUNT_BITS];
    wire [COUNT_BITS-1:0] corner_count = counts_i[CORNER_PLACE*COUNT_BITS+:COUNT_BITS];
    wire [3:0] votes;
    wire trs;
    vote #(.WIDTH(COUNT_BITS)) u_edge_vote (.score_i(edge_count), .minimum_i(edge_min_i), .vote_o(votes[0]));
    vote #(.WIDTH(COUNT_BITS)) u_corner_vote (.score_i(corner_count), .minimum_i(corner_min_i), .vote_o(votes[1]));
    vote #(.WIDTH(MAD_BITS)) u_mad_vote (.score_i(mad_i), .minimum_i(mad_min_i), .vote_o(votes[2]));
    vote #(.WIDTH(VARIANCE_BITS)) u_variance_vote (
        .score_i(variance_i), .minimum_i(variance_min_i), .vote_o(votes[3])
    );
    vote #(.WIDTH(COUNT_BITS)) u_trs (.score_i(temporal_count), .minimum_i(temporal_min_i), .vote_o(trs));

    wire decided_trs;
    wire [3:0] decided_votes;
    wire [COUNT_BITS-1:0] decided_temporal, decided_edges, decided_corners;
    wire [MAD_BITS-1:0] decided_mad;
    wire [VARIANCE_BITS-1:0] decided_variance;
    wire [REGION_BITS-1:0] decided_region;
    wire decided_valid;  // its reference was valid
    wire decided_last;   // the region is the last of the frame
    bit_delay #(.DEPTH(DEEP)) u_decided (.clk_i(clk_i), .rst_i(rst_i), .bit_i(judged_i), .bit_o(decided_o));
    word_delay #(.WIDTH(7 + REGION_BITS + 3 * COUNT_BITS + MAD_BITS + VARIANCE_BITS), .DEPTH(DEEP)) u_judged (
        .clk_i(clk_i),
        .data_i({votes, trs, reference_valid, last_region_q, region_q, temporal_count, edge_count, corner_count, mad_i, variance_i}),
        .data_o({decided_votes, decided_trs, decided_valid, decided_last, decided_region, decided_temporal,
                 decided_edges, decided_corners, decided_mad, decided_variance})
    );
    wire srs = ALL ? &(decided_votes | ~PRESENT) : |(decided_votes & PRESENT);
    assign will_be_active_o = decided_o && srs && decided_trs;

    always @(posedge clk_i) begin
        decision_valid_o <= decided_o;
        srs_o            <= decided_o && srs;
        trs_o            <= decided_o && decided_trs;
        active_o         <= will_be_active_o;
        region_o         <= decided_region;
        last_region_o    <= decided_last;
        temporal_count_o <= decided_temporal;
        edge_score_o     <= decided_edges;
        corner_score_o   <= decided_corners;
        mad_score_o      <= decided_mad;
        variance_score_o <= decided_variance;
        if (judged_i) begin
            region_q      <= next_region;
            last_region_q <= region_q == BEFORE_LAST[REGION_BITS-1:0];
            if (last_region_q) no_reference_q <= 1'b0;
        end
        if (rst_i) begin
            decision_valid_o <= 1'b0;
            srs_o            <= 1'b0;
            trs_o            <= 1'b0;
            active_o         <= 1'b0;
            region_q         <= {REGION_BITS{1'b0}};
            last_region_q    <= 1'b0;
            no_reference_q   <= 1'b1;
        end
    end

    generate
        if (LAST_SENT) begin : g_valid
            wire blanked = BLANKS && !srs;
            raster_valid #(.REGIONS(REGIONS), .REGION_BITS(REGION_BITS), .DEEP(DEEP)) u_valid (
                .clk_i(clk_i), .rst_i(rst_i), .none_i(no_reference_q), .region_i(judged_i ? next_region : region_q),
                .valid_o(reference_valid), .decided_i(decided_o), .decided_region_i(decided_region),
                .next_i(srs && decided_trs ? 1'b1 : blanked ? 1'b0 : decided_valid), .mark_o(mark_o),
                .lost_i(lost_i), .lost_region_i(lost_region_i), .lost_mark_i(lost_mark_i)
            );
        end else begin : g_previous
            wire unused_reference = decided_valid || no_reference_q || lost_i || |lost_region_i || lost_mark_i;
            assign reference_valid = 1'b1;
            assign mark_o = 1'b0;
        end
    endgenerate

endmodule

// verilator lint_on UNUSEDPARAM

`default_nettype wire
