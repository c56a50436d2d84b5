// SPDX-License-Identifier: MIT OR Apache-2.0
// What is read is what was written last at that address, at once or a clock later, before the write at the
// same edge.
module properties #(parameter WORDS = 64, parameter BLOCK = 0, parameter ADDRESS_BITS = $clog2(WORDS)) (
    input wire clk_i, rst_i, write, input wire [ADDRESS_BITS-1:0] address, input wire data
);
    (* anyconst *) wire [ADDRESS_BITS-1:0] place;
    always @* begin
        assume(address < WORDS);
        assume(place < WORDS);
    end
    wire read;
    serial_memory #(.WIDTH(1), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(BLOCK)) dut (
        .clk_i(clk_i), .write_i(write), .address_i(address), .data_i(data), .data_o(read)
    );
    reg written = 1'b0, asked = 1'b0;
    reg last, answer;
    always @(posedge clk_i) begin
        asked  <= written && address == place;
        answer <= last;
        if (write && address == place) begin
            written <= 1'b1;
            last <= data;
        end
    end
    always @* begin
        if (BLOCK == 0 && written && address == place) assert(read == last);
        if (BLOCK != 0 && asked) assert(read == answer);
    end
endmodule
