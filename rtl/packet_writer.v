// SPDX-License-Identifier: MIT OR Apache-2.0
// Writes packets (docs/packets.md): chooses the next one, and puts its words together from parts of BITS bits, one per
// clock. A word is on data_o from a register, so that no combinational path connects the stream with its source.
`default_nettype none

module packet_writer #(
    parameter BITS = 16,                  // bits of a part: 16 or 32, a quarter or half of a word
    parameter PART_BITS = 6,              // bits of the number of a part of a packet's payload
    parameter ROW_WORDS = 8,              // words of the payload of a ROW packet
    parameter PIXEL_WORDS = 8,            // words of the payload of a REGION packet with pixels
    parameter MEAN_WORDS = 0,             // words of the payload of a REGION packet with means; 0: the design has no summaries
    parameter REGION_BITS = 15,           // bits of the number of a region
    parameter COLUMN_BITS = 8,            // bits of the number of a column of regions
    parameter ROW_BITS = 8,               // bits of the number of a row of regions
    parameter COLUMNS = 240,              // regions in a row of regions
    parameter ROWS = 135,                 // rows of regions
    parameter FRAME_WIDTH = 1920,         // pixels of a row of the frame
    parameter FRAME_HEIGHT = 1080,        // rows of the frame
    parameter SIDE = 8,                   // rows of a region
    parameter WIDTH = 8,                  // bits of a pixel
    parameter MEANS_SIDE = 0,             // means in a row of a summary; 0: the design has no summaries
    parameter IRRELEVANT = 0,             // what an irrelevant region shows: 0 zero, 1 hold, 2 mean
    parameter RAW = 0,                    // 1: raw pixels are sent; 0: denoised ones
    parameter [63:0] FINGERPRINT = 64'd0  // fingerprint of the design
) (
    input  wire                   clk_i,               // clock, rising edge
    input  wire                   rst_i,               // synchronous reset, active high
    input  wire                   announced_i,         // the FRAME packet of a frame waits
    input  wire                   first_i,             // this frame is the first since reset
    input  wire [           63:0] time_i,              // time at which this frame began, in ticks
    input  wire [           31:0] rate_i,              // number of ticks per second
    input  wire [           31:0] number_i,            // number of this frame
    input  wire [           15:0] map_version_i,       // version of its map of classes; 0 without zones
    input  wire                   frame_i,             // lowest bit of its number since reset
    input  wire                   closed_i,            // all decisions of this frame are made, and none of its regions is under way
    input  wire [  REGION_BITS:0] dropped_i,           // number of its regions that were dropped
    input  wire [     ROW_BITS:0] dropped_rows_i,      // number of its rows that were dropped
    output wire                   opened_o,            // the FRAME packet has left
    output wire                   ended_o,             // the END packet has left
    output wire                   idle_o,              // no packet is under way
    input  wire                   row_valid_i,         // decisions of a row wait
    input  wire                   row_frame_i,         // lowest bit of the number since reset of that row's frame
    input  wire [   ROW_BITS-1:0] row_i,               // number of that row
    input  wire [       BITS-1:0] row_part_i,          // the part of that row that was read
    output wire                   row_take_o,          // all parts of that row have been read
    input  wire                   region_valid_i,      // a whole region waits
    input  wire                   region_frame_i,      // lowest bit of the number since reset of that region's frame
    input  wire                   region_summary_i,    // that region is a summary
    input  wire [   ROW_BITS-1:0] region_row_i,        // row of that region
    input  wire [COLUMN_BITS-1:0] region_column_i,     // column of that region
    input  wire [       BITS-1:0] region_part_i,       // the part of that region that was read
    output wire                   region_take_o,       // all parts of that region have been read
    output wire                   read_o,              // a part of the waiting row and region is read at this edge
    output wire [  PART_BITS-1:0] part_o,              // number of the part that is read
    output wire [           63:0] data_o,              // a word of a packet
    output wire                   valid_o,             // a word is on data_o
    output wire                   last_o,              // the word is the last of its packet
    input  wire                   ready_i              // the sink takes the word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (BITS != 16 && BITS != 32) begin : g_bits BITS_must_be_16_or_32 u_refused (); end
        if (PART_BITS < 3 + $clog2(64 / BITS) || PART_BITS > 16)
            begin : g_part_bits PART_BITS_must_be_5_or_with_BITS_32_4_to_16 u_refused (); end
        // Each part of a payload has a number. This limit also keeps the length of the packet within its field in the head.
        if (ROW_WORDS < 1 || ROW_WORDS > (1 << PART_BITS) / (64 / BITS))
            begin : g_row_words ROW_WORDS_must_be_1_or_more_and_have_parts_of_PART_BITS u_refused (); end
        if (PIXEL_WORDS < 1 || PIXEL_WORDS > (1 << PART_BITS) / (64 / BITS))
            begin : g_pixel_words PIXEL_WORDS_must_be_1_or_more_and_have_parts_of_PART_BITS u_refused (); end
        if (MEAN_WORDS < 0 || MEAN_WORDS > (1 << PART_BITS) / (64 / BITS))
            begin : g_mean_words MEAN_WORDS_must_be_0_or_more_and_have_parts_of_PART_BITS u_refused (); end
        if (REGION_BITS < 1 || REGION_BITS > 30) begin : g_region_bits REGION_BITS_must_be_1_to_30 u_refused (); end
        if (COLUMN_BITS < 1 || COLUMN_BITS > 15) begin : g_column_bits COLUMN_BITS_must_be_1_to_15 u_refused (); end
        if (ROW_BITS < 1 || ROW_BITS > 14) begin : g_row_bits ROW_BITS_must_be_1_to_14 u_refused (); end
        if (COLUMNS < 1 || COLUMNS > 65535) begin : g_columns COLUMNS_must_be_1_to_65535 u_refused (); end
        if (ROWS < 1 || ROWS > 65535) begin : g_rows ROWS_must_be_1_to_65535 u_refused (); end
        if (FRAME_WIDTH < 1 || FRAME_WIDTH > 65535) begin : g_frame_width FRAME_WIDTH_must_be_1_to_65535 u_refused (); end
        if (FRAME_HEIGHT < 1 || FRAME_HEIGHT > 65535) begin : g_frame_height FRAME_HEIGHT_must_be_1_to_65535 u_refused (); end
        if (SIDE < 1 || SIDE > 255) begin : g_side SIDE_must_be_1_to_255 u_refused (); end
        if (WIDTH < 1 || WIDTH > 255) begin : g_width WIDTH_must_be_1_to_255 u_refused (); end
        if (MEANS_SIDE < 0 || MEANS_SIDE > 255) begin : g_means_side MEANS_SIDE_must_be_0_to_255 u_refused (); end
        if (IRRELEVANT < 0 || IRRELEVANT > 2) begin : g_irrelevant IRRELEVANT_must_be_0_to_2 u_refused (); end
    endgenerate

    localparam PARTS = 64 / BITS;
    localparam IN_WORD_BITS = $clog2(PARTS);
    localparam [63:0] MAGIC = {8'h0A, "ETAEVOF"};  // the magic number, in the order of bytes
    localparam [1:0] IDLE = 2'd0, HEAD = 2'd1, BODY = 2'd2, TAIL = 2'd3;
    localparam [3:0] FRAME = 4'd1, ROW = 4'd2, REGION = 4'd4, END = 4'd5;
    localparam [3:0] MEANS = 4'd0;  // a REGION with means; this value is used in this module only
    localparam [63:0] FRAME_5 = {  // FRAME_5, frame_4 and end_1 are words with the numbers of docs/packets.md
        ROWS[15:0], COLUMNS[15:0], 3'd0, RAW != 0, IRRELEVANT[3:0], MEANS_SIDE[7:0], WIDTH[7:0], SIDE[7:0]
    };

    wire step = !valid_o || ready_i;  // everything behind the register of the stream moves on

    // The packet that is under way, and its part. FRAME opens a frame and END closes it.
    reg [1:0] phase_q;
    reg [3:0] kind_q;
    reg [PART_BITS-1:0] part_q;
    reg open_q;
    reg [REGION_BITS:0] sent_q;
    wire [IN_WORD_BITS-1:0] in_word = part_q[IN_WORD_BITS-1:0];
    localparam BITS_LOG = $clog2(BITS);
    wire [IN_WORD_BITS+BITS_LOG-1:0] in_bits = {in_word, {BITS_LOG{1'b0}}};  // the first bit of the part in its word
    wire word_end = &in_word;
    wire row_fits = row_valid_i && row_frame_i == frame_i;
    wire region_fits = region_valid_i && region_frame_i == frame_i;

    reg [15:0] body_words;
    always @* begin
        case (kind_q)
            FRAME: body_words = 16'd5;
            ROW: body_words = ROW_WORDS[15:0];
            REGION: body_words = PIXEL_WORDS[15:0];
            MEANS: body_words = MEAN_WORDS[15:0];
            default: body_words = 16'd1;
        endcase
    end
    wire [15:0] words = body_words + 16'd2;
    wire [15:0] body_parts = body_words << IN_WORD_BITS;
    wire [PART_BITS-1:0] body_last = body_parts[PART_BITS-1:0] - 1'b1;
    wire unused_parts = |body_parts;
    wire body_end = phase_q == BODY && part_q == body_last;
    wire packet_end = phase_q == TAIL && word_end;
    wire is_region = kind_q == REGION || kind_q == MEANS;

    assign read_o = step;
    assign part_o = part_q;
    assign row_take_o = step && body_end && kind_q == ROW;
    assign region_take_o = step && body_end && is_region;
    assign opened_o = step && packet_end && kind_q == FRAME;
    assign ended_o = step && packet_end && kind_q == END;

    always @(posedge clk_i) begin
        if (step) begin
            part_q <= part_q + 1'b1;
            case (phase_q)
                IDLE: begin
                    part_q <= {PART_BITS{1'b0}};
                    if (open_q ? row_fits || region_fits || closed_i : announced_i) phase_q <= HEAD;
                    kind_q <= !open_q ? FRAME : row_fits ? ROW : !region_fits ? END : MEAN_WORDS != 0 && region_summary_i ? MEANS : REGION;
                end
                HEAD: if (word_end) begin
                    phase_q <= BODY;
                    part_q  <= {PART_BITS{1'b0}};
                end
                BODY: if (body_end) begin
                    phase_q <= TAIL;
                    part_q  <= {PART_BITS{1'b0}};
                end
                default: if (word_end) phase_q <= IDLE;
            endcase
        end
        if (opened_o) open_q <= 1'b1;
        if (region_take_o) sent_q <= sent_q + 1'b1;
        if (ended_o) begin
            open_q <= 1'b0;
            sent_q <= {(REGION_BITS + 1) {1'b0}};
        end
        if (rst_i) begin
            phase_q <= IDLE;
            open_q  <= 1'b0;
            sent_q  <= {(REGION_BITS + 1) {1'b0}};
        end
    end

    // The value of the part, if it is not read from a memory.
    wire any_dropped = dropped_i != {(REGION_BITS + 1) {1'b0}} || dropped_rows_i != {(ROW_BITS + 1) {1'b0}};
    wire flag_0 = kind_q == FRAME ? first_i : kind_q == END && any_dropped;
    wire [3:0] flags = {1'b0, kind_q == MEANS, is_region && RAW != 0, flag_0};
    wire [15:0] row = kind_q == FRAME ? 16'd1
                    : kind_q == ROW ? {{(16 - ROW_BITS) {1'b0}}, row_i}
                    : kind_q == END ? {{(15 - ROW_BITS) {1'b0}}, dropped_rows_i} : {{(16 - ROW_BITS) {1'b0}}, region_row_i};
    wire [15:0] column = kind_q == ROW ? COLUMNS[15:0] : is_region ? {{(16 - COLUMN_BITS) {1'b0}}, region_column_i}
                       : kind_q == FRAME ? map_version_i : 16'd0;
    wire [63:0] head = {column, row, words, flags, is_region ? REGION : kind_q, 8'hFA};
    wire [63:0] end_1 = {{(31 - REGION_BITS) {1'b0}}, dropped_i, {(31 - REGION_BITS) {1'b0}}, sent_q};
    wire [63:0] frame_4 = {FRAME_HEIGHT[15:0], FRAME_WIDTH[15:0], rate_i};
    wire [63:0] tail = {32'd0, number_i};
    wire [2:0] word = part_q[IN_WORD_BITS+:3];  // number of the word in the payload, from 0: one less than in docs/packets.md
    reg [BITS-1:0] other;
    always @* begin
        other = end_1[in_bits+:BITS];
        if (kind_q == FRAME)
            case (word)
                3'd0: other = MAGIC[in_bits+:BITS];
                3'd1: other = FINGERPRINT[in_bits+:BITS];
                3'd2: other = time_i[in_bits+:BITS];
                3'd3: other = frame_4[in_bits+:BITS];
                default: other = FRAME_5[in_bits+:BITS];
            endcase
        if (phase_q == HEAD) other = head[in_bits+:BITS];
        if (phase_q == TAIL) other = tail[in_bits+:BITS];
    end

    // The part that was read is there one clock later, and one clock after that it is selected.
    localparam [1:0] OTHER = 2'd0, OF_ROW = 2'd1, OF_REGION = 2'd2;
    reg [BITS-1:0] other_q, chosen_q;
    reg [1:0] source_q;
    reg read_valid_q, read_word_q, read_crc_q, read_last_q;
    reg valid_q, word_q, crc_part_q, last_q;
    reg read_high_q, high_q;  // 1: the upper half of the CRC, if it takes two parts
    always @(posedge clk_i) begin
        if (step) begin
            other_q        <= other;
            source_q       <= phase_q != BODY ? OTHER : kind_q == ROW ? OF_ROW : is_region ? OF_REGION : OTHER;
            read_valid_q   <= phase_q != IDLE;
            read_word_q    <= word_end;
            read_high_q    <= in_word[0];
            read_crc_q     <= phase_q == TAIL && in_word[IN_WORD_BITS-1];
            read_last_q    <= packet_end;
            chosen_q       <= source_q == OF_ROW ? row_part_i : source_q == OF_REGION ? region_part_i : other_q;
            valid_q        <= read_valid_q;
            word_q         <= read_word_q;
            high_q         <= read_high_q;
            crc_part_q     <= read_crc_q;
            last_q         <= read_last_q;
        end
        if (rst_i) begin
            read_valid_q <= 1'b0;
            valid_q      <= 1'b0;
        end
    end

    // The CRC, and the word on the port.
    reg [31:0] crc_q;
    wire [31:0] crc;
    packet_crc #(.BITS(BITS)) u_crc (.crc_i(crc_q), .data_i(chosen_q), .crc_o(crc));
    wire [31:0] inverted = ~crc_q;
    wire [BITS-1:0] shown = !crc_part_q ? chosen_q : high_q ? inverted[31-:BITS] : inverted[BITS-1:0];

    reg [63:0] data_q;
    reg data_valid_q, data_last_q;
    always @(posedge clk_i) begin
        if (step) begin
            data_valid_q <= valid_q && word_q;
            if (valid_q) begin
                data_q      <= {shown, data_q[63:BITS]};
                data_last_q <= last_q;
                if (!crc_part_q) crc_q <= crc;
                if (last_q) crc_q <= 32'hFFFFFFFF;
            end
        end
        if (rst_i) begin
            data_valid_q <= 1'b0;
            crc_q        <= 32'hFFFFFFFF;
        end
    end

    assign idle_o = phase_q == IDLE && !read_valid_q && !valid_q && !data_valid_q;
    assign data_o = data_q;
    assign valid_o = data_valid_q;
    assign last_o = data_last_q;

endmodule

`default_nettype wire
