// SPDX-License-Identifier: MIT OR Apache-2.0
// Table I of the paper from scores and minimums: vote, candidate_count and decision; then the value that forward keeps
// of it.
module decision_properties #(parameter FEATURES = 1, parameter ALL = 0) (
    input wire clk_i, rst_i, valid,
    input wire [6:0] minimum, trs_minimum, previous_count, sent_count,
    input wire [7*FEATURES-1:0] scores,
    input wire previous_sent, referenced
);
    `include "reset.vh"
    wire [FEATURES-1:0] votes;
    genvar i;
    generate
        for (i = 0; i < FEATURES; i = i + 1) begin : g_vote
            vote #(.WIDTH(7)) u (.score_i(scores[7*i+:7]), .minimum_i(minimum), .vote_o(votes[i]));
        end
    endgenerate
    wire [6:0] count;
    wire trs_vote, srs, trs, active, forward;
    candidate_count #(.WIDTH(7), .PIXELS(64)) u_count (
        .previous_sent_i(previous_sent), .valid_i(referenced), .previous_count_i(previous_count),
        .sent_count_i(sent_count), .count_o(count)
    );
    vote #(.WIDTH(7)) u_trs (.score_i(count), .minimum_i(trs_minimum), .vote_o(trs_vote));
    decision #(.FEATURES(FEATURES), .ALL(ALL)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .votes_i(votes), .trs_i(trs_vote),
        .srs_o(srs), .trs_o(trs), .active_o(active), .forward_o(forward)
    );

    // The values by the contract.
    reg any, every;
    integer k;
    always @* begin
        any = 1'b0;
        every = 1'b1;
        for (k = 0; k < FEATURES; k = k + 1) begin
            if (scores[7*k+:7] >= minimum) any = 1'b1;
            else every = 1'b0;
        end
    end
    wire relevant = ALL != 0 ? every : any;
    wire changed = (previous_sent ? previous_count : referenced ? sent_count : 7'd64) >= trs_minimum;
    always @* begin
        assert(srs == (valid && relevant));
        assert(trs == (valid && changed));
        case ({changed, relevant})
            2'b11: assert(active == valid);
            default: assert(!active);
        endcase
        // Without a valid reference all pixels count as changed, unless the minimum is out of reach.
        if (valid && !previous_sent && !referenced && trs_minimum <= 64) assert(trs);
    end
    reg last = 1'b0;  // the last decision since reset
    always @(posedge clk_i) last <= !rst_i && (valid ? relevant && changed : last);
    always @* if (started) assert(forward == (valid ? relevant && changed : last));
endmodule

module properties (
    input wire clk_i, rst_i, valid, previous_sent, referenced,
    input wire [6:0] minimum, trs_minimum, previous_count, sent_count,
    input wire [27:0] scores
);
    genvar i;
    generate
        for (i = 1; i <= 4; i = i + 1) begin : g_features
            decision_properties #(.FEATURES(i), .ALL(0)) u_any (
                .clk_i(clk_i), .rst_i(rst_i), .valid(valid), .minimum(minimum), .trs_minimum(trs_minimum),
                .previous_count(previous_count), .sent_count(sent_count), .scores(scores[7*i-1:0]),
                .previous_sent(previous_sent), .referenced(referenced)
            );
            decision_properties #(.FEATURES(i), .ALL(1)) u_all (
                .clk_i(clk_i), .rst_i(rst_i), .valid(valid), .minimum(minimum), .trs_minimum(trs_minimum),
                .previous_count(previous_count), .sent_count(sent_count), .scores(scores[7*i-1:0]),
                .previous_sent(previous_sent), .referenced(referenced)
            );
        end
    endgenerate
endmodule
