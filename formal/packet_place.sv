// SPDX-License-Identifier: MIT OR Apache-2.0
// Row and column belong to the last number once the module says that it is done, and it is done in time.
module properties #(parameter COLUMNS = 5) (input wire clk_i, rst_i, start, input wire [4:0] region);
    `include "reset.vh"
    localparam COLUMN_BITS = $clog2(COLUMNS);
    localparam STEPS = 5 - COLUMN_BITS + 1;
    localparam [4:0] DIVISOR = COLUMNS;  // no wider than the number, because a divider of 32 bits takes Yosys seconds
    wire busy;
    wire [5-COLUMN_BITS:0] row;
    wire [COLUMN_BITS-1:0] column;
    packet_place #(.COLUMNS(COLUMNS), .COLUMN_BITS(COLUMN_BITS), .REGION_BITS(5)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .start_i(start), .region_i(region), .busy_o(busy), .row_o(row), .column_o(column)
    );

    reg [4:0] given;
    reg known;
    reg [2:0] clocks;
    always @(posedge clk_i) begin
        if (rst_i) known <= 0;
        else if (start) begin
            known  <= 1;
            given  <= region;
            clocks <= 0;
        end else if (clocks != 7) clocks <= clocks + 1;
    end

    always @* if (started && known) begin
        assert(busy == (clocks < STEPS));
        if (!busy) assert(row == given / DIVISOR && column == given % DIVISOR);
    end
endmodule
