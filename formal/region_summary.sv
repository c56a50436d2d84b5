// SPDX-License-Identifier: MIT OR Apache-2.0
// Summaries by the contract, with the parameters of a generated design: when they are sent, which mean leaves at which place,
// and that the screen is right if no summary is sent.
module properties (
    input wire clk_i, rst_i, step, srs, trs,
    input wire [`P-1:0] pixel, level
);
    `include "reset.vh"
    localparam BLOCKS = `U_SUMMARY_BLOCKS;
    localparam MEANS = BLOCKS * BLOCKS;
    localparam SIDE = `N / BLOCKS;
    localparam AREA = SIDE * SIDE;
    localparam PIXELS = `N * `N;
    localparam ADDRESS_BITS = $clog2(PIXELS);
`ifdef U_SUMMARY_AHEAD
    localparam AHEAD = 1;
`else
    localparam AHEAD = 0;
`endif
`ifdef U_SUMMARY_SECOND
    localparam SECOND = 1;
`else
    localparam SECOND = 0;
`endif
`ifdef U_SUMMARY_DEEP
    localparam DEEP = 1;
`else
    localparam DEEP = 0;
`endif

    // The stream of pixels; with DEEP, one clock later, when they are counted.
    wire last, in_done;
    wire [15:0] in_place, in_seen;
    frames #(.PIXELS(PIXELS)) u_read (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(in_done), .place_o(in_place),
        .seen_o(in_seen)
    );
    wire counted;
    wire [`P-1:0] counted_pixel;
    generate
        if (DEEP) begin : g_later
            reg step_q;
            reg [`P-1:0] pixel_q;
            always @(posedge clk_i) begin
                step_q  <= step && !rst_i;
                pixel_q <= pixel;
            end
            assign counted = step_q;
            assign counted_pixel = pixel_q;
        end else begin : g_now
            assign counted = step;
            assign counted_pixel = pixel;
        end
    endgenerate
    wire counted_last, done;
    wire [15:0] place, seen;
    frames #(.PIXELS(PIXELS)) u_counted (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(counted), .last_o(counted_last), .done_o(done), .place_o(place),
        .seen_o(seen)
    );
    reg second;
    always @(posedge clk_i) second <= !rst_i && (second || done);
    wire decided = done && (!SECOND || second);

    wire [15:0] address = in_place + AHEAD == PIXELS ? 16'd0 : in_place + AHEAD;
    wire summary, leaves;
    wire [`P-1:0] mean;
    region_summary #(`U_SUMMARY) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .address_i(address[ADDRESS_BITS-1:0]), .pixel_i(pixel),
        .done_i(done), .decided_i(decided), .srs_i(decided && srs), .active_i(decided && srs && trs), .level_i(level),
        .summary_o(summary), .leaves_o(leaves), .mean_o(mean)
    );

    // The values by the contract: the sums of all blocks, and in the clock in which a frame is done, its means.
    wire [15:0] column = place % `N, row = place / `N;
    wire [15:0] block = row / SIDE * BLOCKS + column / SIDE;
    wire is_first = column % SIDE == 0 && row % SIDE == 0;
    wire is_last = column % SIDE == SIDE - 1 && row % SIDE == SIDE - 1;
    reg [`P*MEANS-1:0] shown, waiting;
    wire [`P*MEANS-1:0] means, decided_means;
    wire [MEANS-1:0] differs;
    genvar k;
    generate
        for (k = 0; k < MEANS; k = k + 1) begin : g_block
            reg [15:0] sum;
            always @(posedge clk_i) begin
                if (counted && block == k) sum <= (is_first ? 16'd0 : sum) + counted_pixel;
            end
            wire [15:0] quotient = (sum + AREA / 2) / AREA;
            assign means[`P*k+:`P] = quotient;
            wire [`P-1:0] now = decided_means[`P*k+:`P], old = shown[`P*k+:`P];
            assign differs[k] = (now > old ? now - old : old - now) > level;
        end
    endgenerate
    assign decided_means = SECOND ? waiting : means;
    reg shows, sent;
    wire due = decided && !srs && (!shows || |differs);
    wire sent_now = decided ? due : sent;
    wire [`P*MEANS-1:0] shown_now = due ? decided_means : shown;
    always @(posedge clk_i) begin
        shown <= shown_now;
        if (done) waiting <= means;
        sent  <= !rst_i && sent_now;
        shows <= !rst_i && (decided && srs && trs ? 1'b0 : shows || due);
    end
    wire [`P*MEANS-1:0] left = shown_now >> (`P * block);
    always @* if (started) begin
        assert(summary == due);
        assert(leaves == (counted && is_last && sent_now));
        if (leaves) assert(mean == left[`P-1:0]);
    end
endmodule
