// SPDX-License-Identifier: MIT OR Apache-2.0
// Connects a frame store outside of the core: one stream of references, one of words to store. Neither stream waits. A
// reference is on reference_o one clock after its request, with DEEP two.
`default_nettype none

module raster_external #(
    parameter WORD_BITS = 8,  // bits of a word
    parameter DEEP = 0        // 0: a reference comes one clock after its request; 1: two clocks
) (
    input  wire                 clk_i,              // clock, rising edge
    input  wire                 rst_i,              // synchronous reset, active high
    input  wire                 first_frame_i,      // this is the first frame, which has no references
    input  wire                 read_i,             // the next reference is requested
    output wire [WORD_BITS-1:0] reference_o,        // the reference asked for
    input  wire                 write_i,            // a word is to be stored as a reference
    input  wire [WORD_BITS-1:0] word_i,             // the word that is to be stored
    input  wire                 row_end_i,          // that word is the last of a row
    output wire                 reference_ready_o,  // the reference on the port is taken at the next edge
    input  wire                 reference_valid_i,  // a reference is on the port
    input  wire [WORD_BITS-1:0] reference_pixel_i,  // the reference on the port
    output reg                  store_valid_o,      // a word is to be stored
    output reg  [WORD_BITS-1:0] store_pixel_o,      // the word to be stored
    output reg                  store_last_o,       // the word to be stored is the last of a row
    output reg                  underrun_o          // a reference was missing at least once since reset
);

    assign reference_ready_o = read_i && !first_frame_i;

    // The word on the port is registered at every edge, and used only if it was requested.
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
