// SPDX-License-Identifier: MIT OR Apache-2.0
// Control of a 3x3 window over a region that comes with its halo: SIDE x SIDE pixels in, the
// (SIDE-2) x (SIDE-2) centers that have all their neighbors out. Nothing to flush.
//
// `border_i` names the sides where the halo lies outside the frame. There the window must see the
// region's own border pixels repeated; elsewhere nothing is clamped.
`default_nettype none

module window_shared #(
    parameter SIDE = 10,        // pixels of a row of the stream, at least 4
    parameter SIDE_BITS = 4,    // ceil(log2(SIDE))
    parameter ADDRESS_BITS = 6  // ceil(log2((SIDE-2) * (SIDE-2)))
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    valid_i,    // a pixel comes in
    input  wire [             3:0] border_i,   // sides outside the frame: {bottom, top, right, left}
    output wire                    advance_o,  // lines and columns move at this edge
    output wire                    step_o,     // with it a center is complete
    output wire [ADDRESS_BITS-1:0] address_o,  // number of the center in its region
    output wire                    last_o,     // the center is the last of the frame
    output wire                    top_o,      // the incoming column lacks its upper pixel
    output wire                    bottom_o,   // ... its lower pixel
    output wire                    left_o,     // the incoming column stands for its left neighbor too
    output wire                    right_o     // the center's column stands for its right neighbor too
);

    // Limits: out of them elaboration stops at a module that does not exist.
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

    reg [SIDE_BITS-1:0] column_q;  // of the incoming pixel
    reg [SIDE_BITS-1:0] row_q;
    // The initial value keeps synthesis from moving this register into the store's address port,
    // which would cost the store a second port.
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
