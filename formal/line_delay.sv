// SPDX-License-Identifier: MIT OR Apache-2.0
// A word comes out DEPTH advances after it went in, and a column shows the pixels of three rows. An arbitrary word is followed
// on its way.
module properties #(parameter SIDE = 8) (
    input wire clk_i, rst_i, advance, top, bottom, follow, input wire pixel
);
    `include "reset.vh"
    wire delayed, upper, middle, lower, center;
    line_delay #(.WIDTH(1), .DEPTH(SIDE)) u_delay (
        .clk_i(clk_i), .advance_i(advance), .data_i(pixel), .data_o(delayed)
    );
    window_column #(.WIDTH(1), .SIDE(SIDE)) u_column (
        .clk_i(clk_i), .advance_i(advance), .top_i(top), .bottom_i(bottom), .pixel_i(pixel),
        .upper_o(upper), .middle_o(middle), .lower_o(lower), .center_o(center)
    );
    reg [7:0] age = 8'd0;  // advances since the followed word went in, its own included; 0 before that
    reg word;
    always @(posedge clk_i) begin
        if (advance && age == 8'd0 && follow) begin
            age  <= 8'd1;
            word <= pixel;
        end else if (advance && age != 8'd0 && age != 8'd255) age <= age + 8'd1;
    end
    always @* begin
        if (age == SIDE) begin
            assert(delayed == word);
            assert(middle == word);
            if (top) assert(upper == word);
            if (bottom) assert(lower == word);
        end
        if (age == SIDE + 1) assert(center == word);
        if (age == 2 * SIDE && !top) assert(upper == word);
        if (!bottom) assert(lower == pixel);
    end
endmodule
