// SPDX-License-Identifier: MIT OR Apache-2.0
// The rule by which Yosys replaces a writable memory of more than LIMIT bits by the module foveate_memory.
(* techmap_celltype = "$mem_v2" *)
module foveate_memory_cut (RD_CLK, RD_EN, RD_ARST, RD_SRST, RD_ADDR, RD_DATA, WR_CLK, WR_EN, WR_ADDR, WR_DATA);
    parameter MEMID = "";
    parameter SIZE = 4;
    parameter OFFSET = 0;
    parameter ABITS = 2;
    parameter WIDTH = 8;
    parameter INIT = 0;
    parameter RD_PORTS = 1;
    parameter RD_CLK_ENABLE = 0;
    parameter RD_CLK_POLARITY = 0;
    parameter RD_TRANSPARENCY_MASK = 0;
    parameter RD_COLLISION_X_MASK = 0;
    parameter RD_WIDE_CONTINUATION = 0;
    parameter RD_CE_OVER_SRST = 0;
    parameter RD_ARST_VALUE = 0;
    parameter RD_SRST_VALUE = 0;
    parameter RD_INIT_VALUE = 0;
    parameter WR_PORTS = 1;
    parameter WR_CLK_ENABLE = 0;
    parameter WR_CLK_POLARITY = 0;
    parameter WR_PRIORITY_MASK = 0;
    parameter WR_WIDE_CONTINUATION = 0;

    input  [      RD_PORTS-1:0] RD_CLK, RD_EN, RD_ARST, RD_SRST;
    input  [RD_PORTS*ABITS-1:0] RD_ADDR;
    output [RD_PORTS*WIDTH-1:0] RD_DATA;
    input  [      WR_PORTS-1:0] WR_CLK;
    input  [WR_PORTS*WIDTH-1:0] WR_EN;
    input  [WR_PORTS*ABITS-1:0] WR_ADDR;
    input  [WR_PORTS*WIDTH-1:0] WR_DATA;

    // A ROM, which Yosys makes of a case statement, has no write port and becomes gates.
    wire _TECHMAP_FAIL_ = WIDTH * SIZE <= LIMIT || WR_PORTS == 0;

    foveate_memory #(.WIDTH(WIDTH), .WORDS(SIZE), .READS(RD_PORTS), .WRITES(WR_PORTS), .CLOCKED(RD_CLK_ENABLE == {RD_PORTS{1'b1}})) u_memory (
        .read_enable(RD_EN), .read_address(RD_ADDR), .read_data(RD_DATA),
        .write_enable(WR_EN), .write_address(WR_ADDR), .write_data(WR_DATA)
    );
endmodule
