// SPDX-License-Identifier: MIT OR Apache-2.0
// Turns the pixels of a sensor with a DVP interface into AXI4-Stream video (docs/boards.md): it cleans vsync and href, finds the
// pixels, crops the frame, and passes the pixels to another clock.
//
// A pixel is held until the next pixel of its line comes or the line ends, so that the last pixel of a line, however short,
// carries EOL. While the queue is full the held pixel stays, and incoming pixels are lost. So a line that loses pixels still has
// its end, and a frame its start.
`default_nettype none

module dvp_capture #(
    parameter BUS_BITS = 8,     // data lines, 8 or 4
    parameter FORMAT = 0,       // a pixel is: 0 each byte, 1 the first, 2 the second of two bytes, 3 two nibbles, high first, 4 low first
    parameter VSYNC_HIGH = 1,   // level of vsync between frames
    parameter LEFT = 0,         // pixels of a line that are left out at its start
    parameter TOP = 0,          // lines of a frame that are left out at its start
    parameter COLUMNS = 128,    // pixels of a line that are taken after these, at least 2
    parameter LINES = 96,       // lines of a frame that are taken after these, at least 2
    parameter COLUMN_BITS = 7,  // ceil(log2(LEFT + COLUMNS))
    parameter LINE_BITS = 7     // ceil(log2(TOP + LINES))
) (
    input  wire                pclk_i,   // clock of the sensor, rising edge; it may stand still
    input  wire                vsync_i,  // vsync of the sensor: VSYNC_HIGH between two frames
    input  wire                href_i,   // href of the sensor: 1 within a line
    input  wire [BUS_BITS-1:0] data_i,   // a byte or nibble of a pixel
    input  wire                clk_i,    // clock of the video, rising edge
    input  wire                rst_i,    // synchronous reset in the clock of the video, active high
    output wire                valid_o,  // a pixel is on pixel_o
    output wire [         7:0] pixel_o,  // the pixel
    output wire                sof_o,    // the pixel is the first of a frame
    output wire                eol_o,    // the pixel is the last of a line
    input  wire                ready_i,  // the sink takes the pixel
    output reg                 lost_o    // a pixel was lost because the queue was full; one clock per pixel
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (FORMAT < 0 || FORMAT > 4) begin : g_format FORMAT_must_be_0_to_4 u_refused (); end
        if (BUS_BITS != (FORMAT > 2 ? 4 : 8)) begin : g_bus_bits BUS_BITS_must_be_8_or_with_FORMAT_3_and_4_be_4 u_refused (); end
        if (VSYNC_HIGH != 0 && VSYNC_HIGH != 1) begin : g_vsync_high VSYNC_HIGH_must_be_0_or_1 u_refused (); end
        if (LEFT < 0 || TOP < 0) begin : g_crop LEFT_and_TOP_must_be_0_or_more u_refused (); end
        if (COLUMNS < 2) begin : g_columns COLUMNS_must_be_2_or_more u_refused (); end
        if (LINES < 2) begin : g_lines LINES_must_be_2_or_more u_refused (); end
        if (COLUMN_BITS != $clog2(LEFT + COLUMNS)) begin : g_column_bits
            COLUMN_BITS_must_be_clog2_of_LEFT_plus_COLUMNS u_refused ();
        end
        if (LINE_BITS != $clog2(TOP + LINES)) begin : g_line_bits LINE_BITS_must_be_clog2_of_TOP_plus_LINES u_refused (); end
    endgenerate

    // The last three samples. A level that only the middle sample has is ignored; the data of that sample is used.
    reg [2:0] href_q, vsync_q;
    reg [BUS_BITS-1:0] next_q, data_q;
    initial href_q = 3'd0;
    initial vsync_q = 3'd0;
    always @(posedge pclk_i) begin
        href_q  <= {href_q[1:0], href_i};
        vsync_q <= {vsync_q[1:0], VSYNC_HIGH ? vsync_i : !vsync_i};
        next_q  <= data_i;
        data_q  <= next_q;
    end
    wire href = (href_q[0] && href_q[1]) || (href_q[0] && href_q[2]) || (href_q[1] && href_q[2]);
    wire between = (vsync_q[0] && vsync_q[1]) || (vsync_q[0] && vsync_q[2]) || (vsync_q[1] && vsync_q[2]);

    // A line. The rest of a line after vsync is left out.
    reg stale_q;  // vsync has come during this line
    reg line_q;   // the sample before was in a line
    initial stale_q = 1'b0;
    initial line_q = 1'b0;
    wire line = href && !between && !stale_q;
    always @(posedge pclk_i) begin
        stale_q <= href && (between || stale_q);
        line_q  <= line;
    end

    // The samples that complete a pixel, and the pixel.
    wire edge_with_pixel;
    wire [7:0] pixel;
    generate
        if (FORMAT == 0) begin : g_whole
            assign edge_with_pixel = 1'b1;
            assign pixel = data_q;
        end else begin : g_parts
            reg second_q;  // the next sample is the second part of a pixel
            initial second_q = 1'b0;
            always @(posedge pclk_i) second_q <= line && !second_q;
            assign edge_with_pixel = FORMAT == 1 ? !second_q : second_q;
            if (FORMAT < 3) begin : g_bytes
                assign pixel = data_q;
            end else begin : g_nibbles
                reg [3:0] first_q;
                always @(posedge pclk_i) first_q <= data_q;
                assign pixel = FORMAT == 3 ? {first_q, data_q} : {data_q, first_q};
            end
        end
    endgenerate

    // The place of the pixel, negative before the first one that is taken. No pixel is taken after the last place or before
    // the first vsync.
    localparam FIRST_COLUMN = -LEFT;
    localparam LAST_COLUMN = COLUMNS - 1;
    localparam FIRST_LINE = -TOP;
    localparam LAST_LINE = LINES - 1;
    reg [COLUMN_BITS:0] column_q;
    reg [LINE_BITS:0] row_q;
    reg columns_done_q, lines_done_q;
    initial begin
        column_q       = FIRST_COLUMN[COLUMN_BITS:0];
        row_q          = FIRST_LINE[LINE_BITS:0];
        columns_done_q = 1'b0;
        lines_done_q   = 1'b1;
    end
    wire last_column = column_q == LAST_COLUMN[COLUMN_BITS:0];
    wire comes = line && edge_with_pixel && !column_q[COLUMN_BITS] && !columns_done_q && !row_q[LINE_BITS] && !lines_done_q;
    always @(posedge pclk_i) begin
        if (edge_with_pixel) begin
            column_q <= column_q + 1'b1;
            if (last_column) columns_done_q <= 1'b1;
        end
        if (!line) begin
            column_q       <= FIRST_COLUMN[COLUMN_BITS:0];
            columns_done_q <= 1'b0;
        end
        if (line_q && !line) begin
            row_q <= row_q + 1'b1;
            if (row_q == LAST_LINE[LINE_BITS:0]) lines_done_q <= 1'b1;
        end
        if (between) begin
            row_q        <= FIRST_LINE[LINE_BITS:0];
            lines_done_q <= 1'b0;
        end
    end

    // The held pixel.
    reg held_q, held_sof_q, held_eol_q;
    reg first_q;  // the next held pixel is the first of its frame
    reg [7:0] held_pixel_q;
    wire full;
    wire keep = comes && !(held_q && full);
    wire push = held_q && (held_eol_q || !line || comes);
    initial held_q = 1'b0;
    initial first_q = 1'b0;
    always @(posedge pclk_i) begin
        if (push && !full) held_q <= 1'b0;
        if (!line) held_eol_q <= 1'b1;
        if (keep) begin
            held_q       <= 1'b1;
            held_pixel_q <= pixel;
            held_sof_q   <= first_q;
            held_eol_q   <= last_column;
        end
        first_q <= between || (first_q && !keep);
    end

    clock_crossing #(.WIDTH(10), .DEPTH_BITS(4)) u_queue (
        .write_clk_i(pclk_i), .write_i(push), .data_i({held_eol_q || !line, held_sof_q, held_pixel_q}), .full_o(full),
        .read_clk_i(clk_i), .rst_i(rst_i), .valid_o(valid_o), .data_o({eol_o, sof_o, pixel_o}), .take_i(ready_i)
    );

    // The number of lost pixels, in Gray code. The side of the video follows it by one per clock.
    reg [2:0] losses_q, losses_gray_q, told_q;
    (* ASYNC_REG = "TRUE" *) reg [2:0] losses_first_q, losses_seen_q;
    initial losses_q = 3'd0;
    initial losses_gray_q = 3'd0;
    wire [2:0] losses = losses_q + {2'd0, comes && !keep};
    always @(posedge pclk_i) begin
        losses_q      <= losses;
        losses_gray_q <= losses ^ losses >> 1;
    end
    wire [2:0] seen = {losses_seen_q[2], ^losses_seen_q[2:1], ^losses_seen_q};
    wire more = seen != told_q;
    always @(posedge clk_i) begin
        losses_first_q <= losses_gray_q;
        losses_seen_q  <= losses_first_q;
        told_q         <= told_q + {2'd0, more};
        lost_o         <= more;
        if (rst_i) begin
            told_q <= seen;
            lost_o <= 1'b0;
        end
    end

endmodule

`default_nettype wire
