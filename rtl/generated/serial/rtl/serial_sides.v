// SPDX-License-Identifier: MIT OR Apache-2.0
// Which sides of the region in a slot are on the frame's border: a table, made from its numbers.
`default_nettype none

module serial_sides #(
    parameter FIRST = 0,        // region of slot 0
    parameter COLUMNS = 28,
    parameter ROWS = 28,
    parameter SLOT_BITS = 1     // at least 1
) (
    input  wire [SLOT_BITS-1:0] slot_i,
    output wire [          3:0] sides_o  // {bottom, top, right, left}
);

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
