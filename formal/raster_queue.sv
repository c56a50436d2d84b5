// SPDX-License-Identifier: MIT OR Apache-2.0
// The times at which a region can be held, by "Holding" in docs/raster.md. The order of events of all entries is followed, and an
// arbitrary entry is watched from the edge at which it enters to the edge at which it is taken.
module properties #(
    parameter DEEP = 0
) (
    input wire clk_i, rst_i, enter, pick, wish, input wire [1:0] some_entry
);
    `include "reset.vh"
    localparam BITS = 2;
    (* anyconst *) wire [1:0] entry;
    reg watched = 1'b0;          // the watched entry waits
    wire begins = enter && pick && !watched;
    wire valid, waits;
    wire [1:0] oldest;
    wire take = valid && wish;
    raster_queue #(.WIDTH(2), .BITS(BITS), .DEEP(DEEP)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .enter_i(enter), .entry_i(begins ? entry : some_entry), .take_i(take),
        .valid_o(valid), .oldest_o(oldest), .waits_o(waits)
    );

    reg [BITS:0] waiting = 0;    // number of entries in the queue
    reg [BITS:0] ahead;          // number of entries in front of the watched one
    reg [1:0] entered = 2'd0;    // one bit per edge before: an entry entered then
    reg recent = 1'b0;           // an entry was taken at the edge before
    wire [BITS:0] fresh = entered[0] + (DEEP ? entered[1] : 1'b0);
    always @(posedge clk_i) begin
        waiting <= waiting + enter - take;
        entered <= {entered[0], enter};
        recent <= take;
        if (begins) begin
            watched <= 1'b1;
            ahead <= waiting - take;
        end else if (watched && take) begin
            if (ahead == 0) watched <= 1'b0;
            ahead <= ahead - 1'b1;
        end
        if (rst_i) begin
            waiting <= 0;
            entered <= 2'd0;
            recent  <= 1'b0;
            watched <= 1'b0;
        end
    end

    always @* assume(!(enter && waiting == (1 << BITS) - 1));
    always @* if (started) begin
        assert(valid == (waiting > fresh && !recent));
        assert(waits == (waiting != 0));
        if (watched && valid && ahead == 0) assert(oldest == entry);
    end
endmodule
