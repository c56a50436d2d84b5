// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes what an irrelevant region sends in place of its pixels: the means of its blocks, if the screen shows no summary or
// if a mean differs from the shown one by more than level_i. summary_o comes with the decision. The means leave while the
// next frame comes in (with SECOND, the next but one), each when its block is complete.
//
// Two chains of means move when a block is complete, so that the oldest mean of each chain is of that block. One chain has
// the means of the frame decided last, the other those that the screen shows, or was to show. The second takes in the
// oldest mean of the first if it was sent, else its own. So the two means that enter the chains are of the same block and
// are compared with each other.
`default_nettype none

module region_summary #(
    parameter WIDTH = 8,                     // bits of a pixel
    parameter SIDE = 8,                      // pixels of a region's side
    parameter BLOCKS = 2,                    // blocks of a region's side
    parameter ADDRESS_BITS = 6,              // ceil(log2(SIDE * SIDE))
    parameter AHEAD = 0,                     // 1: address_i is the number of the next pixel; 0: that of this one
    parameter SUM_BITS = 12,                 // bits of the sum of a block plus half of its pixels
    parameter FACTOR_BITS = 1,               // bits of FACTOR
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // (sum * FACTOR) >> SHIFT is the sum divided by the pixels of a block
    parameter SHIFT = 4,                     // bits of the product that are dropped
    parameter SECOND = 0,                    // 1: a frame is decided when the next frame is complete
    parameter DEEP = 0                       // 1: more registers; a mean leaves one clock after the last pixel of its block
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    step_i,     // a pixel comes (DEEP: one clock before it is counted)
    input  wire [ADDRESS_BITS-1:0] address_i,  // number of the pixel in the region, or with AHEAD of the next pixel
    input  wire [       WIDTH-1:0] pixel_i,    // the pixel of this step
    input  wire                    done_i,     // the counts are those of a whole frame
    input  wire                    decided_i,  // a decision is made in this clock
    input  wire                    srs_i,      // SRS of that decision
    input  wire                    active_i,   // SRS and TRS of that decision are both 1
    input  wire [       WIDTH-1:0] level_i,    // a mean that differs by more than this level is sent again
    output wire                    summary_o,  // the summary of the decided frame is sent; 0 unless decided_i
    output wire                    leaves_o,   // a mean leaves at this edge
    output wire [       WIDTH-1:0] mean_o      // the mean that leaves
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SECOND != 0 && SECOND != 1) begin : g_second SECOND_must_be_0_or_1 u_refused (); end
        if (DEEP != 0 && DEEP != 1) begin : g_deep DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam MEANS = BLOCKS * BLOCKS;

    wire complete;
    wire [WIDTH-1:0] mean;
    block_mean #(
        .WIDTH(WIDTH), .SIDE(SIDE), .BLOCKS(BLOCKS), .ADDRESS_BITS(ADDRESS_BITS), .AHEAD(AHEAD),
        .SUM_BITS(SUM_BITS), .FACTOR_BITS(FACTOR_BITS), .FACTOR(FACTOR), .SHIFT(SHIFT), .DEEP(DEEP)
    ) u_mean (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .address_i(address_i), .pixel_i(pixel_i),
        .valid_o(complete), .mean_o(mean)
    );

    // The mean of the frame that is decided next.
    wire [WIDTH-1:0] entering;
    generate
        if (SECOND) begin : g_second_pass
            line_delay #(.WIDTH(WIDTH), .DEPTH(MEANS)) u_waiting (
                .clk_i(clk_i), .advance_i(complete), .data_i(mean), .data_o(entering)
            );
        end else begin : g_one_pass
            assign entering = mean;
        end
    endgenerate

    // If a block is one pixel, the first block of the next frame may be complete in the clock of the decision.
    reg sent_q;
    wire sent = SIDE == BLOCKS && decided_i ? summary_o : sent_q;

    wire [WIDTH-1:0] held;
    wire [WIDTH-1:0] shown = sent ? mean_o : held;
    line_delay #(.WIDTH(WIDTH), .DEPTH(MEANS)) u_now (
        .clk_i(clk_i), .advance_i(complete), .data_i(entering), .data_o(mean_o)
    );
    line_delay #(.WIDTH(WIDTH), .DEPTH(MEANS)) u_held (
        .clk_i(clk_i), .advance_i(complete), .data_i(shown), .data_o(held)
    );

    assign leaves_o = complete && sent;

    // A mean of the decided frame differs from what the screen shows. The level is that of the clock of the decision. So the
    // largest of several differences is kept, and not whether one was above a level.
    wire differs;
    generate
        if (MEANS == 1) begin : g_one
            wire [WIDTH:0] difference;
            magnitude_above #(.WIDTH(WIDTH + 1)) u_above (
                .value_i(difference), .level_i(level_i), .above_o(differs)
            );
            if (DEEP) begin : g_late
                reg [WIDTH:0] difference_q;
                always @(posedge clk_i) if (complete) difference_q <= {1'b0, entering} - {1'b0, shown};
                assign difference = difference_q;
            end else begin : g_plain
                assign difference = {1'b0, mean_o} - {1'b0, held};
            end
            wire unused_done = done_i;
        end else begin : g_some
            wire [WIDTH:0] difference;
            wire found, above, last_above;
            // `width` orders differences as the absolute value does: |difference|, less 1 if it is negative, then whether it is negative.
            wire negative = difference[WIDTH];
            wire [WIDTH:0] width = {difference[WIDTH-1:0] ^ {WIDTH{negative}}, negative};
            reg [WIDTH:0] widest_q;
            magnitude_above #(.WIDTH(WIDTH + 1)) u_above (
                .value_i({widest_q[0], widest_q[WIDTH:1] ^ {WIDTH{widest_q[0]}}}), .level_i(level_i), .above_o(above)
            );
            assign differs = above || last_above;
            if (DEEP) begin : g_late
                // In the clock of the decision the last difference has not yet reached widest_q.
                reg [WIDTH:0] difference_q;
                reg found_q;
                always @(posedge clk_i) begin
                    found_q <= complete;
                    if (complete) difference_q <= {1'b0, entering} - {1'b0, shown};
                end
                assign difference = difference_q;
                assign found = found_q && !done_i;
                magnitude_above #(.WIDTH(WIDTH + 1)) u_last (
                    .value_i(difference), .level_i(level_i), .above_o(last_above)
                );
            end else begin : g_plain
                assign difference = {1'b0, entering} - {1'b0, shown};
                assign found = complete;
                assign last_above = 1'b0;
            end
            always @(posedge clk_i) begin
                if (found && (done_i || width > widest_q)) widest_q <= width;
                else if (done_i) widest_q <= {(WIDTH + 1) {1'b0}};
            end
        end
    endgenerate

    reg shows_q;
    assign summary_o = decided_i && !srs_i && (!shows_q || differs);

    always @(posedge clk_i) begin
        if (rst_i) begin
            sent_q  <= 1'b0;
            shows_q <= 1'b0;
        end else begin
            if (decided_i) sent_q <= summary_o;
            if (active_i) shows_q <= 1'b0;
            else if (summary_o) shows_q <= 1'b1;
        end
    end

endmodule

`default_nettype wire
