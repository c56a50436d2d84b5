// SPDX-License-Identifier: MIT OR Apache-2.0
// The frame store is outside: one stream of references, one of words to store. Neither waits.
`default_nettype none

module raster_external #(
    parameter WORD_BITS = 8,  // bits of a word
    parameter DEEP = 0        // 0: a reference one clock after it is asked for; 1: two
) (
    input  wire                 clk_i,              // clock, rising edge
    input  wire                 rst_i,              // synchronous reset, active high
    input  wire                 first_frame_i,      // there are no references yet
    input  wire                 read_i,             // the next reference is asked for
    output wire [WORD_BITS-1:0] reference_o,        // that reference
    input  wire                 write_i,            // a word becomes a reference
    input  wire [WORD_BITS-1:0] word_i,             // that word
    input  wire                 row_end_i,          // the word is the last of a row
    output wire                 reference_ready_o,  // the reference on the port is taken at the next edge
    input  wire                 reference_valid_i,  // a reference is on the port
    input  wire [WORD_BITS-1:0] reference_pixel_i,  // that reference
    output reg                  store_valid_o,      // a word is to be stored
    output reg  [WORD_BITS-1:0] store_pixel_o,      // that word
    output reg                  store_last_o,       // the word is the last of a row
    output reg                  underrun_o          // a reference was not there, since reset
);

    assign reference_ready_o = read_i && !first_frame_i;

    // The word on the port is taken at every edge; only that of the right one is used.
    word_delay #(.WIDTH(WORD_BITS), .DEPTH(1 + DEEP)) u_reference (
        .clk_i(clk_i), .data_i(reference_pixel_i), .data_o(reference_o)
    );

    always @(posedge clk_i) begin
        store_valid_o <= write_i && !rst_i;
        store_pixel_o <= word_i;
        store_last_o  <= row_end_i;
        if (rst_i) underrun_o <= 1'b0;
        else if (reference_ready_o && !reference_valid_i) underrun_o <= 1'b1;
    end

endmodule

`default_nettype wire
