// SPDX-License-Identifier: MIT OR Apache-2.0
// Both clocks may rise at any time, also at the same time. The queue has four places, words have two bits.
module properties #(parameter RESET = 0) (input wire write_clk, read_clk, rst, write, take, input wire [1:0] data);
    wire full, valid;
    wire [1:0] found;
    clock_crossing #(.WIDTH(2), .DEPTH_BITS(2)) dut (
        .write_clk_i(write_clk), .write_i(write), .data_i(data), .full_o(full), .read_clk_i(read_clk), .rst_i(rst), .valid_o(valid),
        .data_o(found), .take_i(take)
    );

    generate
        if (RESET == 0) begin : g_order
            // Counts words that found room and words that were taken. A followed word is kept by its number.
            reg [2:0] in = 0, out = 0;
            reg [7:0] kept;
            wire [2:0] count = in - out;
            always @* assume(!rst);
            always @(posedge write_clk) if (write && !full) begin
                kept[2*in[1:0]+:2] <= data;
                in <= in + 1;
            end
            always @(posedge read_clk) if (take && valid) out <= out + 1;
            always @* begin
                assert(count <= 4);
                if (valid) assert(count != 0 && found == kept[2*out[1:0]+:2]);
                if (count == 4) assert(full);
            end
        end else begin : g_reset
            // Words say whether they were written after the first reset. An earlier word never comes if it was written at least three
            // edges of the read clock before. A later one may come, as two clocks have no order.
            reg [1:0] quiet = 3;  // edges of the read clock without a word
            reg [2:0] in = 0, in_before = 0;
            reg was_reset = 0;
            always @(posedge write_clk) if (write && !full) in <= in + 1;
            always @(posedge read_clk) begin
                in_before <= in;
                quiet     <= in != in_before ? 0 : quiet == 3 ? 3 : quiet + 1;
                if (rst) was_reset <= 1;
            end
            always @* begin
                assume(data[0] == was_reset);
                if (rst && !was_reset) assume(quiet == 3 && in == in_before && !write);
                if (was_reset && valid) assert(found[0]);
            end
        end
    endgenerate
endmodule
