// SPDX-License-Identifier: MIT OR Apache-2.0
// A memory that is not mapped to cells. It has no content, so that its ports become ports of the netlist.
(* blackbox *)
module foveate_memory #(
    parameter WIDTH = 1,    // bits of a word
    parameter WORDS = 2,    // number of words
    parameter READS = 1,    // read ports
    parameter WRITES = 1,   // write ports
    parameter CLOCKED = 0   // not 0: a word is read at a clock edge
) (
    input  [                READS-1:0] read_enable,
    input  [READS*$clog2(WORDS)-1:0]   read_address,
    output [          READS*WIDTH-1:0] read_data,
    input  [         WRITES*WIDTH-1:0] write_enable,
    input  [WRITES*$clog2(WORDS)-1:0]  write_address,
    input  [         WRITES*WIDTH-1:0] write_data
);
endmodule
