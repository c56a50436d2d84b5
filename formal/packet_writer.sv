// SPDX-License-Identifier: MIT OR Apache-2.0
// The packets by docs/packets.md, and the rules of AXI4-Stream on their port. Waiting items stay until they are taken, as proven of
// packet_frames, packet_rows and packet_regions; their content is free. CHECK: 0 the rules of the port, lengths, order and times;
// 1 the content of packets, of which an arbitrary bit of an arbitrary word is followed, with a sink that takes a word at every clock.
module properties #(
    parameter BITS = 16, PART_BITS = 5, ROW_WORDS = 1, PIXEL_WORDS = 2, MEAN_WORDS = 1, RAW = 1, CHECK = 0
) (
    input wire clk_i, rst_i, ready, begins, any_first, any_closed, any_row_valid, any_row_frame, any_region_valid, any_region_frame,
    any_summary, input wire [63:0] any_time, input wire [31:0] rate, any_number, input wire [3:0] any_dropped,
    input wire [2:0] any_dropped_rows, input wire [1:0] any_row, any_region_row, any_column,
    input wire any_row_value, any_region_value, input wire [BITS-1:0] any_part, input wire [15:0] any_version
);
    `include "reset.vh"
    localparam PARTS = 64 / BITS, ROWS = 2, COLUMNS = 3, LONGEST = 7;
    localparam [63:0] FINGERPRINT = 64'h0123456789ABCDEF;
    localparam [2:0] FRAME = 1, ROW = 2, REGION = 4, END = 5;
    wire opened, ended, idle, row_take, region_take, read, valid, last;
    wire [PART_BITS-1:0] part;
    wire [63:0] data;

    // The word and its bit that are followed. The head is word 0, so the parts after it are counted from word 1 on.
    (* anyconst *) reg [2:0] place;
    (* anyconst *) reg [5:0] bit_place;
    wire [2:0] body_place = place - 1;
    wire [5:0] followed = BITS == 16 ? {body_place, bit_place[5:4]} : {body_place, bit_place[5]};
    wire [BITS-1:0] bit_mask = 1 << (BITS == 16 ? bit_place[3:0] : bit_place[4:0]);

    // The waiting frame.
    reg announced, open, front, first, frame, closed;
    reg [63:0] time_q;
    reg [15:0] version;
    reg [31:0] number, rate_q;
    reg [3:0] dropped, sent;
    reg [2:0] dropped_rows;
    // The waiting row and the waiting region, whose parts are read.
    reg row_valid, row_frame, region_valid, region_frame, summary;
    reg [1:0] row, region_row, column;
    reg row_value, region_value;
    reg [BITS-1:0] row_part, region_part;
    wire row_fits = row_valid && row_frame == frame;
    wire region_fits = region_valid && region_frame == frame;

    packet_writer #(
        .BITS(BITS), .PART_BITS(PART_BITS), .ROW_WORDS(ROW_WORDS), .PIXEL_WORDS(PIXEL_WORDS), .MEAN_WORDS(MEAN_WORDS), .REGION_BITS(3),
        .COLUMN_BITS(2), .ROW_BITS(2), .COLUMNS(COLUMNS), .ROWS(ROWS), .FRAME_WIDTH(4660), .FRAME_HEIGHT(22136), .SIDE(10), .WIDTH(12),
        .MEANS_SIDE(3), .IRRELEVANT(2), .RAW(RAW), .FINGERPRINT(FINGERPRINT)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .announced_i(announced), .first_i(first), .time_i(time_q), .rate_i(rate_q), .number_i(number),
        .map_version_i(version), .frame_i(frame), .closed_i(closed), .dropped_i(dropped), .dropped_rows_i(dropped_rows), .opened_o(opened), .ended_o(ended),
        .idle_o(idle), .row_valid_i(row_valid), .row_frame_i(row_frame), .row_i(row), .row_part_i(row_part), .row_take_o(row_take),
        .region_valid_i(region_valid), .region_frame_i(region_frame), .region_summary_i(summary), .region_row_i(region_row),
        .region_column_i(column), .region_part_i(region_part), .region_take_o(region_take), .read_o(read), .part_o(part),
        .data_o(data), .valid_o(valid), .last_o(last), .ready_i(ready)
    );

    always @* begin
        assume(!begins || !announced);
        // No more items of a closed frame come.
        assume(!closed || row_fits || !any_row_valid || any_row_frame != frame || ended);
        assume(!closed || region_fits || !any_region_valid || any_region_frame != frame || ended);
        assume(!region_take || sent < 8);
        assume(MEAN_WORDS != 0 || !any_summary);
    end
    always @(posedge clk_i) begin
        // The rate is a constant of the core.
        if (!started) rate_q <= rate;
        if (opened) {announced, open} <= 2'b01;
        if (begins) {announced, first, time_q, version} <= {1'b1, any_first, any_time, any_version};
        if (ended) open <= 0;
        front <= announced && !open && !opened;
        if (announced && !open && !front) number <= any_number;
        if (ended) frame <= !frame;
        if (!closed || ended) {closed, dropped, dropped_rows} <= {any_closed, any_dropped, any_dropped_rows};
        if (region_take) sent <= sent + 1;
        if (opened) sent <= 0;
        if (!row_valid || row_take) {row_valid, row_frame, row, row_value} <= {any_row_valid, any_row_frame, any_row, any_row_value};
        if (!region_valid || region_take) begin
            {region_valid, region_frame, summary} <= {any_region_valid, any_region_frame, any_summary};
            {region_row, column, region_value}    <= {any_region_row, any_column, any_region_value};
        end
        if (read) begin
            row_part    <= part != followed ? any_part : row_value ? any_part | bit_mask : any_part & ~bit_mask;
            region_part <= part != followed ? any_part : region_value ? any_part | bit_mask : any_part & ~bit_mask;
        end
        if (rst_i) {announced, open, front, frame, closed, row_valid, region_valid, sent} <= 0;
    end

    // The packet that the writer has finished, until its last word has left: its length, and the value of its followed part.
    wire done = opened || ended || row_take || region_take;
    wire [2:0] type = opened ? FRAME : ended ? END : row_take ? ROW : REGION;
    wire means = region_take && summary;
    wire [15:0] length = 2 + (opened ? 5 : ended ? 1 : row_take ? ROW_WORDS : means ? MEAN_WORDS : PIXEL_WORDS);
    wire [3:0] flags = {1'b0, means, region_take && RAW != 0, opened ? first : ended && (dropped != 0 || dropped_rows != 0)};
    wire [15:0] row_field = opened ? 1 : ended ? dropped_rows : row_take ? row : region_row;
    wire [15:0] column_field = row_take ? COLUMNS : region_take ? column : opened ? version : 0;
    reg [63:0] word;
    always @* begin
        word = {28'd0, dropped, 28'd0, sent};
        if (opened) case (place)
            1: word = {8'h0A, "ETAEVOF"};
            2: word = FINGERPRINT;
            3: word = time_q;
            4: word = {16'd22136, 16'd4660, rate_q};
            5: word = {16'd2, 16'd3, 3'd0, RAW != 0, 4'd2, 8'd3, 8'd12, 8'd10};
        endcase
        if (place == 0) word = {column_field, row_field, length, flags, 1'b0, type, 8'hFA};
        if (place == length - 1) word = number;
    end
    wire in_body = place != 0 && place != length - 1;
    wire its_bit = row_take && in_body ? row_value : region_take && in_body ? region_value : word[bit_place];
    reg waits;
    reg [2:0] expected_words;
    reg is_checked, expected;
    wire leaves = valid && ready;
    always @(posedge clk_i) begin
        if (leaves && last) waits <= 0;
        if (done) begin
            waits          <= 1;
            expected_words <= length;
            // The upper half of the tail is the CRC.
            is_checked     <= place < length && (place != length - 1 || bit_place < 32);
            expected       <= its_bit;
        end
        if (rst_i) waits <= 0;
    end

    // The words that leave.
    reg [2:0] words;
    reg seen;
    wire now_seen = words == place ? data[bit_place] : seen;
    reg held, held_last;
    reg [63:0] held_data;
    always @(posedge clk_i) begin
        if (leaves) begin
            words <= last ? 0 : words + 1;
            seen  <= now_seen;
        end
        held <= !rst_i && valid && !ready;
        {held_last, held_data} <= {last, data};
        if (rst_i) words <= 0;
    end

    // Clocks without a word on the port although an item waits or is under way. A source does not wait for `ready`.
    wire offers = open ? row_fits || region_fits || closed : announced;
    reg [4:0] quiet, offered;
    always @(posedge clk_i) begin
        quiet   <= (offers || !idle) && !valid ? quiet + 1 : 0;
        // In the last clocks of this number, an item was there to be sent and the sink did not delay it.
        offered <= !offers ? 0 : offered == 31 || (valid && !ready) ? offered : offered + 1;
        if (rst_i) {quiet, offered} <= 0;
    end

    generate
        if (CHECK == 0) begin : g_rules
            always @* if (started) begin
                // The rules of AXI4-Stream, and whole packets.
                if (held) assert(valid && last == held_last && data == held_data);
                assert(words < LONGEST);
                if (valid && last) assert(waits && words + 1 == expected_words);
                // One packet at a time, of the waiting items, and in the order of docs/packets.md.
                if (done) assert(!waits || (leaves && last));
                assert(opened + ended + row_take + region_take <= 1);
                if (opened) assert(announced && !open);
                if (ended) assert(open && closed && !row_fits && !region_fits);
                if (row_take) assert(open && row_fits);
                if (region_take) assert(open && region_fits);
                // The time: a word takes a clock per part, one more before a packet, and three from a waiting item to the port.
                assert(quiet <= PARTS + 3);
                if (offered >= 2 * PARTS + 4) assert(quiet <= PARTS);
                if (words != 0) assert(quiet <= PARTS - 1);
                if (idle) assert(!valid && words == 0 && !waits);
            end
        end else if (CHECK == 1) begin : g_contents
            always @* if (started) begin
                assume(ready && !rst_i);
                if (valid && last && waits && is_checked) assert(now_seen == expected);
            end
        end
    endgenerate
endmodule
