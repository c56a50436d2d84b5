// SPDX-License-Identifier: MIT OR Apache-2.0
// Decides one region after the other while their scores pass: first the temporal count, which leaves TRS as a flag, then
// each feature. The decision comes with the last score, in the same clock.
`default_nettype none

module serial_decision #(
    parameter CHAIN_BITS = 7,    // bits of the words that pass
    parameter SCORE_BITS = 7,    // bits of the widest score
    parameter PIXELS = 64,       // pixels of a region
    parameter FEATURES = 1,      // spatial features, 1 to 8
    parameter ALL = 0,           // 1: every feature must vote; 0: one vote is enough
    parameter SUMMARIES = 0,     // 1: irrelevant regions send the means of their blocks
    parameter FLAGS = 1,         // bits of the flags of a region: 1 for one feature without summaries, else 2
    parameter LAST_SENT = 0,     // 1: the reference is `last-sent`; 0: `previous`
    parameter BLANKS = 1,        // 1: a region with SRS = 0 loses its reference
    parameter REGIONS = 784,     // regions of the frame
    parameter SLOTS = 784,       // number of regions plus empty slots
    parameter REGION_BITS = 10,  // bits of the number of a slot of the array
    parameter INDEX_BITS = 1,    // bits of the number of a score
    parameter FLOW_INDEX = 0,    // number of the score of `flow`; 0: there is none
    parameter DISPLACEMENT_BITS = 1, // bits of a displacement (FLOW_INDEX)
    parameter ZONES = 0          // 1: regions have classes
) (
    input  wire                               clk_i,             // clock, rising edge
    input  wire                               rst_i,             // synchronous reset, active high
    input  wire                               frame_i,           // all scores of a frame have passed
    input  wire                               rotate_i,          // a score passes
    input  wire [             INDEX_BITS-1:0] index_i,           // number of that score; 0 is the temporal count
    input  wire [            REGION_BITS-1:0] region_i,          // number of the region of that score
    input  wire [             CHAIN_BITS-1:0] word_i,            // the score that passes
    input  wire [                  FLAGS-1:0] flags_i,           // the flags of its region
    input  wire [      DISPLACEMENT_BITS-1:0] displacement_i,    // the displacement of its region (FLOW_INDEX)
    input  wire [(FEATURES+1)*SCORE_BITS-1:0] minima_i,          // smallest value of each score that votes, by index
    input  wire [(FEATURES+1)*SCORE_BITS-1:0] keen_minima_i,     // minima_i of keen regions (ZONES)
    input  wire [                        1:0] class_i,           // class of region_i (ZONES)
    input  wire                               summary_i,         // with SUMMARIES: the region sends its means
    output wire [                  FLAGS-1:0] flags_o,           // flags that return to the ring
    output wire                               region_valid_o,    // the slot is not empty
    output wire                               score_valid_o,     // a score of a region passes
    output wire [             SCORE_BITS-1:0] score_o,           // that score; without a reference n for a temporal count, 0 for `flow`
    output wire [      DISPLACEMENT_BITS-1:0] displacement_o,    // with the score of `flow`: that displacement, 0 without a reference; else 0
    output wire                               decision_valid_o,  // the decision is made, with the last score
    output wire                               srs_o,             // SRS, the spatial relevance; 0 unless decision_valid_o
    output wire                               trs_o,             // TRS, the temporal relevance; 0 unless decision_valid_o
    output wire                               active_o           // SRS and TRS are both 1; 0 unless decision_valid_o
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (FEATURES < 1 || FEATURES > 8) begin : g_features FEATURES_must_be_1_to_8 u_refused (); end
        if (FLAGS != (FEATURES > 1 || SUMMARIES != 0 ? 2 : 1)) begin : g_flags
            FLAGS_must_be_1_for_one_feature_without_summaries_else_2 u_refused ();
        end
        if (SCORE_BITS > CHAIN_BITS) begin : g_score_bits
            SCORE_BITS_must_be_CHAIN_BITS_or_less u_refused ();
        end
        if (SCORE_BITS < $clog2(PIXELS + 1)) begin : g_score_bits_2
            SCORE_BITS_must_hold_PIXELS u_refused ();
        end
        if (FLOW_INDEX < 0 || FLOW_INDEX > FEATURES) begin : g_flow_index FLOW_INDEX_must_be_0_to_FEATURES u_refused (); end
        if (SLOTS < REGIONS) begin : g_slots SLOTS_must_be_REGIONS_or_more u_refused (); end
        if (REGION_BITS != (SLOTS > 1 ? $clog2(SLOTS) : 1)) begin : g_region_bits
            REGION_BITS_must_number_the_slots u_refused ();
        end
        if (INDEX_BITS != $clog2(FEATURES + 1)) begin : g_index_bits
            INDEX_BITS_must_number_the_scores u_refused ();
        end
    endgenerate

    /* verilator lint_off WIDTH */
    localparam [SCORE_BITS-1:0] EVERY = PIXELS;
    localparam [REGION_BITS:0] BEHIND = REGIONS;
    /* verilator lint_on WIDTH */

    reg first_q;  // no frame came before this one
    wire temporal = index_i == {INDEX_BITS{1'b0}};
    wire last = index_i == FEATURES[INDEX_BITS-1:0];
    wire reference;
    wire srs;
    wire relevant;  // SRS as the votes have it so far

    generate
        if (SLOTS > REGIONS) begin : g_empty
            assign region_valid_o = {1'b0, region_i} < BEHIND;
        end else begin : g_full
            assign region_valid_o = 1'b1;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (rst_i) first_q <= 1'b1;
        else if (frame_i) first_q <= 1'b0;
    end

    // `flow` needs a reference.
    wire unmatched;

    generate
        if (FLOW_INDEX != 0) begin : g_flow
            wire flow = index_i == FLOW_INDEX[INDEX_BITS-1:0];
            assign unmatched = flow && !reference;
            assign displacement_o = flow && reference ? displacement_i : {DISPLACEMENT_BITS{1'b0}};
        end else begin : g_no_flow
            wire unused_displacement = |displacement_i;
            assign unmatched = 1'b0;
            assign displacement_o = {DISPLACEMENT_BITS{1'b0}};
        end
    endgenerate

    // Scores and votes.
    wire [(FEATURES+1)*SCORE_BITS-1:0] minima;
    wire [SCORE_BITS-1:0] minimum = minima[index_i*SCORE_BITS+:SCORE_BITS];
    wire vote = score_o >= minimum;

    assign score_valid_o = rotate_i && region_valid_o;
    assign score_o = temporal && !reference ? EVERY : unmatched ? {SCORE_BITS{1'b0}} : word_i[SCORE_BITS-1:0];

    // The flags. The first is TRS, and after the last score whether the region is active. The second is SRS so far, and after
    // the last score whether the region's summary is sent.
    wire active = flags_i[0] && srs && region_valid_o;
    assign flags_o[0] = !rotate_i ? flags_i[0] : temporal ? vote : last ? active : flags_i[0];
    assign decision_valid_o = score_valid_o && last;
    assign srs_o = decision_valid_o && srs;
    assign trs_o = decision_valid_o && flags_i[0];
    assign active_o = decision_valid_o && active;

    generate
        if (ZONES) begin : g_zones
            localparam [1:0] OFF = 2'd1;
            localparam [1:0] KEEN = 2'd2;
            localparam [1:0] ALWAYS = 2'd3;
            assign minima = class_i == KEEN ? keen_minima_i : minima_i;
            assign srs = class_i == ALWAYS || (relevant && class_i != OFF);
        end else begin : g_no_zones
            wire unused_zones = |keen_minima_i || |class_i;
            assign minima = minima_i;
            assign srs = relevant;
        end
        if (FEATURES > 1) begin : g_votes
            assign relevant = ALL != 0 ? flags_i[1] && vote : flags_i[1] || vote;
        end else begin : g_vote
            assign relevant = vote;
        end
        if (SUMMARIES != 0) begin : g_sent
            assign flags_o[FLAGS-1] = !rotate_i ? flags_i[FLAGS-1] : temporal ? ALL != 0 : last ? summary_i : srs;
        end else begin : g_not_sent
            wire unused_summary = summary_i;
            if (FLAGS > 1) begin : g_srs
                assign flags_o[1] = temporal ? ALL != 0 : srs;
            end
        end
        if (LAST_SENT != 0) begin : g_last_sent
            // One bit per region: it has a valid reference.
            wire referenced;
            frame_store #(
                .WIDTH(1), .PIXELS(SLOTS > 1 ? SLOTS : 2), .ADDRESS_BITS(REGION_BITS)
            ) u_valid (
                .clk_i(clk_i), .write_i(rotate_i && last), .address_i(region_i),
                .data_i(active || (reference && (srs || BLANKS == 0))), .data_o(referenced)
            );
            assign reference = referenced && !first_q;
        end else begin : g_previous
            assign reference = !first_q;
        end
        if (SLOTS == REGIONS && LAST_SENT == 0) begin : g_no_region
            wire unused_region = |region_i;
        end
        if (CHAIN_BITS > SCORE_BITS) begin : g_wider
            wire unused_word = |word_i[CHAIN_BITS-1:SCORE_BITS];
        end
    endgenerate

endmodule

`default_nettype wire
