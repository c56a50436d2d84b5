// SPDX-License-Identifier: MIT OR Apache-2.0
// Looks up the sides of a slot's region that are on the frame's border, in a table made from the regions'
// numbers. Combinational.
`default_nettype none

module serial_sides #(
    parameter FIRST = 0,     // number of the region in slot 0
    parameter COLUMNS = 28,  // regions in a row of regions
    parameter ROWS = 28,     // rows of regions
    parameter SLOT_BITS = 1  // bits of the number of a slot, at least 1
) (
    input  wire [SLOT_BITS-1:0] slot_i,  // number of the slot
    output wire [          3:0] sides_o  // one bit per side on the border: {bottom, top, right, left}
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (SLOT_BITS < 1) begin : g_slot_bits SLOT_BITS_must_be_1_or_more u_refused (); end
    endgenerate

    wire [4*(1<<SLOT_BITS)-1:0] table_of_sides;

    genvar i;
    generate
        for (i = 0; i < (1 << SLOT_BITS); i = i + 1) begin : g_slot
            localparam REGION = FIRST + i;
            assign table_of_sides[4*i+:4] = {
                REGION / COLUMNS == ROWS - 1, REGION / COLUMNS == 0,
                REGION % COLUMNS == COLUMNS - 1, REGION % COLUMNS == 0
            };
        end
    endgenerate

    assign sides_o = table_of_sides[4*slot_i+:4];

endmodule

`default_nettype wire
