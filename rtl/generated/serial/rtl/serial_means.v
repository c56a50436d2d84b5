// SPDX-License-Identifier: MIT OR Apache-2.0
// Stores a mean for every block of every region of the serial array, with a port to write and a port to read. A mean is on
// data_o one clock after its address. Up to 64 words are distributed RAM, more are block RAM. A word that is written and
// read at one edge is not used.
`default_nettype none

module serial_means #(
    parameter WIDTH = 8,         // bits of a mean
    parameter WORDS = 3136,      // means, at least 2
    parameter ADDRESS_BITS = 12  // ceil(log2(WORDS))
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    write_i,          // write at this edge
    input  wire [ADDRESS_BITS-1:0] write_address_i,  // address of the word that is written
    input  wire [       WIDTH-1:0] data_i,           // the mean that is written
    input  wire [ADDRESS_BITS-1:0] read_address_i,   // address of the mean that is read at this edge
    output wire [       WIDTH-1:0] data_o            // the mean that was read
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(WORDS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_WORDS u_refused ();
        end
    endgenerate

    generate
        if (WORDS > 64) begin : g_block
            (* ram_style = "block", no_rw_check *)
            reg [WIDTH-1:0] means_q[0:WORDS-1];
            reg [WIDTH-1:0] mean_q;

            always @(posedge clk_i) begin
                if (write_i) means_q[write_address_i] <= data_i;
                mean_q <= means_q[read_address_i];
            end

            assign data_o = mean_q;
        end else begin : g_distributed
            (* ram_style = "distributed", no_rw_check *)
            reg [WIDTH-1:0] means_q[0:WORDS-1];
            reg [WIDTH-1:0] mean_q;

            always @(posedge clk_i) begin
                if (write_i) means_q[write_address_i] <= data_i;
                mean_q <= means_q[read_address_i];
            end

            assign data_o = mean_q;
        end
    endgenerate

endmodule

`default_nettype wire
