// SPDX-License-Identifier: MIT OR Apache-2.0
// Takes a frame with one pixel per lane at a time: the words of slot 0, then those of slot 1, and so on. The place is that of
// the pixel after the next one, because the groups register the place of the next one.
`default_nettype none

module serial_parallel_feed #(
    parameter PIXELS = 64,    // pixels of a slot
    parameter FOLD = 1,       // slots of a lane
    parameter WORD_BITS = 7,  // bits of an address inside a slot
    parameter SLOT_BITS = 1   // bits of the number of a slot, at least 1
) (
    input  wire                 clk_i,     // clock, rising edge
    input  wire                 rst_i,     // synchronous reset, active high
    input  wire                 valid_i,   // a pixel is offered to every lane
    input  wire                 reopen_i,  // the frame before is done
    output wire                 ready_o,   // an offered pixel is taken
    output wire                 open_o,    // ready_o after this edge
    output wire                 last_o,    // the last pixel of the frame is taken
    output wire [SLOT_BITS-1:0] slot_o,    // slot of the place
    output wire [WORD_BITS-1:0] word_o     // address of the place inside the slot
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (PIXELS < 2) begin : g_pixels PIXELS_must_be_2_or_more u_refused (); end
        if (FOLD < 1) begin : g_fold FOLD_must_be_1_or_more u_refused (); end
        if (WORD_BITS < $clog2(PIXELS)) begin : g_word_bits
            WORD_BITS_must_address_PIXELS u_refused ();
        end
        if (SLOT_BITS != (FOLD > 1 ? $clog2(FOLD) : 1)) begin : g_slot_bits
            SLOT_BITS_must_number_the_slots u_refused ();
        end
    endgenerate

    localparam LAST = PIXELS - 1;
    localparam [WORD_BITS-1:0] SECOND = 1;

    reg ready_q;
    reg [WORD_BITS-1:0] word_q;
    wire first_slot;
    wire last_word = word_q == LAST[WORD_BITS-1:0];
    wire taken = ready_q && valid_i;
    wire moves = reopen_i || (taken && !last_o);

    assign ready_o = ready_q;
    assign last_o = taken && first_slot && word_q == {WORD_BITS{1'b0}};
    assign open_o = rst_i || reopen_i || (ready_q && !last_o);
    assign word_o = word_q;

    always @(posedge clk_i) begin
        ready_q <= open_o;
        if (rst_i) word_q <= SECOND;
        else if (moves) word_q <= last_word ? {WORD_BITS{1'b0}} : word_q + 1'b1;
    end

    generate
        if (FOLD > 1) begin : g_slot
            localparam LAST_SLOT = FOLD - 1;
            reg [SLOT_BITS-1:0] slot_q;
            assign first_slot = slot_q == {SLOT_BITS{1'b0}};
            assign slot_o = slot_q;

            always @(posedge clk_i) begin
                if (rst_i) slot_q <= {SLOT_BITS{1'b0}};
                else if (moves && last_word)
                    slot_q <= slot_q == LAST_SLOT[SLOT_BITS-1:0] ? {SLOT_BITS{1'b0}} : slot_q + 1'b1;
            end
        end else begin : g_no_slot
            assign first_slot = 1'b1;
            assign slot_o = {SLOT_BITS{1'b0}};
        end
    endgenerate

endmodule

`default_nettype wire
