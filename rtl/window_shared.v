// SPDX-License-Identifier: MIT OR Apache-2.0
// Control of a 3x3 window over a region that comes with its halo: it takes SIDE x SIDE pixels and gives the
// (SIDE-2) x (SIDE-2) centers that have all their neighbors. A center steps with its lower right neighbor, so there is
// nothing to flush.
//
// `border_i` names the sides at which the halo is outside of the frame. There the window sees the region's own border pixels
// repeated; at other sides it sees the halo.
`default_nettype none

module window_shared #(
    parameter SIDE = 10,        // pixels of a row of the stream, at least 4
    parameter SIDE_BITS = 4,    // ceil(log2(SIDE))
    parameter ADDRESS_BITS = 6  // ceil(log2((SIDE-2) * (SIDE-2)))
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    valid_i,    // a pixel comes in
    input  wire [             3:0] border_i,   // sides of the region on the frame's border: {bottom, top, right, left}
    output wire                    advance_o,  // the line memories and the columns move at this edge
    output wire                    step_o,     // with advance_o: a center is complete
    output wire [ADDRESS_BITS-1:0] address_o,  // number of the center in its region
    output wire                    last_o,     // the center is the last of the frame
    output wire                    top_o,      // the incoming column uses its middle pixel in place of the upper one
    output wire                    bottom_o,   // the incoming column uses its middle pixel in place of the lower one
    output wire                    left_o,     // the incoming column is used in place of its left neighbor
    output wire                    right_o     // the center's column is used in place of its right neighbor
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SIDE < 4) begin : g_side SIDE_must_be_4_or_more u_refused (); end
        if (SIDE_BITS != $clog2(SIDE)) begin : g_side_bits
            SIDE_BITS_must_be_clog2_of_SIDE u_refused ();
        end
        if (ADDRESS_BITS != $clog2((SIDE - 2) * (SIDE - 2))) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_the_centers u_refused ();
        end
    endgenerate

    localparam LAST = SIDE - 1;
    localparam [SIDE_BITS-1:0] FIRST_CENTER = 1;

    reg [SIDE_BITS-1:0] column_q;  // column of the incoming pixel
    reg [SIDE_BITS-1:0] row_q;
    // The initial value keeps synthesis from moving this register into the address port of the store, which would give the
    // store a second port.
    reg [ADDRESS_BITS-1:0] address_q = {ADDRESS_BITS{1'b0}};

    wire last_column = column_q == LAST[SIDE_BITS-1:0];
    wire last_row = row_q == LAST[SIDE_BITS-1:0];

    assign advance_o = valid_i;
    assign step_o = valid_i && row_q > FIRST_CENTER && column_q > FIRST_CENTER;
    assign address_o = address_q;
    assign last_o = last_row && last_column;

    always @(posedge clk_i) begin
        if (rst_i) begin
            column_q  <= {SIDE_BITS{1'b0}};
            row_q     <= {SIDE_BITS{1'b0}};
            address_q <= {ADDRESS_BITS{1'b0}};
        end else if (valid_i) begin
            column_q <= last_column ? {SIDE_BITS{1'b0}} : column_q + 1'b1;
            if (last_column) row_q <= last_row ? {SIDE_BITS{1'b0}} : row_q + 1'b1;
            if (step_o) address_q <= last_o ? {ADDRESS_BITS{1'b0}} : address_q + 1'b1;
        end
    end

    assign left_o   = border_i[0] && column_q == FIRST_CENTER;
    assign right_o  = border_i[1] && last_column;
    assign top_o    = border_i[2] && row_q == FIRST_CENTER + 1'b1;
    assign bottom_o = border_i[3] && last_row;

endmodule

`default_nettype wire
