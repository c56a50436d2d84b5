// SPDX-License-Identifier: MIT OR Apache-2.0
// A sensor that acknowledges at random, and two steps of any kind. The outputs are followed as a bus.
module properties #(parameter ADDRESS_BYTES = 1) (
    input wire clk_i, rst_i, answer, input wire [8*ADDRESS_BYTES+8:0] word
);
    `include "reset.vh"
    localparam QUARTER = 4, BYTES = ADDRESS_BYTES + 2;
    localparam [6:0] DEVICE = 7'h5A;
    wire step, scl_low, sda_low, done, failed;
    i2c_setup #(
        .DEVICE(DEVICE), .ADDRESS_BYTES(ADDRESS_BYTES), .STEPS(2), .STEP_BITS(1), .QUARTER(QUARTER), .PAUSE(1)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_o(step), .word_i(word), .scl_low_o(scl_low), .sda_low_o(sda_low), .sda_i(answer), .done_o(done),
        .failed_o(failed)
    );
    wire scl = !scl_low, sda = !sda_low;

    // The memory of steps shows a step from the second clock after its number on.
    reg step_before, same_before;
    reg [8*ADDRESS_BYTES+8:0] word_before;
    always @(posedge clk_i) begin
        step_before <= step;
        same_before <= !rst_i && step == step_before;
        word_before <= word;
    end
    always @* if (started && same_before && step == step_before) assume(word == word_before);

    // The bus one clock ago, and the number of clocks since each line changed.
    reg scl_before, sda_before, was_reset;
    reg [3:0] scl_for, sda_for;
    wire scl_moves = scl != scl_before;
    wire sda_moves = sda != sda_before;
    reg talks;         // between start and stop
    reg [5:0] rises;   // rising edges of scl since the start
    reg [3:0] bits;    // number of bits of the byte
    reg [2:0] bytes;
    reg [2:0] starts;  // number of starts of the step
    wire start = sda_moves && !sda && scl;
    wire stop = sda_moves && sda && scl;
    reg step_of_start;
    always @(posedge clk_i) begin
        was_reset  <= rst_i;
        scl_before <= scl;
        sda_before <= sda;
        scl_for    <= scl_moves ? 1 : scl_for == 15 ? 15 : scl_for + 1;
        sda_for    <= sda_moves ? 1 : sda_for == 15 ? 15 : sda_for + 1;
        if (start) begin
            {talks, bits, bytes} <= {1'b1, 4'd0, 3'd0};
            step_of_start <= step;
            starts        <= step == step_of_start ? starts + 1 : 1;
        end
        if (stop) talks <= 0;
        if (scl_moves && scl) begin
            bits <= bits == 8 ? 0 : bits + 1;
            if (bits == 8) bytes <= bytes + 1;
        end
        // A reset releases both lines.
        if (rst_i) begin
            {talks, bits, bytes, starts} <= 0;
            {scl_before, sda_before} <= 2'b11;
            {scl_for, sda_for} <= {4'd8, 4'd8};
            step_of_start <= 0;
        end
    end
    wire [31:0] all = ADDRESS_BYTES == 1 ? {DEVICE, 1'b0, word[15:0], 8'd0} : {DEVICE, 1'b0, word[8*ADDRESS_BYTES+7:0]};

    wire [4:0] at = 5'd31 - {bytes[1:0], bits[2:0]};

    always @* if (started && !rst_i) begin
        assert(!(scl_moves && sda_moves));
        if (scl_moves) assert(talks);
        if (start) assert(!talks && scl_for >= 2 * QUARTER && sda_for >= 2 * QUARTER);
        if (stop) assert(talks && bits == 1 && bytes != 0 && scl_for >= 2 * QUARTER);
        if (sda_moves && !scl) assert(scl_for >= QUARTER);
        if (scl_moves) assert(scl_for >= 2 * QUARTER);
        if (scl_moves && scl) assert(sda_for >= QUARTER);
        if (scl_moves && !scl && bits == 0 && bytes == 0) assert(sda_for >= 2 * QUARTER);
        // Bits are sent with the highest of a byte first, and the line is released for the acknowledgement. A stop follows the bytes.
        if (scl_moves && scl && bytes < BYTES && bits < 8 && !(bits == 0 && bytes != 0 && !sda))
            assert(sda == all[at]);
        if (scl_moves && scl && bits == 8) assert(sda);
        assert(bytes <= BYTES);
        if (bytes == BYTES && scl_moves && scl) assert(!sda && bits == 0);
        assert(starts <= 3);
        if (start) assert(!word[8*ADDRESS_BYTES+8]);
        if (done) assert(scl && sda && !talks);
    end
endmodule
