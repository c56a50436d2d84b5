// SPDX-License-Identifier: MIT OR Apache-2.0
// Writes the registers of a sensor after reset, one after the other, over I2C (docs/boards.md). The steps are in a memory
// outside, which shows a step in the clock of its number or one clock later.
//
// A bit takes four quarters. scl is low in the first two, and sda changes at the start of the second, so that it never changes
// near an edge of scl. Only a start condition, in the third quarter, and a stop condition, after the fourth, change sda while
// scl is high.
`default_nettype none

module i2c_setup #(
    parameter [6:0] DEVICE = 7'h24,  // address of the sensor on the bus
    parameter ADDRESS_BYTES = 2,     // bytes of the address of a register, 1 or 2; the high one goes first
    parameter STEPS = 64,            // steps of the set-up
    parameter STEP_BITS = 6,         // ceil(log2(STEPS)), at least 1
    parameter QUARTER = 30,          // clocks of a quarter of a bit, at least 4
    parameter PAUSE = 12000          // clocks of one unit of a pause, at least 1
) (
    input  wire                       clk_i,      // clock, rising edge
    input  wire                       rst_i,      // synchronous reset, active high
    output wire [      STEP_BITS-1:0] step_o,     // number of the step that is read
    input  wire [8*ADDRESS_BYTES+8:0] word_i,     // the step: from the highest bit on a pause flag, the address, the value
    output reg                        scl_low_o,  // the clock line is driven to 0
    output reg                        sda_low_o,  // the data line is driven to 0
    input  wire                       sda_i,      // level of the data line, asynchronous
    output wire                       done_o,     // all steps are done
    output reg                        failed_o    // a step was not acknowledged in three tries
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (ADDRESS_BYTES != 1 && ADDRESS_BYTES != 2) begin : g_address_bytes ADDRESS_BYTES_must_be_1_or_2 u_refused (); end
        if (STEPS < 1) begin : g_steps STEPS_must_be_1_or_more u_refused (); end
        if (STEP_BITS != (STEPS < 2 ? 1 : $clog2(STEPS))) begin : g_step_bits
            STEP_BITS_must_be_clog2_of_STEPS_and_1_or_more u_refused ();
        end
        if (QUARTER < 4) begin : g_quarter QUARTER_must_be_4_or_more u_refused (); end
        if (PAUSE < 1) begin : g_pause PAUSE_must_be_1_or_more u_refused (); end
    endgenerate

    localparam LONGEST = PAUSE > QUARTER ? PAUSE : QUARTER;
    localparam TIME_BITS = $clog2(LONGEST);
    localparam LAST_QUARTER = QUARTER - 1;
    localparam LAST_PAUSE = PAUSE - 1;
    localparam LAST_STEP = STEPS - 1;
    localparam [2:0] START = 3'd0;  // both lines rest for two quarters, in which the step comes; then a start condition
    localparam [2:0] BITS = 3'd1;   // the bytes, each with its acknowledgement
    localparam [2:0] STOP = 3'd2;   // a stop condition
    localparam [2:0] WAIT = 3'd3;   // a pause
    localparam [2:0] DONE = 3'd4;   // the end, from the third quarter on

    reg [2:0] state_q;
    reg [1:0] quarter_q;
    reg [TIME_BITS-1:0] time_q;   // clocks left of a quarter, or of a unit of a pause
    reg [7:0] count_q;            // number of the bit, from bit 4 on of the byte, that is sent; or units of a pause that are over
    reg [STEP_BITS-1:0] step_q;
    reg [1:0] tries_q;            // tries of the step that were not acknowledged
    reg refused_q;                // a byte of the step was not acknowledged
    (* ASYNC_REG = "TRUE" *) reg sda_first_q, sda_q;
    wire pause = word_i[8*ADDRESS_BYTES+8];
    wire [7:0] value = word_i[7:0];

    // The bit that is sent.
    wire [31:0] bytes;
    generate
        if (ADDRESS_BYTES == 2) begin : g_two
            assign bytes = {value, word_i[15:8], word_i[23:16], DEVICE, 1'b0};
        end else begin : g_one
            assign bytes = {value, value, word_i[15:8], DEVICE, 1'b0};
        end
    endgenerate
    localparam [1:0] LAST_BYTE = ADDRESS_BYTES == 2 ? 2'd3 : 2'd2;
    wire in_answer = count_q[3];
    wire send = bytes[{count_q[5:4], ~count_q[2:0]}];

    wire tick = time_q == {TIME_BITS{1'b0}};
    wire bit_ends = tick && quarter_q == 2'd3;
    wire paused = count_q == value;
    wire again = refused_q && tries_q != 2'd2;
    wire last_step = step_q == LAST_STEP[STEP_BITS-1:0];
    wire next_step = (state_q == STOP && bit_ends && !again) || (state_q == WAIT && paused);
    // The acknowledgement is a ninth bit. After it the count continues with the next byte.
    wire [7:0] next_count = count_q + (state_q == BITS && in_answer ? 8'd8 : 8'd1);

    always @(posedge clk_i) begin
        sda_first_q <= sda_i;
        sda_q       <= sda_first_q;
        time_q      <= !tick ? time_q - 1'b1 : state_q == WAIT ? LAST_PAUSE[TIME_BITS-1:0] : LAST_QUARTER[TIME_BITS-1:0];
        if (tick && state_q != WAIT && !done_o) quarter_q <= quarter_q + 1'b1;
        case (state_q)
            START: begin
                count_q   <= 8'd0;
                refused_q <= 1'b0;
                if (tick && quarter_q == 2'd1 && pause) begin
                    state_q <= WAIT;
                    time_q  <= LAST_PAUSE[TIME_BITS-1:0];
                end else if (bit_ends) state_q <= BITS;
            end
            BITS:
            if (bit_ends) begin
                count_q <= next_count;
                if (in_answer) begin
                    refused_q <= sda_q;
                    if (sda_q || count_q[5:4] == LAST_BYTE) state_q <= STOP;
                end
            end
            STOP:
            if (bit_ends) begin
                state_q <= START;
                tries_q <= again ? tries_q + 1'b1 : 2'd0;
                if (refused_q && !again) failed_o <= 1'b1;
            end
            WAIT:
            if (paused) begin
                state_q   <= START;
                quarter_q <= 2'd0;
                time_q    <= LAST_QUARTER[TIME_BITS-1:0];
            end else if (tick) count_q <= next_count;
            default: ;
        endcase
        if (next_step) begin
            if (last_step) state_q <= DONE;
            else step_q <= step_q + 1'b1;
        end

        scl_low_o <= (state_q == BITS || state_q == STOP) && !quarter_q[1];
        case (state_q)
            START: sda_low_o <= quarter_q[1];
            BITS: if (quarter_q != 2'd0) sda_low_o <= !in_answer && !send;
            STOP: if (quarter_q != 2'd0) sda_low_o <= 1'b1;
            default: sda_low_o <= 1'b0;
        endcase
        if (rst_i) begin
            state_q   <= START;
            quarter_q <= 2'd0;
            time_q    <= LAST_QUARTER[TIME_BITS-1:0];
            step_q    <= {STEP_BITS{1'b0}};
            tries_q   <= 2'd0;
            failed_o  <= 1'b0;
            scl_low_o <= 1'b0;
            sda_low_o <= 1'b0;
        end
    end

    assign step_o = step_q;
    assign done_o = state_q == DONE && quarter_q[1];

endmodule

`default_nettype wire
