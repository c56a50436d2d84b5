// SPDX-License-Identifier: MIT OR Apache-2.0
// Decides for one region after the other, as their scores pass: the temporal count first, which
// leaves TRS as a flag, then each feature, and with the last one the decision.
`default_nettype none

module serial_decision #(
    parameter CHAIN_BITS = 7,   // of the words that pass
    parameter SCORE_BITS = 7,   // of the widest score
    parameter PIXELS = 64,      // of a region
    parameter FEATURES = 1,
    parameter ALL = 0,          // 1: every feature must vote; 0: one vote is enough
    parameter FLAGS = 1,        // 1 for one feature, else 2
    parameter LAST_SENT = 0,
    parameter BLANKS = 1,       // 1: with SRS = 0 nothing that was sent is left
    parameter REGIONS = 784,
    parameter SLOTS = 784,      // REGIONS, and empty slots
    parameter REGION_BITS = 10, // of the number of a slot
    parameter INDEX_BITS = 1    // of the number of a score
) (
    input  wire                               clk_i,
    input  wire                               rst_i,
    input  wire                               frame_i,    // a frame is done
    input  wire                               rotate_i,   // a score passes
    input  wire [             INDEX_BITS-1:0] index_i,    // which: 0 is the temporal count
    input  wire [            REGION_BITS-1:0] region_i,   // whose
    input  wire [             CHAIN_BITS-1:0] word_i,
    input  wire [                  FLAGS-1:0] flags_i,
    input  wire [(FEATURES+1)*SCORE_BITS-1:0] minima_i,   // by index
    output wire [                  FLAGS-1:0] flags_o,    // back into the ring
    output wire                               region_valid_o,
    output wire                               score_valid_o,
    output wire [             SCORE_BITS-1:0] score_o,
    output wire                               decision_valid_o,
    output wire                               srs_o,
    output wire                               trs_o,
    output wire                               active_o
);

    /* verilator lint_off WIDTH */
    localparam [SCORE_BITS-1:0] EVERY = PIXELS;
    localparam [REGION_BITS:0] BEHIND = REGIONS;
    /* verilator lint_on WIDTH */

    reg first_q;  // no frame before this one
    wire temporal = index_i == {INDEX_BITS{1'b0}};
    wire last = index_i == FEATURES[INDEX_BITS-1:0];
    wire reference;
    wire srs;

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

    // Scores and votes.
    wire [SCORE_BITS-1:0] minimum = minima_i[index_i*SCORE_BITS+:SCORE_BITS];
    wire vote = score_o >= minimum;

    assign score_valid_o = rotate_i && region_valid_o;
    assign score_o = temporal && !reference ? EVERY : word_i[SCORE_BITS-1:0];

    // Flags: TRS, at last whether the region is active; and SRS so far.
    wire active = flags_i[0] && srs && region_valid_o;
    assign flags_o[0] = !rotate_i ? flags_i[0] : temporal ? vote : last ? active : flags_i[0];
    assign decision_valid_o = score_valid_o && last;
    assign srs_o = decision_valid_o && srs;
    assign trs_o = decision_valid_o && flags_i[0];
    assign active_o = decision_valid_o && active;

    generate
        if (FLAGS > 1) begin : g_votes
            assign srs = ALL != 0 ? flags_i[1] && vote : flags_i[1] || vote;
            assign flags_o[1] = temporal ? ALL != 0 : srs;
        end else begin : g_vote
            assign srs = vote;
        end
        if (LAST_SENT != 0) begin : g_last_sent
            // One bit per region: it has a reference.
            wire kept;
            frame_store #(
                .WIDTH(1), .PIXELS(SLOTS > 1 ? SLOTS : 2), .SLOT_BITS(REGION_BITS)
            ) u_valid (
                .clk_i(clk_i), .write_i(rotate_i && last), .slot_i(region_i),
                .data_i(active || (reference && (srs || BLANKS == 0))), .data_o(kept)
            );
            assign reference = kept && !first_q;
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
