// SPDX-License-Identifier: MIT OR Apache-2.0
// A read gives the word that was written last at that address, before a write at the same edge, after as many clocks as the
// memory takes.
module properties #(
    parameter WORDS = 64, parameter BLOCK = 0, parameter LATE = 0, parameter ADDRESS_BITS = $clog2(WORDS)
) (
    input wire clk_i, rst_i, write, input wire [ADDRESS_BITS-1:0] address, input wire data
);
    (* anyconst *) wire [ADDRESS_BITS-1:0] place;
    always @* begin
        assume(address < WORDS);
        assume(place < WORDS);
    end
    wire read;
    serial_memory #(.WIDTH(1), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(BLOCK), .LATE(LATE)) dut (
        .clk_i(clk_i), .write_i(write), .address_i(address), .data_i(data), .data_o(read)
    );
    reg written = 1'b0;
    reg last;
    // The requests and the expected words, by clocks since then.
    reg [2:1] asked = 2'b00;
    reg [2:1] answer;
    always @(posedge clk_i) begin
        asked  <= {asked[1], written && address == place};
        answer <= {answer[1], last};
        if (write && address == place) begin
            written <= 1'b1;
            last <= data;
        end
    end
    wire [2:0] asked_before = {asked, written && address == place};
    wire [2:0] answer_then = {answer, last};
    localparam CLOCKS = BLOCK + LATE;
    always @* if (asked_before[CLOCKS]) assert(read == answer_then[CLOCKS]);
endmodule
