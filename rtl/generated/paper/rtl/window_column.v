// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the incoming column of a 3x3 window: the newest pixel and the pixels one and two rows above it. At a border the
// middle pixel is used in place of the upper or the lower one. The column is combinational from pixel_i.
`default_nettype none

module window_column #(
    parameter WIDTH = 8,  // bits of a pixel
    parameter SIDE = 8    // pixels of a row of the stream
) (
    input  wire             clk_i,      // clock, rising edge
    input  wire             advance_i,  // the window moves by one column at this edge
    input  wire             top_i,      // there is no row above the middle
    input  wire             bottom_i,   // there is no row below the middle
    input  wire [WIDTH-1:0] pixel_i,    // the newest pixel
    output wire [WIDTH-1:0] upper_o,    // upper pixel of the column
    output wire [WIDTH-1:0] middle_o,   // middle pixel of the column
    output wire [WIDTH-1:0] lower_o,    // lower pixel of the column
    output wire [WIDTH-1:0] center_o    // the middle pixel of the advance before, which is the center of the window
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SIDE < 2) begin : g_side SIDE_must_be_2_or_more u_refused (); end
    endgenerate

    wire [WIDTH-1:0] middle;
    wire [WIDTH-1:0] above;
    reg  [WIDTH-1:0] center_q;

    line_delay #(.WIDTH(WIDTH), .DEPTH(SIDE)) u_middle (
        .clk_i(clk_i), .advance_i(advance_i), .data_i(pixel_i), .data_o(middle)
    );

    line_delay #(.WIDTH(WIDTH), .DEPTH(SIDE)) u_above (
        .clk_i(clk_i), .advance_i(advance_i), .data_i(middle), .data_o(above)
    );

    always @(posedge clk_i) begin
        if (advance_i) center_q <= middle;
    end

    assign upper_o  = top_i ? middle : above;
    assign middle_o = middle;
    assign lower_o  = bottom_i ? middle : pixel_i;
    assign center_o = center_q;

endmodule

`default_nettype wire
