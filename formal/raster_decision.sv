// SPDX-License-Identifier: MIT OR Apache-2.0
// Table I for every region in turn: votes, SRS, TRS, active, and the temporal count of a region without a valid reference
// (LAST_SENT); with SUMMARIES also the summaries that are sent. No region is lost here. A region is judged two clocks after a reset
// or later, because its pixels take longer.
module properties #(
    parameter ALL = 0, parameter LAST_SENT = 0, parameter BLANKS = 0, parameter DEEP = 0, parameter SUMMARIES = 0, parameter ZONES = 0
) (
    input wire clk_i, rst_i, judged, lost, shown, differs, input wire [16:0] scores, input wire [2:0] edge_min, variance_min, temporal_min,
    input wire [1:0] range_min, surface_min, mad_min, segment_min, region_class, input wire [16:0] keen_minima
);
    `include "reset.vh"
    localparam REGIONS = 8, PIXELS = 4;
    wire [16:0] minima = {segment_min, mad_min, surface_min, range_min, variance_min, edge_min, temporal_min};
    wire [16:0] own_minima = ZONES && region_class == 2 ? keen_minima : minima;
    localparam WIDTH = 20 + 4;  // bits of the ports of a decision
    wire decided, will_be_active, mark, decision_valid, last_region, srs, trs, active, summary, will_be_sent, will_be_shown;
    wire [2:0] region, decided_region, edges, variance, changes;
    wire [1:0] range, surface, mad, segment;
    raster_decision #(
        .HITS(1), .VARIANCE(1), .RANGE(1), .SURFACE(1), .MAD(1), .SEGMENT(1), .ALL(ALL), .LAST_SENT(LAST_SENT), .BLANKS(BLANKS), .SUMMARIES(SUMMARIES), .ZONES(ZONES), .DEEP(DEEP), .PIXELS(PIXELS), .COUNT_BITS(3),
        .REGIONS(REGIONS), .REGION_BITS(3), .SCORE_BITS(17), .VARIANCE_BITS(3), .RANGE_BITS(2), .SURFACE_BITS(2), .MAD_BITS(2), .SEGMENT_BITS(2)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .judged_i(judged), .scores_i(scores), .minima_i(minima), .keen_minima_i(keen_minima), .class_i(region_class),
        .shown_i(shown), .differs_i(differs), .summary_o(summary), .will_be_sent_o(will_be_sent),
        .will_be_shown_o(will_be_shown), .decided_region_o(decided_region), .lost_i(lost), .lost_region_i(3'd0), .lost_mark_i(1'b0), .decided_o(decided),
        .will_be_active_o(will_be_active), .mark_o(mark), .decision_valid_o(decision_valid), .region_o(region),
        .last_region_o(last_region), .srs_o(srs), .trs_o(trs), .active_o(active), .scores_o({segment, mad, surface, range, variance, edges, changes})
    );

    // The values by the contract. Above the temporal count are a count, a variance of three bits, and four scores of two bits.
    reg [2:0] turn = 3'd0;
    wire edge_vote = scores[5:3] >= own_minima[5:3];
    wire variance_vote = scores[8:6] >= own_minima[8:6];
    wire range_vote = scores[10:9] >= own_minima[10:9];
    wire surface_vote = scores[12:11] >= own_minima[12:11];
    wire mad_vote = scores[14:13] >= own_minima[14:13];
    wire segment_vote = scores[16:15] >= own_minima[16:15];
    wire [5:0] votes = {segment_vote, mad_vote, surface_vote, range_vote, variance_vote, edge_vote};
    wire voted = ALL ? votes == 6'd63 : votes != 6'd0;
    wire relevant = ZONES && region_class == 3 || (voted && !(ZONES && region_class == 1));
    reg [REGIONS-1:0] referenced = 0;
    wire [2:0] changed = !LAST_SENT || referenced[turn] ? scores[2:0] : PIXELS;
    wire changes_enough = changed >= own_minima[2:0];
    reg [(1+DEEP)*WIDTH-1:0] expected = 0;
    reg [DEEP:0] due = 0;
    wire sends = SUMMARIES && !relevant && (!shown || differs);
    wire shows = SUMMARIES && !(relevant && changes_enough) && (shown || sends);
    reg [DEEP:0] shows_due = 0;
    always @(posedge clk_i) begin
        if (judged) begin
            turn <= turn == REGIONS - 1 ? 3'd0 : turn + 3'd1;
            if (relevant && changes_enough) referenced[turn] <= 1'b1;
            else if (BLANKS && !relevant) referenced[turn] <= 1'b0;
        end
        shows_due <= {shows_due, shows};
        expected <= {expected, {sends, relevant, changes_enough, relevant && changes_enough, turn, scores[16:3], changed}};
        due <= {due, judged};
        if (rst_i) begin
            turn <= 3'd0;
            referenced <= 0;
            due <= 0;
        end
    end
    reg was_reset = 1'b1;
    always @(posedge clk_i) was_reset <= rst_i;
    always @* begin
        assume(!lost);
        if (was_reset) assume(!judged);
    end
    always @* if (started) begin
        assert(decision_valid == due[DEEP]);
        if (decision_valid)
            assert({summary, srs, trs, active, region, segment, mad, surface, range, variance, edges, changes} == expected[DEEP*WIDTH+:WIDTH]);
        if (decision_valid) assert(last_region == (region == REGIONS - 1));
        else assert(!srs && !trs && !active && !summary);
        // One clock before: whether the screen shows a summary from then on.
        if (SUMMARIES && decided) assert(will_be_shown == (DEEP ? shows_due[0] : shows));
    end
endmodule
