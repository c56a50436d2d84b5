// SPDX-License-Identifier: MIT OR Apache-2.0
// A read gives the word that was written last at that place, GROUPS + 6 clocks after its address. The followed word is
// written at least as many clocks before it is read.
module properties #(
    parameter WORDS = 13, parameter ADDRESS_BITS = $clog2(WORDS), parameter GROUPS = 4
) (
    input wire clk_i, rst_i, write, input wire [ADDRESS_BITS-1:0] write_address, read_address, input wire data
);
    `include "reset.vh"
    localparam LATENCY = GROUPS + 6;
    (* anyconst *) wire [ADDRESS_BITS-1:0] place;
    always @* begin
        assume(write_address < WORDS);
        assume(read_address < WORDS);
        assume(place < WORDS);
    end
    wire found;
    raster_banks #(
        .WIDTH(1), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .BANK_BITS(1), .GROUP_BITS(1), .GROUPS(GROUPS)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .write_i(write), .write_address_i(write_address), .data_i(data),
        .read_address_i(read_address), .data_o(found)
    );
    reg last;
    reg [4:0] age = 5'd0;  // clocks since the word was written, up to 31; 0 before that
    reg [LATENCY-1:0] asked = 0;  // one bit per clock: the word was requested then, and had been written long before
    reg [LATENCY-1:0] word;
    always @(posedge clk_i) begin
        if (write && write_address == place) begin
            last <= data;
            age <= 5'd1;
        end else if (age != 5'd0 && age != 5'd31) age <= age + 5'd1;
        asked <= {asked[LATENCY-2:0], read_address == place && age >= LATENCY && !rst_i};
        word <= {word[LATENCY-2:0], last};
        if (rst_i) age <= 5'd0;
    end
    always @* if (asked[LATENCY-1]) assert(found == word[LATENCY-1]);
endmodule
