// SPDX-License-Identifier: MIT OR Apache-2.0
// The definition: bits go in from the lowest on, and the polynomial is added if a bit differs from the lowest bit of the sum.
module properties #(parameter BITS = 16) (input wire [31:0] crc, input wire [BITS-1:0] data);
    wire [31:0] next;
    packet_crc #(.BITS(BITS)) dut (.crc_i(crc), .data_i(data), .crc_o(next));

    reg [31:0] sum;
    integer bit_number;
    always @* begin
        sum = crc;
        for (bit_number = 0; bit_number < BITS; bit_number = bit_number + 1)
            sum = (sum >> 1) ^ (sum[0] != data[bit_number] ? 32'hEDB88320 : 32'd0);
        assert(next == sum);
    end
endmodule
