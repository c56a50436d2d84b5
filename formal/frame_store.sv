// SPDX-License-Identifier: MIT OR Apache-2.0
// A read gives the word that was written last at that place, whatever is written at other places, with one bank or many.
module properties #(parameter PIXELS = 64, parameter ADDRESS_BITS = $clog2(PIXELS)) (
    input wire clk_i, rst_i, write, input wire [ADDRESS_BITS-1:0] address, input wire data
);
    (* anyconst *) wire [ADDRESS_BITS-1:0] place;
    always @* begin
        assume(address < PIXELS);  // proven of every counter that makes addresses
        assume(place < PIXELS);
    end
    wire read;
    frame_store #(.WIDTH(1), .PIXELS(PIXELS), .ADDRESS_BITS(ADDRESS_BITS)) dut (
        .clk_i(clk_i), .write_i(write), .address_i(address), .data_i(data), .data_o(read)
    );
    reg written = 1'b0;
    reg last;
    always @(posedge clk_i) if (write && address == place) begin
        written <= 1'b1;
        last <= data;
    end
    always @* if (written && address == place) assert(read == last);
endmodule
