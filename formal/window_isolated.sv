// SPDX-License-Identifier: MIT OR Apache-2.0
// The window of docs/timing.md, described with pixels taken and centers owed: when it advances, which center steps, and which
// borders apply. `taken` is the number of pixels of the frame that enters; `owed` is the number of centers of the frame before
// that have not stepped.
module properties #(parameter SIDE = 8, parameter ADDRESS_BITS = $clog2(SIDE * SIDE)) (
    input wire clk_i, rst_i, valid
);
    `include "reset.vh"
    localparam PIXELS = SIDE * SIDE;
    wire advance, step, last, top, bottom, left, right;
    wire [ADDRESS_BITS-1:0] address;
    window_isolated #(.SIDE(SIDE), .ADDRESS_BITS(ADDRESS_BITS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .advance_o(advance), .step_o(step), .address_o(address),
        .last_o(last), .top_o(top), .bottom_o(bottom), .left_o(left), .right_o(right)
    );
    reg [ADDRESS_BITS:0] taken, owed;
    wire flushes = taken == 0 && owed != 0;
    wire gives_old = (valid || flushes) && owed != 0;
    wire gives_new = valid && taken >= SIDE + 1;
    wire [ADDRESS_BITS:0] center = gives_old ? PIXELS - owed : taken - (SIDE + 1);
    always @(posedge clk_i) begin
        if (rst_i) begin
            taken <= 0;
            owed  <= 0;
        end else begin
            if (valid) taken <= taken == PIXELS - 1 ? 0 : taken + 1;
            if (valid && taken == PIXELS - 1) owed <= SIDE + 1;
            else if (gives_old) owed <= owed - 1;
        end
    end
    // The incoming column is that of pixel `middle`, which is the right neighbor of the center.
    wire [ADDRESS_BITS:0] middle = center + 1;
    always @* if (started) begin
        assert(taken < PIXELS);
        assert(owed <= SIDE + 1);
        assert(owed == 0 || owed + taken <= SIDE + 1);
        assert(advance == (valid || flushes));
        assert(step == (gives_old || gives_new));
        if (step) begin
            assert(center < PIXELS);
            assert(last == (center == PIXELS - 1));
            assert(address == (last ? 0 : middle));  // each number once, none outside of the region
            assert(right == (center % SIDE == SIDE - 1));
            if (!last) begin
                assert(left == (middle % SIDE == 0));
                assert(top == (middle < SIDE));
                assert(bottom == (middle >= PIXELS - SIDE));
            end
        end
        // The column of the first pixel comes with pixel SIDE.
        if (advance && !step && taken == SIDE) assert(left && top && !bottom);
        // The column of a frame that enters while the last center of the frame before leaves comes then, too.
        if (step && last && taken == SIDE) assert(left && top && !bottom);
        assert(address < PIXELS);
    end
endmodule
