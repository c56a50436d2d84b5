// SPDX-License-Identifier: MIT OR Apache-2.0
// Control of a 3x3 window over an isolated region: it takes SIDE x SIDE pixels and gives as many centers.
//
// The newest pixel is the lower right neighbor of the center, so a center steps SIDE + 1 advances after its pixel. The window
// advances with every pixel and, between frames, by itself until the last center is out. A new frame ends such a flush, and
// its pixels push the remaining centers out.
//
// The middle of the incoming column is at `middle_q`, one pixel ahead of the center. The borders of that column (top, bottom)
// and of its neighbors (left, right) follow from `middle_q` alone.
`default_nettype none

module window_isolated #(
    parameter SIDE = 8,         // pixels of a row of the region, at least 2
    parameter ADDRESS_BITS = 6  // ceil(log2(SIDE * SIDE))
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    rst_i,      // synchronous reset, active high
    input  wire                    valid_i,    // a pixel comes in
    output wire                    advance_o,  // the line memories and the columns move at this edge
    output wire                    step_o,     // with advance_o: a center is complete
    output wire [ADDRESS_BITS-1:0] address_o,  // number of the next center of the region; 0 with the last center
    output wire                    last_o,     // the center is the last of the frame
    output wire                    top_o,      // the middle of the incoming column is in the first row
    output wire                    bottom_o,   // the middle of the incoming column is in the last row
    output wire                    left_o,     // the incoming column is the first of its row
    output wire                    right_o     // the center is the last of its row
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SIDE < 2) begin : g_side SIDE_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(SIDE * SIDE)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_the_pixels u_refused ();
        end
    endgenerate

    localparam PIXELS = SIDE * SIDE;
    localparam [ADDRESS_BITS-1:0] LAST = PIXELS - 1;
    localparam [ADDRESS_BITS-1:0] LEAD = SIDE;
    localparam [ADDRESS_BITS-1:0] LAST_ROW = PIXELS - SIDE;

    reg  [ADDRESS_BITS-1:0] taken_q;   // number of pixels taken of the current frame
    // The initial value keeps synthesis from moving this register into the address port of the store, which would give the
    // store a second port.
    reg [ADDRESS_BITS-1:0] middle_q = {ADDRESS_BITS{1'b0}};  // position of the middle of the incoming column
    reg                  center_q;  // the window has a center, one pixel behind the middle

    wire middle_first = middle_q == {ADDRESS_BITS{1'b0}};
    wire between = taken_q == {ADDRESS_BITS{1'b0}};
    wire flush = between && (!middle_first || center_q);
    wire middle_moves = !middle_first || taken_q == LEAD;

    assign advance_o = valid_i || flush;
    assign step_o = advance_o && center_q;

    always @(posedge clk_i) begin
        if (rst_i) begin
            taken_q  <= {ADDRESS_BITS{1'b0}};
            middle_q <= {ADDRESS_BITS{1'b0}};
            center_q <= 1'b0;
        end else begin
            if (valid_i) taken_q <= taken_q == LAST ? {ADDRESS_BITS{1'b0}} : taken_q + 1'b1;
            if (advance_o) begin
                center_q <= middle_moves;
                if (middle_moves) middle_q <= middle_q == LAST ? {ADDRESS_BITS{1'b0}} : middle_q + 1'b1;
            end
        end
    end

    // The column of the middle: its low bits, or a counter if SIDE is not a power of two.
    wire row_start;
    generate
        if ((SIDE & (SIDE - 1)) == 0) begin : g_power_of_two
            assign row_start = middle_q[ADDRESS_BITS/2-1:0] == {(ADDRESS_BITS / 2) {1'b0}};
        end else begin : g_counted
            localparam [ADDRESS_BITS-1:0] LAST_COLUMN = SIDE - 1;
            reg [ADDRESS_BITS-1:0] column_q;
            always @(posedge clk_i) begin
                if (rst_i) column_q <= {ADDRESS_BITS{1'b0}};
                else if (advance_o && middle_moves)
                    column_q <= column_q == LAST_COLUMN ? {ADDRESS_BITS{1'b0}} : column_q + 1'b1;
            end
            assign row_start = column_q == {ADDRESS_BITS{1'b0}};
        end
    endgenerate

    assign address_o   = middle_q;
    assign last_o   = middle_first;
    assign top_o    = middle_q < LEAD;
    assign bottom_o = middle_q >= LAST_ROW;
    assign left_o   = row_start;
    assign right_o  = row_start;

endmodule

`default_nettype wire
