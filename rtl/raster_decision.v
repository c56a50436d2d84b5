// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the decision of a region from its scores: votes, SRS, TRS, active, and the validity of its reference. Regions come
// in order. The decision is on the ports one clock after judged_i, with DEEP two.
`default_nettype none

module raster_decision #(
    parameter HITS = 1,          // features whose score is a count
    parameter VARIANCE = 0,      // 1: regions have the score of `variance`
    parameter RANGE = 0,         // 1: regions have the score of `range`
    parameter SURFACE = 0,       // 1: regions have the score of `surface`
    parameter MAD = 0,           // 1: regions have the score of `mad`
    parameter SEGMENT = 0,       // 1: regions have the score of `segment`
    parameter ALL = 0,           // 1: every feature must vote; 0: one vote is enough
    parameter LAST_SENT = 0,     // 1: the reference is what was last sent; 0: the previous frame
    parameter BLANKS = 0,        // 1: a region without SRS loses its reference (LAST_SENT)
    parameter SUMMARIES = 0,     // 1: a region without SRS may send its summary
    parameter ZONES = 0,         // 1: regions have classes
    parameter DEEP = 0,          // 1: one more register, for a faster clock
    parameter PIXELS = 64,       // pixels of a region
    parameter COUNT_BITS = 7,    // bits of a count, 0..PIXELS
    parameter VARIANCE_BITS = 1, // bits of the score of `variance`
    parameter RANGE_BITS = 1,    // bits of the score of `range`
    parameter SURFACE_BITS = 1,  // bits of the score of `surface`
    parameter MAD_BITS = 1,      // bits of the score of `mad`
    parameter SEGMENT_BITS = 1,  // bits of the score of `segment`
    parameter REGIONS = 32400,   // regions of the frame
    parameter REGION_BITS = 15,  // ceil(log2(REGIONS))
    parameter SCORE_BITS = 14    // bits of all scores of a region: temporal count lowest, then counts, variance, range, surface, mad, segment
) (
    input  wire                   clk_i,             // clock, rising edge
    input  wire                   rst_i,             // synchronous reset, active high
    input  wire                   judged_i,          // all scores of a region are there
    input  wire [ SCORE_BITS-1:0] scores_i,          // scores of that region; the temporal count assumes a valid reference
    input  wire [ SCORE_BITS-1:0] minima_i,          // smallest value at which each score votes; the lowest bits belong to TRS
    input  wire [ SCORE_BITS-1:0] keen_minima_i,     // minima_i of keen regions (ZONES)
    input  wire [            1:0] class_i,           // class of that region (ZONES)
    input  wire                   shown_i,           // the screen shows the summary of this region (SUMMARIES)
    input  wire                   differs_i,         // a mean of this region differs from the one that was sent last (SUMMARIES)
    input  wire                   lost_i,            // a region is lost, so that its reference is no longer valid
    input  wire [REGION_BITS-1:0] lost_region_i,     // number of the lost region
    input  wire                   lost_mark_i,       // mark_o of the lost region
    output wire                   decided_o,         // the decision is on the ports after the next edge
    output wire                   will_be_active_o,  // with decided_o: the region will be active
    output wire                   will_be_sent_o,    // with decided_o: the summary of the region will be sent
    output wire                   will_be_shown_o,   // with decided_o: the screen shows the region's summary from now on (SUMMARIES)
    output wire [REGION_BITS-1:0] decided_region_o,  // with decided_o: number of the region
    output wire                   mark_o,            // with the decision: the mark that must come back if the region is lost
    output reg                    decision_valid_o,  // the decision for region_o is on the ports
    output reg  [REGION_BITS-1:0] region_o,          // the region that is decided
    output reg                    last_region_o,     // with the decision: the region is the last of the frame
    output reg                    srs_o,             // SRS, the spatial relevance of the region
    output reg                    trs_o,             // TRS, the temporal relevance of the region
    output reg                    active_o,          // SRS and TRS are both 1
    output wire                   summary_o,         // the summary of region_o is sent (SUMMARIES)
    output reg  [ SCORE_BITS-1:0] scores_o           // scores of region_o
);

    localparam VARIANCE_START = (HITS + 1) * COUNT_BITS;
    localparam RANGE_START = VARIANCE_START + VARIANCE * VARIANCE_BITS;
    localparam SURFACE_START = RANGE_START + RANGE * RANGE_BITS;
    localparam MAD_START = SURFACE_START + SURFACE * SURFACE_BITS;
    localparam SEGMENT_START = MAD_START + MAD * MAD_BITS;
    localparam FEATURES = HITS + VARIANCE + RANGE + SURFACE + MAD + SEGMENT;

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SCORE_BITS != SEGMENT_START + SEGMENT * SEGMENT_BITS) begin : g_score_bits
            SCORE_BITS_must_hold_all_scores u_refused ();
        end
    endgenerate

    localparam BEFORE_LAST = REGIONS - 2;

    reg [REGION_BITS-1:0] region_q;  // number of the region that is judged
    reg last_region_q;
    reg no_reference_q;              // this is the first frame, in which no region has a reference
    wire [REGION_BITS-1:0] next_region = last_region_q ? {REGION_BITS{1'b0}} : region_q + 1'b1;
    wire reference_valid;            // this region has a valid reference (LAST_SENT)

    // Without a valid reference all pixels count as changed.
    wire [COUNT_BITS-1:0] changes =
        !LAST_SENT || reference_valid ? scores_i[COUNT_BITS-1:0] : PIXELS[COUNT_BITS-1:0];
    wire [SCORE_BITS-1:0] scores = {scores_i[SCORE_BITS-1:COUNT_BITS], changes};
    wire [FEATURES:0] votes;
    wire [SCORE_BITS-1:0] minima;
    genvar i;
    generate
        for (i = 0; i <= HITS; i = i + 1) begin : g_count
            vote #(.WIDTH(COUNT_BITS)) u_vote (
                .score_i(scores[i*COUNT_BITS+:COUNT_BITS]), .minimum_i(minima[i*COUNT_BITS+:COUNT_BITS]),
                .vote_o(votes[i])
            );
        end
        if (VARIANCE) begin : g_variance
            vote #(.WIDTH(VARIANCE_BITS)) u_vote (
                .score_i(scores[VARIANCE_START+:VARIANCE_BITS]), .minimum_i(minima[VARIANCE_START+:VARIANCE_BITS]),
                .vote_o(votes[HITS+1])
            );
        end
        if (RANGE) begin : g_range
            vote #(.WIDTH(RANGE_BITS)) u_vote (
                .score_i(scores[RANGE_START+:RANGE_BITS]), .minimum_i(minima[RANGE_START+:RANGE_BITS]),
                .vote_o(votes[HITS+VARIANCE+1])
            );
        end
        if (SURFACE) begin : g_surface
            vote #(.WIDTH(SURFACE_BITS)) u_vote (
                .score_i(scores[SURFACE_START+:SURFACE_BITS]), .minimum_i(minima[SURFACE_START+:SURFACE_BITS]),
                .vote_o(votes[HITS+VARIANCE+RANGE+1])
            );
        end
        if (MAD) begin : g_mad
            vote #(.WIDTH(MAD_BITS)) u_vote (
                .score_i(scores[MAD_START+:MAD_BITS]), .minimum_i(minima[MAD_START+:MAD_BITS]),
                .vote_o(votes[HITS+VARIANCE+RANGE+SURFACE+1])
            );
        end
        if (SEGMENT) begin : g_segment
            vote #(.WIDTH(SEGMENT_BITS)) u_vote (
                .score_i(scores[SEGMENT_START+:SEGMENT_BITS]), .minimum_i(minima[SEGMENT_START+:SEGMENT_BITS]),
                .vote_o(votes[FEATURES])
            );
        end
    endgenerate

    wire [FEATURES:0] decided_votes;
    wire [SCORE_BITS-1:0] decided_scores;
    wire [REGION_BITS-1:0] decided_region;
    wire decided_valid;  // the reference of the decided region was valid
    wire decided_last;   // the decided region is the last of the frame
    bit_delay #(.DEPTH(DEEP)) u_decided (.clk_i(clk_i), .rst_i(rst_i), .bit_i(judged_i), .bit_o(decided_o));
    word_delay #(.WIDTH(FEATURES + 3 + REGION_BITS + SCORE_BITS), .DEPTH(DEEP)) u_judged (
        .clk_i(clk_i), .data_i({votes, reference_valid, last_region_q, region_q, scores}),
        .data_o({decided_votes, decided_valid, decided_last, decided_region, decided_scores})
    );
    wire relevant = ALL ? &decided_votes[FEATURES:1] : |decided_votes[FEATURES:1];
    wire srs;
    wire trs = decided_votes[0];
    assign decided_region_o = decided_region;
    assign will_be_active_o = decided_o && srs && trs;

    always @(posedge clk_i) begin
        decision_valid_o <= decided_o;
        srs_o            <= decided_o && srs;
        trs_o            <= decided_o && trs;
        active_o         <= will_be_active_o;
        region_o         <= decided_region;
        last_region_o    <= decided_last;
        scores_o         <= decided_scores;
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
        if (ZONES) begin : g_zones
            localparam [1:0] OFF = 2'd1;
            localparam [1:0] KEEN = 2'd2;
            localparam [1:0] ALWAYS = 2'd3;
            wire [1:0] decided_class;
            word_delay #(.WIDTH(2), .DEPTH(DEEP)) u_class (.clk_i(clk_i), .data_i(class_i), .data_o(decided_class));
            assign minima = class_i == KEEN ? keen_minima_i : minima_i;
            assign srs = decided_class == ALWAYS || (relevant && decided_class != OFF);
        end else begin : g_no_zones
            wire unused_zones = |keen_minima_i || |class_i;
            assign minima = minima_i;
            assign srs = relevant;
        end
        if (LAST_SENT) begin : g_valid
            wire blanked = BLANKS && !srs;
            raster_valid #(.REGIONS(REGIONS), .REGION_BITS(REGION_BITS), .DEEP(DEEP)) u_valid (
                .clk_i(clk_i), .rst_i(rst_i), .none_i(no_reference_q), .region_i(judged_i ? next_region : region_q),
                .valid_o(reference_valid), .decided_i(decided_o), .decided_region_i(decided_region),
                .next_i(srs && trs ? 1'b1 : blanked ? 1'b0 : decided_valid), .mark_o(mark_o),
                .lost_i(lost_i), .lost_region_i(lost_region_i), .lost_mark_i(lost_mark_i)
            );
        end else begin : g_previous
            wire unused_reference = decided_valid || no_reference_q || lost_i || |lost_region_i || lost_mark_i;
            assign reference_valid = 1'b1;
            assign mark_o = 1'b0;
        end

        if (SUMMARIES) begin : g_summaries
            wire decided_shown, decided_differs;
            reg summary_q;
            word_delay #(.WIDTH(2), .DEPTH(DEEP)) u_compared (
                .clk_i(clk_i), .data_i({shown_i, differs_i}), .data_o({decided_shown, decided_differs})
            );
            assign will_be_sent_o = decided_o && !srs && (!decided_shown || decided_differs);
            assign will_be_shown_o = !srs || (decided_shown && !trs);
            always @(posedge clk_i) summary_q <= will_be_sent_o && !rst_i;
            assign summary_o = summary_q;
        end else begin : g_no_summaries
            wire unused_summaries = differs_i || shown_i;
            assign will_be_sent_o = 1'b0;
            assign will_be_shown_o = 1'b0;
            assign summary_o = 1'b0;
        end
    endgenerate

endmodule

`default_nettype wire
