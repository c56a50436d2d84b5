// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds up the CRC fields of all ROW, REGION and END packets (docs/boards.md), as a short proof of what left a core. It only
// observes the stream. FRAME packets are left out, because they contain a time.
`default_nettype none

module packet_signature (
    input  wire        clk_i,     // clock, rising edge
    input  wire        rst_i,     // synchronous reset, active high
    input  wire [63:0] data_i,    // a word of a packet
    input  wire        valid_i,   // a word of a packet is on data_i
    input  wire        last_i,    // the word is the last of its packet
    input  wire        ready_i,   // the word is taken
    output wire [31:0] sum_o,     // sum of all packets so far, modulo 2^32
    output wire [31:0] frames_o,  // number of END packets so far
    output wire        done_o     // the last packet that was added was an END
);

    // Types of packets.
    localparam [3:0] ROW = 4'd2;
    localparam [3:0] REGION = 4'd4;
    localparam [3:0] END = 4'd5;

    // The registered word and its packet. The sum starts at these registers.
    reg inside_q;                // the word is in a packet, after its head
    reg counts_q, end_q;         // the packet is a ROW, REGION or END packet; it is an END packet
    reg tail_q, add_q, add_end_q;
    reg [31:0] crc_q, sum_q, frames_q;
    reg done_q;
    wire take = valid_i && ready_i;
    wire [3:0] type_bits = data_i[11:8];
    wire unused_data = |data_i[31:12] || |data_i[7:0];

    always @(posedge clk_i) begin
        if (take) begin
            inside_q <= !last_i;
            crc_q    <= data_i[63:32];
            if (!inside_q) begin
                counts_q <= type_bits == ROW || type_bits == REGION || type_bits == END;
                end_q    <= type_bits == END;
            end
        end
        tail_q    <= take && last_i && inside_q;
        add_q     <= tail_q && counts_q;
        add_end_q <= tail_q && end_q;
        if (rst_i) begin
            inside_q  <= 1'b0;
            tail_q    <= 1'b0;
            add_q     <= 1'b0;
            add_end_q <= 1'b0;
        end
    end

    reg [31:0] added_q;
    always @(posedge clk_i) begin
        added_q <= crc_q;
        if (add_q) sum_q <= sum_q + added_q;
        if (add_end_q) frames_q <= frames_q + 1'b1;
        done_q <= add_end_q;
        if (rst_i) begin
            sum_q    <= 32'd0;
            frames_q <= 32'd0;
            done_q   <= 1'b0;
        end
    end

    assign sum_o = sum_q;
    assign frames_o = frames_q;
    assign done_o = done_q;

endmodule

`default_nettype wire
