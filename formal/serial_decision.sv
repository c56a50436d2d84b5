// SPDX-License-Identifier: MIT OR Apache-2.0
// An arbitrary region is followed through its rotations: its temporal count, then its features in order. The flags that move with
// the ring return as they left. The decision must be that of Table I for its scores.
module properties #(parameter FEATURES = 1, parameter ALL = 0, parameter LAST_SENT = 0, parameter BLANKS = 1, parameter SUMMARIES = 0, parameter FLOW_INDEX = 0, parameter ZONES = 0) (
    input wire clk_i, rst_i, frame, rotate, summary,
    input wire [1:0] index, input wire [2:0] region,
    input wire [2:0] word, input wire [1:0] some_flags, input wire [3*(FEATURES+1)-1:0] minima,
    input wire [1:0] moved, any_class, input wire [3*(FEATURES+1)-1:0] keen_minima
);
    `include "reset.vh"
    localparam FLAGS = FEATURES > 1 || SUMMARIES ? 2 : 1;
    localparam INDEX_BITS = FEATURES > 1 ? 2 : 1;
    localparam PIXELS = 4;
    localparam REGIONS = 5, SLOTS = 6;
    (* anyconst *) wire [2:0] watched;
    always @* begin
        assume(watched < REGIONS);
        assume(region < SLOTS);
        assume(index <= FEATURES);
        assume(word <= PIXELS);  // proven of the count of a lane
    end
    wire here = rotate && region == watched;
    reg [1:0] expected;  // the next rotation of the region
    reg [FLAGS-1:0] kept;
    wire [FLAGS-1:0] flags;
    wire region_valid, score_valid, decision_valid, srs, trs, active;
    wire [2:0] score;
    wire [1:0] displacement;
    serial_decision #(
        .CHAIN_BITS(3), .SCORE_BITS(3), .PIXELS(PIXELS), .FEATURES(FEATURES), .ALL(ALL), .SUMMARIES(SUMMARIES),
        .FLAGS(FLAGS), .LAST_SENT(LAST_SENT), .BLANKS(BLANKS), .REGIONS(REGIONS), .SLOTS(SLOTS), .REGION_BITS(3),
        .INDEX_BITS(INDEX_BITS), .FLOW_INDEX(FLOW_INDEX), .DISPLACEMENT_BITS(2), .ZONES(ZONES)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .frame_i(frame), .rotate_i(rotate), .index_i(index[INDEX_BITS-1:0]),
        .region_i(region), .word_i(word), .flags_i(here ? kept : some_flags[FLAGS-1:0]),
        .minima_i(minima), .keen_minima_i(keen_minima), .class_i(here ? region_class : any_class), .summary_i(summary), .flags_o(flags), .region_valid_o(region_valid), .score_valid_o(score_valid),
        .displacement_i(moved), .displacement_o(displacement), .score_o(score), .decision_valid_o(decision_valid), .srs_o(srs), .trs_o(trs), .active_o(active)
    );
    // The sequencer: each rotation once, in order; the frame is done after the last.
    reg decided;
    always @* begin
        if (here) assume(index == expected && !decided);
        if (frame) assume(decided && !rotate);
    end
    // The values by the contract.
    reg referenced, voted_trs, voted_any, voted_all;
    wire flow = FLOW_INDEX != 0 && index == FLOW_INDEX;
    wire [2:0] final_score = index == 0 && !referenced ? PIXELS : flow && !referenced ? 0 : word;
    (* anyconst *) wire [1:0] region_class;  // of the watched region
    wire [3*(FEATURES+1)-1:0] own_minima = ZONES != 0 && region_class == 2 ? keen_minima : minima;
    wire votes = final_score >= own_minima[3*index+:3];
    wire any = (index > 1 && voted_any) || votes, every = (index <= 1 || voted_all) && votes;
    wire voted = ALL != 0 ? every : any;
    wire relevant = ZONES != 0 && region_class == 3 || (voted && !(ZONES != 0 && region_class == 1));
    always @(posedge clk_i) begin
        if (rst_i) begin
            expected   <= 0;
            decided    <= 0;
            referenced <= 0;
        end else begin
            if (frame) decided <= 0;
            if (here) begin
                expected <= index == FEATURES ? 0 : index + 1;
                kept <= flags;
                if (index == 0) voted_trs <= votes;
                voted_any <= any;
                voted_all <= every;
                if (index == FEATURES) begin
                    decided <= 1;
                    if (LAST_SENT == 0 || (relevant && voted_trs)) referenced <= 1;
                    else if (!relevant && BLANKS != 0) referenced <= 0;
                end
            end
        end
    end
    always @* if (started) begin
        assert(score_valid == (rotate && region < REGIONS));
        if (!decision_valid) assert(!srs && !trs && !active);
        if (region >= REGIONS && rotate && index == FEATURES) assert(!flags[0]);  // an empty slot is never active
        if (SUMMARIES != 0 && !rotate) assert(flags == some_flags);  // flags between lanes stay as they are
        if (here) begin
            assert(score == final_score);
            assert(displacement == (flow && referenced ? moved : 0));
            assert(decision_valid == (index == FEATURES));
            if (decision_valid) begin
                assert(srs == relevant);
                assert(trs == voted_trs);
                assert(active == (relevant && voted_trs));
                assert(flags[0] == active);
                if (SUMMARIES != 0) assert(flags[FLAGS-1] == summary);
            end
        end
    end
endmodule
