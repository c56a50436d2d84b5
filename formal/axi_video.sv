// SPDX-License-Identifier: MIT OR Apache-2.0
// A model of docs/axi.md over the words that have been taken: frames of LINES lines of 3 words, pixels of one bit.
module properties #(parameter LANES = 1, parameter LINES = 3) (
    input wire clk_i, rst_i, valid, sof, eol, admit, late, ready, input wire [LANES-1:0] pixels
);
    `include "reset.vh"
    localparam WORDS = 3;
    wire taken, begins, idle, word, first, skips, repair, sof_early, sof_late, eol_early, eol_late;
    wire [LANES-1:0] out;
    axi_video #(.WIDTH(1), .LANES(LANES), .WORDS(WORDS), .LINES(LINES), .WORD_BITS(2), .LINE_BITS(2)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .pixel_i(pixels), .sof_i(sof), .eol_i(eol), .ready_o(taken), .admit_i(admit),
        .late_i(late), .begin_o(begins), .idle_o(idle), .valid_o(word), .pixel_o(out), .sof_o(first), .ready_i(ready), .skip_o(skips),
        .repair_o(repair), .sof_early_o(sof_early), .sof_late_o(sof_late), .eol_early_o(eol_early), .eol_late_o(eol_late)
    );

    // The word that has come and still has to be processed.
    reg has, has_sof, has_eol;
    reg [LANES-1:0] has_pixels;
    always @(posedge clk_i) begin
        if (rst_i) has <= 0;
        else if (taken) {has, has_sof, has_eol, has_pixels} <= {valid, sof, eol, pixels};
    end

    // The place in the current frame, and the parts of it that are filled in: the rest of a line, or the rest of the frame.
    reg inside, made_line, made_frame, over, behind, damaged;
    reg [1:0] column, line;
    reg last;                    // the last pixel that passed
    reg [LANES-1:0] before[0:2]; // the last line
    wire at_start = column == 0 && line == 0;
    wire ends_line = column == WORDS - 1;
    wire ends_frame = ends_line && line == LINES - 1;
    wire cuts = inside && !made_line && !made_frame && has && has_sof && !at_start;  // the next frame comes too early
    wire passes = word && ready;
    wire takes_word = passes && inside && !made_line && !made_frame && !over;
    always @(posedge clk_i) begin
        if (rst_i) begin
            {inside, made_line, made_frame, over, behind, damaged} <= 0;
            {column, line} <= 0;
        end else begin
            // Words that are left out: after a line that was too long, up to its end or the next start.
            if (over && has && (has_eol || has_sof)) over <= 0;
            if (begins) {inside, behind, damaged} <= 3'b100;
            if (!inside && !over && has && !has_sof) behind <= 0;
            if (!inside && skips) behind <= 0;
            if (cuts && !over) begin
                damaged <= 1;
                if (column == 0) made_frame <= 1;
                else made_line <= 1;
            end
            if (passes) begin
                before[column] <= out;
                last           <= takes_word ? out[LANES-1] : last;
                column         <= ends_line ? 0 : column + 1;
                if (ends_line) line <= line == LINES - 1 ? 0 : line + 1;
                if (takes_word && has_eol && !ends_line) {made_line, damaged} <= 2'b11;
                if (takes_word && !has_eol && ends_line) {over, damaged} <= 2'b11;
                if (ends_line) made_line <= 0;
                if (ends_frame) {inside, made_frame, behind} <= 3'b001;
            end
        end
    end

    // Events come one clock later.
    reg was_cut, was_short, was_long, was_behind, was_repair, was_held;
    reg [LANES:0] was_word;
    always @(posedge clk_i) begin
        was_cut    <= !rst_i && cuts && !over;
        was_short  <= !rst_i && takes_word && has_eol && !ends_line;
        was_long   <= !rst_i && takes_word && !has_eol && ends_line;
        was_behind <= !rst_i && !inside && !over && has && !has_sof && behind;
        was_repair <= !rst_i && !damaged && ((cuts && !over) || (takes_word && has_eol != ends_line));
        was_held   <= !rst_i && word && !ready;
        was_word   <= {first, out};
    end

    // No frame waits for ever: while the array takes words, a filled-in word passes at every clock.
    always @* if (started) begin
        assert(column < WORDS && line < LINES);
        assert(begins == (!inside && !over && has && has_sof && admit));
        assert(skips == (!inside && !over && has && has_sof && !admit && late));
        assert(idle == (!inside && !over));
        if (word) assert(inside && first == at_start);
        if (inside && (made_line || made_frame) && !over) assert(word);
        if (inside && !made_line && !made_frame && !over) assert(word == (has && !cuts));
        if (over) assert(!word);
        if (word && !made_line && !made_frame) assert(out == has_pixels);
        if (word && made_line) assert(out == {LANES{last}});
        if (word && !made_line && made_frame) assert(out == before[column]);
        if (was_held) assert(word && {first, out} == was_word);
        // A word is processed when it passes or is left out.
        if (has && inside && !over) assert(taken == takes_word);
        if (has && over) assert(taken == !has_sof);
        if (has && !inside && !over) assert(taken == (!has_sof || skips));
        if (!has) assert(taken);
        assert(sof_early == was_cut && eol_early == was_short && eol_late == was_long);
        assert(sof_late == was_behind && repair == was_repair);
    end
endmodule
