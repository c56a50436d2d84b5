// SPDX-License-Identifier: MIT OR Apache-2.0
// The stream is arbitrary; the properties are in formal/inside/packet_signature.sv.
module properties (input wire clk_i, rst_i, valid, last, ready, input wire [63:0] data);
    `include "reset.vh"
    wire [31:0] found, frames;
    wire done;
    packet_signature dut (
        .clk_i(clk_i), .rst_i(rst_i), .data_i(data), .valid_i(valid), .last_i(last), .ready_i(ready), .sum_o(found), .frames_o(frames), .done_o(done)
    );
endmodule
