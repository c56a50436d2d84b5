// SPDX-License-Identifier: MIT OR Apache-2.0
// The class of an arbitrary region: in the committed map, in the other map, and in the map in use. Each read gives the class in
// the map in use, one clock later.
module properties #(parameter REGIONS = 17, parameter ADDRESS_BITS = 1) (
    input wire clk_i, rst_i, write, commit, occupied, input wire [ADDRESS_BITS-1:0] address, input wire [31:0] word,
    input wire [ADDRESS_BITS+3:0] region
);
    localparam [2*REGIONS-1:0] CLASSES = {REGIONS{6'b110110}};
    (* anyconst *) wire [ADDRESS_BITS+3:0] place;
    always @* assume(place < REGIONS);

    wire pending;
    wire [1:0] class_o;
    class_memory #(
        .REGIONS(REGIONS), .REGION_BITS(ADDRESS_BITS + 4), .ADDRESS_BITS(ADDRESS_BITS), .CLASSES(CLASSES)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .write_i(write), .address_i(address), .word_i(word), .commit_i(commit),
        .pending_o(pending), .occupied_i(occupied), .region_i(region), .class_o(class_o)
    );

    // docs/zones.md, for one region.
    reg begun = 1'b0;
    reg waits = 1'b0;
    reg [1:0] committed, other, used;
    wire [2*REGIONS-1:0] shifted = CLASSES >> (2 * place);
    wire [1:0] first = shifted[1:0];
    wire [1:0] was_committed = begun ? committed : first;
    wire [1:0] was_other = begun ? other : first;
    wire [1:0] was_used = begun ? used : first;
    wire [31:0] moved = word >> {place[3:0], 1'b0};
    wire [1:0] given = moved[1:0];
    wire takes = !rst_i && !waits;
    wire [1:0] written = takes && write && address == place[ADDRESS_BITS+3:4] ? given : was_other;
    wire [1:0] in_use = occupied && !rst_i ? was_used : was_committed;

    reg asked = 1'b0;
    reg [1:0] answer;
    always @(posedge clk_i) begin
        begun <= 1'b1;
        waits <= !rst_i && (waits ? occupied : commit);
        committed <= takes && commit ? written : was_committed;
        other <= takes && commit ? was_committed : written;
        used <= in_use;
        asked <= region == place;
        answer <= in_use;
    end
    always @* begin
        assert(pending == waits);
        if (asked) assert(class_o == answer);
    end
endmodule
