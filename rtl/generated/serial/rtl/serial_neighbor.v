// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes lane and slot of a region or of one of its eight neighbors. Combinational. A region has the number
// lane * FOLD + slot, so a neighbor is a constant number of lanes and slots away, and one lane more if the slots overflow.
`default_nettype none

module serial_neighbor #(
    parameter COLUMNS = 28,   // regions in a row of regions
    parameter FOLD = 1,       // regions of a lane
    parameter SLOT_BITS = 1,  // bits of the number of a slot, at least 1
    parameter LANE_BITS = 10  // bits of the number of a lane, at least 1
) (
    input  wire [LANE_BITS-1:0] lane_i,   // lane of the region
    input  wire [SLOT_BITS-1:0] slot_i,   // slot of the region
    input  wire                 left_i,   // 1: the neighbor is in the column of regions to the left
    input  wire                 right_i,  // 1: the neighbor is in the column of regions to the right
    input  wire                 above_i,  // 1: the neighbor is in the row of regions above
    input  wire                 below_i,  // 1: the neighbor is in the row of regions below
    output wire [LANE_BITS-1:0] lane_o,   // lane of the neighbor
    output wire [SLOT_BITS-1:0] slot_o    // slot of the neighbor
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (FOLD < 1) begin : g_fold FOLD_must_be_1_or_more u_refused (); end
        if (SLOT_BITS != (FOLD > 1 ? $clog2(FOLD) : 1)) begin : g_slot_bits
            SLOT_BITS_must_number_the_slots u_refused ();
        end
    endgenerate

    /* verilator lint_off UNUSEDSIGNAL */
    // Returns the whole lanes from a region to the one `regions` after it. The argument may be negative.
    function [LANE_BITS-1:0] lanes(input integer regions);
        integer whole;
        begin
            whole = (regions + (COLUMNS + 1) * FOLD) / FOLD - (COLUMNS + 1);
            lanes = whole[LANE_BITS-1:0];
        end
    endfunction

    function [SLOT_BITS:0] slots(input integer regions);
        integer rest;
        begin
            rest = (regions + (COLUMNS + 1) * FOLD) % FOLD;
            slots = rest[SLOT_BITS:0];
        end
    endfunction

    /* verilator lint_on UNUSEDSIGNAL */

    reg [LANE_BITS-1:0] far;
    reg [SLOT_BITS:0] on;
    always @* begin
        case ({above_i, below_i, left_i, right_i})
            4'b0001: begin far = lanes(1); on = slots(1); end
            4'b0010: begin far = lanes(-1); on = slots(-1); end
            4'b0100: begin far = lanes(COLUMNS); on = slots(COLUMNS); end
            4'b0101: begin far = lanes(COLUMNS + 1); on = slots(COLUMNS + 1); end
            4'b0110: begin far = lanes(COLUMNS - 1); on = slots(COLUMNS - 1); end
            4'b1000: begin far = lanes(-COLUMNS); on = slots(-COLUMNS); end
            4'b1001: begin far = lanes(1 - COLUMNS); on = slots(1 - COLUMNS); end
            4'b1010: begin far = lanes(-1 - COLUMNS); on = slots(-1 - COLUMNS); end
            default: begin far = lanes(0); on = slots(0); end
        endcase
    end

    /* verilator lint_off WIDTH */
    localparam [SLOT_BITS:0] SLOTS = FOLD;
    /* verilator lint_on WIDTH */
    wire [SLOT_BITS:0] plain = {1'b0, slot_i} + on;
    wire over = plain >= SLOTS;
    /* verilator lint_off UNUSEDSIGNAL */
    wire [SLOT_BITS:0] reduced = over ? plain - SLOTS : plain;  // below FOLD
    /* verilator lint_on UNUSEDSIGNAL */

    assign slot_o = reduced[SLOT_BITS-1:0];
    assign lane_o = lane_i + far + {{(LANE_BITS - 1) {1'b0}}, over};

endmodule

`default_nettype wire
