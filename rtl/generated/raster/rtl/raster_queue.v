// SPDX-License-Identifier: MIT OR Apache-2.0
// A queue of regions, of which up to 2^BITS - 1 may wait. Its oldest entry is read ahead: it is on oldest_o two clocks (DEEP:
// three) after it entered, and not earlier than two clocks after the entry before it was taken.
`default_nettype none

module raster_queue #(
    parameter WIDTH = 32,  // bits of an entry
    parameter BITS = 9,    // log2 of the number of entries
    parameter DEEP = 0     // 1: the oldest entry has a register of its own with no logic behind it
) (
    input  wire             clk_i,     // clock, rising edge
    input  wire             rst_i,     // synchronous reset, active high
    input  wire             enter_i,   // an entry enters
    input  wire [WIDTH-1:0] entry_i,   // the entry that enters
    input  wire             take_i,    // the oldest entry is taken; allowed only with valid_o
    output wire             valid_o,   // the oldest entry is on oldest_o
    output wire [WIDTH-1:0] oldest_o,  // the oldest entry
    output wire             waits_o    // an entry waits, on the port or in the memory
);

    reg [BITS-1:0] enter_q, leave_q;
    wire stored = enter_q != leave_q;  // an entry is in the memory
    wire leave;                        // the oldest entry of the memory leaves it
    wire read;                         // an entry is read; with `leave`, it is the oldest
    wire move;                         // the entry that was read becomes the oldest entry (DEEP)
    reg oldest_valid_q;

    raster_memory #(.WIDTH(WIDTH), .WORDS(1 << BITS), .ADDRESS_BITS(BITS), .OUTPUT_STAGE(DEEP)) u_entries (
        .clk_i(clk_i), .write_i(enter_i), .write_address_i(enter_q), .data_i(entry_i), .read_i(read),
        .read_address_i(leave_q), .output_i(move), .data_o(oldest_o)
    );

    generate
        if (DEEP) begin : g_deep
            reg read_valid_q;
            assign move = read_valid_q && !oldest_valid_q;
            always @(posedge clk_i) begin
                read_valid_q   <= leave || (read_valid_q && !move);
                oldest_valid_q <= move || (oldest_valid_q && !take_i);
                if (rst_i) begin
                    read_valid_q   <= 1'b0;
                    oldest_valid_q <= 1'b0;
                end
            end
            // An entry is read at every clock until one is kept, because it is known only late in a clock if it was stored.
            assign read = !read_valid_q;
            assign leave = stored && !read_valid_q;
            assign waits_o = stored || read_valid_q || oldest_valid_q;
        end else begin : g_plain
            always @(posedge clk_i) begin
                oldest_valid_q <= stored && !take_i;
                if (rst_i) oldest_valid_q <= 1'b0;
            end
            assign leave = take_i;
            assign {read, move} = 2'b11;
            assign waits_o = stored;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (enter_i) enter_q <= enter_q + 1'b1;
        if (leave) leave_q <= leave_q + 1'b1;
        if (rst_i) begin
            enter_q <= {BITS{1'b0}};
            leave_q <= {BITS{1'b0}};
        end
    end

    assign valid_o = oldest_valid_q;

endmodule

`default_nettype wire
