// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes SRS from the votes of the features, and the decision from SRS and TRS (Table I of the paper). The decision is on
// srs_o, trs_o and active_o in the clock of valid_i; forward_o keeps active_o until the next decision.
`default_nettype none

module decision #(
    parameter FEATURES = 1,  // number of votes
    parameter ALL = 0        // 1: every feature must vote; 0: one vote is enough
) (
    input  wire                clk_i,     // clock, rising edge
    input  wire                rst_i,     // synchronous reset, active high
    input  wire                valid_i,   // the votes and trs_i are those of a whole frame
    input  wire [FEATURES-1:0] votes_i,   // votes of the features
    input  wire                trs_i,     // TRS, the temporal relevance
    output wire                srs_o,     // SRS, the spatial relevance; 0 unless valid_i
    output wire                trs_o,     // TRS, the temporal relevance; 0 unless valid_i
    output wire                active_o,  // SRS and TRS are both 1; 0 unless valid_i
    output wire                forward_o  // the last decision was active, the one of this clock included
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (FEATURES < 1 || FEATURES > 8) begin : g_features FEATURES_must_be_1_to_8 u_refused (); end
        if (ALL != 0 && ALL != 1) begin : g_all ALL_must_be_0_or_1 u_refused (); end
    endgenerate

    reg active_q;

    assign srs_o     = valid_i && (ALL ? &votes_i : |votes_i);
    assign trs_o     = valid_i && trs_i;
    assign active_o  = srs_o && trs_o;
    assign forward_o = valid_i ? active_o : active_q;

    always @(posedge clk_i) begin
        if (rst_i) active_q <= 1'b0;
        else active_q <= forward_o;
    end

endmodule

`default_nettype wire
