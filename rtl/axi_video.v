// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes whole frames of AXI4-Stream video, even if the video is damaged (docs/axi.md). A short line is filled with its
// last pixel, missing lines are copies of the last line, and the excess of a long line is dropped. An input word waits
// in one register, so that ready_o depends on no input; words of the frame leave through valid_o and ready_i.
`default_nettype none

module axi_video #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter LANES = 1,       // pixels of a word
    parameter WORDS = 1920,    // words of a line, at least 2
    parameter LINES = 1080,    // lines of a frame
    parameter WORD_BITS = 11,  // ceil(log2(WORDS))
    parameter LINE_BITS = 11   // ceil(log2(LINES)), at least 1
) (
    input  wire                   clk_i,        // clock, rising edge
    input  wire                   rst_i,        // synchronous reset, active high
    input  wire                   valid_i,      // a word is offered
    input  wire [LANES*WIDTH-1:0] pixel_i,      // the offered word, its left pixel in the lowest bits
    input  wire                   sof_i,        // the offered word is the first of a frame
    input  wire                   eol_i,        // the offered word is the last of a line
    output wire                   ready_o,      // the offered word is taken
    input  wire                   admit_i,      // a frame may begin
    input  wire                   late_i,       // 1: a frame that may not begin is skipped; 0: it waits
    output wire                   begin_o,      // a frame begins at this edge, before its first word leaves
    output wire                   idle_o,       // no frame is under way
    output wire                   valid_o,      // a word of a whole frame is on pixel_o
    output wire [LANES*WIDTH-1:0] pixel_o,      // the word that leaves
    output wire                   sof_o,        // the word that leaves is the first of its frame
    input  wire                   ready_i,      // the sink takes the word that leaves
    output wire                   skip_o,       // a frame is skipped at this edge
    output reg                    repair_o,     // a frame was found to be damaged, for one clock
    output reg                    sof_early_o,  // a frame was too short, for one clock
    output reg                    sof_late_o,   // words came between two frames, for one clock
    output reg                    eol_early_o,  // a line was too short, for one clock
    output reg                    eol_late_o    // a line was too long, for one clock
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (LINES < 1) begin : g_lines LINES_must_be_1_or_more u_refused (); end
    endgenerate

    localparam LAST_WORD = WORDS - 1;
    localparam LAST_LINE = LINES - 1;
    localparam [2:0] SEEK = 3'd0;  // between two frames
    localparam [2:0] LINE = 3'd1;  // words of a line are taken
    localparam [2:0] FILL = 3'd2;  // the line is filled with its last pixel
    localparam [2:0] COPY = 3'd3;  // the frame is filled with copies of its last line
    localparam [2:0] DROP = 3'd4;  // the rest of a long line is dropped

    // The input register. It makes ready_o independent of all inputs.
    reg come_q, sof_q, eol_q;  // the register holds a word; it is the first of a frame; it is the last of a line
    reg [LANES*WIDTH-1:0] come_pixel_q;
    wire take;
    always @(posedge clk_i) begin
        if (ready_o) begin
            come_q       <= valid_i;
            sof_q        <= sof_i;
            eol_q        <= eol_i;
            come_pixel_q <= pixel_i;
        end
        if (rst_i) come_q <= 1'b0;
    end
    assign ready_o = !come_q || take;

    reg [2:0] state_q;
    reg [WORD_BITS-1:0] word_q;
    reg [LINE_BITS-1:0] line_q;
    reg complete_q;  // in DROP and SEEK: all words of the frame have left
    reg damaged_q;   // the frame has been found to be damaged
    reg [WIDTH-1:0] last_q;
    wire first_word = word_q == {WORD_BITS{1'b0}};
    wire last_word = word_q == LAST_WORD[WORD_BITS-1:0];
    wire last_line = line_q == LAST_LINE[LINE_BITS-1:0];
    wire first = first_word && line_q == {LINE_BITS{1'b0}};
    wire early = sof_q && !first;  // the registered word starts a frame inside a frame

    wire [LANES*WIDTH-1:0] copied;
    assign valid_o = state_q == LINE ? come_q && !early : state_q == FILL || state_q == COPY;
    assign pixel_o = state_q == LINE ? come_pixel_q : state_q == FILL ? {LANES{last_q}} : copied;
    assign sof_o = first;
    wire pass = valid_o && ready_i;
    wire [WORD_BITS-1:0] next_word = !pass ? word_q : last_word ? {WORD_BITS{1'b0}} : word_q + 1'b1;
    wire starts = state_q == SEEK && come_q && sof_q;
    wire skips = starts && !admit_i && late_i;

    assign skip_o = skips;
    assign begin_o = starts && admit_i;
    assign idle_o = state_q == SEEK;
    assign take = state_q == SEEK ? come_q && (!sof_q || skips)
                : state_q == LINE ? pass
                : state_q == DROP && come_q && !sof_q;

    wire too_early = (state_q == LINE || (state_q == DROP && !complete_q)) && come_q && early;
    wire too_short = state_q == LINE && pass && eol_q && !last_word;
    wire too_long = state_q == LINE && pass && !eol_q && last_word;
    wire too_late = state_q == SEEK && come_q && !sof_q && complete_q;

    always @(posedge clk_i) begin
        word_q <= next_word;
        if (pass && last_word) line_q <= last_line ? {LINE_BITS{1'b0}} : line_q + 1'b1;
        if (state_q == LINE && pass) last_q <= come_pixel_q[(LANES-1)*WIDTH+:WIDTH];
        case (state_q)
            SEEK: begin
                if (begin_o) begin
                    state_q    <= LINE;
                    complete_q <= 1'b0;
                end else if (take) complete_q <= 1'b0;
            end
            LINE: begin
                // A line that ends too early is filled first. The first word of the next frame waits in the register meanwhile.
                if (too_early) state_q <= first_word ? COPY : FILL;
                else if (pass) begin
                    if (too_short) state_q <= FILL;
                    else if (too_long) state_q <= DROP;
                    else if (last_word && last_line) state_q <= SEEK;
                    complete_q <= last_word && last_line;
                end
            end
            FILL:
            if (pass && last_word) begin
                state_q    <= last_line ? SEEK : LINE;
                complete_q <= last_line;
            end
            COPY:
            if (pass && last_word && last_line) begin
                state_q    <= SEEK;
                complete_q <= 1'b1;
            end
            default: if (come_q && (sof_q || eol_q)) state_q <= complete_q ? SEEK : LINE;
        endcase

        sof_early_o <= state_q == LINE && too_early;
        sof_late_o  <= too_late;
        eol_early_o <= too_short;
        eol_late_o  <= too_long;
        repair_o    <= !damaged_q && (too_early || too_short || too_long);
        damaged_q   <= !begin_o && (damaged_q || too_early || too_short || too_long);
        if (rst_i) begin
            state_q     <= SEEK;
            word_q      <= {WORD_BITS{1'b0}};
            line_q      <= {LINE_BITS{1'b0}};
            complete_q  <= 1'b0;
            sof_early_o <= 1'b0;
            sof_late_o  <= 1'b0;
            eol_early_o <= 1'b0;
            eol_late_o  <= 1'b0;
            repair_o    <= 1'b0;
        end
    end

    // The line memory: the last line, for copies of it. Its first word is read before a copy begins, because no word
    // passes at the clock before.
    raster_memory #(.WIDTH(LANES * WIDTH), .WORDS(WORDS), .ADDRESS_BITS(WORD_BITS)) u_line (
        .clk_i(clk_i), .write_i(pass && state_q != COPY), .write_address_i(word_q), .data_i(pixel_o),
        .read_i(1'b1), .read_address_i(next_word), .output_i(1'b1), .data_o(copied)
    );

endmodule

`default_nettype wire
