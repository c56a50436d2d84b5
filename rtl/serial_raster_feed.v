// SPDX-License-Identifier: MIT OR Apache-2.0
// Takes a frame row by row and says where its pixels go: lane, slot and word. Where neighborhoods are
// shared a pixel goes to several places, one per clock: to its own region, and to a neighbor whose
// halo shows it or, at the frame's border, to the halo that repeats it; in both directions.
`default_nettype none

module serial_raster_feed #(
    parameter SIDE = 8,       // pixels of a side of a region, 4 to 64
    parameter HALO = 0,       // pixels around it
    parameter COLUMNS = 28,   // regions side by side
    parameter ROWS = 28,      // regions one below the other
    parameter FOLD = 1,       // regions of a lane
    parameter WORD_BITS = 7,  // of an address inside a slot
    parameter SLOT_BITS = 1,  // at least 1
    parameter LANE_BITS = 10  // at least 1
) (
    input  wire                 clk_i,     // clock, rising edge
    input  wire                 rst_i,     // synchronous reset, active high
    input  wire                 valid_i,   // a pixel comes in
    input  wire                 reopen_i,  // the frame before is done
    output wire                 ready_o,   // a pixel would be taken
    output wire                 take_o,    // a pixel is taken
    output wire                 place_o,   // the pixel goes to the place below
    output wire                 last_o,    // the last place of the last pixel
    output wire [LANE_BITS-1:0] lane_o,    // the place: lane
    output wire [SLOT_BITS-1:0] slot_o,    // ... slot
    output wire [WORD_BITS-1:0] word_o     // ... address inside the slot
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (SIDE < 4 || SIDE > 64) begin : g_side SIDE_must_be_4_to_64 u_refused (); end
        if (HALO < 0 || HALO > 2) begin : g_halo HALO_must_be_0_to_2 u_refused (); end
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (FOLD < 1) begin : g_fold FOLD_must_be_1_or_more u_refused (); end
        if (WORD_BITS < $clog2((SIDE + 2 * HALO) * (SIDE + 2 * HALO))) begin : g_word_bits
            WORD_BITS_must_address_the_square u_refused ();
        end
        if (SLOT_BITS != (FOLD > 1 ? $clog2(FOLD) : 1)) begin : g_slot_bits
            SLOT_BITS_must_number_the_slots u_refused ();
        end
    endgenerate

    localparam STRIDE = SIDE + 2 * HALO;
    localparam INNER_BITS = $clog2(SIDE);
    localparam COLUMN_BITS = COLUMNS > 1 ? $clog2(COLUMNS) : 1;
    localparam ROW_BITS = ROWS > 1 ? $clog2(ROWS) : 1;
    localparam LAST_INNER = SIDE - 1;
    localparam LAST_COLUMN = COLUMNS - 1;
    localparam LAST_ROW = ROWS - 1;
    localparam LAST_SLOT = FOLD - 1;
    /* verilator lint_off WIDTH */
    localparam [WORD_BITS-1:0] SEGMENT = SIDE - 1;                // back to the start of a segment
    localparam [WORD_BITS-1:0] NEXT_LINE = STRIDE - (SIDE - 1);
    /* verilator lint_on WIDTH */

    reg ready_q;
    reg [INNER_BITS-1:0] x_q;  // in the region
    reg [INNER_BITS-1:0] y_q;
    reg [COLUMN_BITS-1:0] column_q;  // of the region
    reg [ROW_BITS-1:0] row_q;
    reg [WORD_BITS-1:0] word_q;  // y_q * STRIDE + x_q
    reg [LANE_BITS-1:0] lane_q;
    reg [SLOT_BITS-1:0] slot_q;
    reg [LANE_BITS-1:0] row_lane_q;  // of the first region of the row
    reg [SLOT_BITS-1:0] row_slot_q;

    wire last_x = x_q == LAST_INNER[INNER_BITS-1:0];
    wire last_y = y_q == LAST_INNER[INNER_BITS-1:0];
    wire last_column = column_q == LAST_COLUMN[COLUMN_BITS-1:0];
    wire last_row = row_q == LAST_ROW[ROW_BITS-1:0];
    wire last_pixel = last_x && last_y && last_column && last_row;
    wire last_place;
    wire moves = place_o && last_place;

    assign ready_o = ready_q;
    assign take_o = ready_q && valid_i;
    assign last_o = moves && last_pixel;

    wire slot_wraps = slot_q == LAST_SLOT[SLOT_BITS-1:0];
    wire [LANE_BITS-1:0] next_lane = lane_q + {{(LANE_BITS - 1) {1'b0}}, slot_wraps};
    wire [SLOT_BITS-1:0] next_slot = slot_wraps ? {SLOT_BITS{1'b0}} : slot_q + 1'b1;

    always @(posedge clk_i) begin
        if (rst_i) begin
            ready_q <= 1'b1;
            x_q <= {INNER_BITS{1'b0}};
            y_q <= {INNER_BITS{1'b0}};
            column_q <= {COLUMN_BITS{1'b0}};
            row_q <= {ROW_BITS{1'b0}};
            word_q <= {WORD_BITS{1'b0}};
            lane_q <= {LANE_BITS{1'b0}};
            slot_q <= {SLOT_BITS{1'b0}};
            row_lane_q <= {LANE_BITS{1'b0}};
            row_slot_q <= {SLOT_BITS{1'b0}};
        end else begin
            if (place_o) ready_q <= last_place && !last_pixel;
            else if (reopen_i) ready_q <= 1'b1;

            if (moves) begin
                x_q <= x_q + 1'b1;
                word_q <= word_q + 1'b1;
                if (last_x) begin
                    x_q <= {INNER_BITS{1'b0}};
                    word_q <= word_q - SEGMENT;
                    lane_q <= next_lane;
                    slot_q <= next_slot;
                    column_q <= column_q + 1'b1;
                    if (last_column) begin
                        column_q <= {COLUMN_BITS{1'b0}};
                        y_q <= y_q + 1'b1;
                        word_q <= word_q + NEXT_LINE;
                        lane_q <= row_lane_q;
                        slot_q <= row_slot_q;
                        if (last_y) begin
                            y_q <= {INNER_BITS{1'b0}};
                            word_q <= {WORD_BITS{1'b0}};
                            row_q <= row_q + 1'b1;
                            lane_q <= next_lane;
                            slot_q <= next_slot;
                            row_lane_q <= next_lane;
                            row_slot_q <= next_slot;
                            if (last_row) begin
                                row_q <= {ROW_BITS{1'b0}};
                                lane_q <= {LANE_BITS{1'b0}};
                                slot_q <= {SLOT_BITS{1'b0}};
                                row_lane_q <= {LANE_BITS{1'b0}};
                                row_slot_q <= {SLOT_BITS{1'b0}};
                            end
                        end
                    end
                end
            end
        end
    end

    generate
        if (HALO == 0) begin : g_one_place
            assign last_place = 1'b1;
            assign place_o = take_o;
            assign lane_o = lane_q;
            assign slot_o = slot_q;
            assign word_o = word_q;
        end else begin : g_places
            reg busy_q;
            reg [1:0] across_q;  // which place in its row
            reg [1:0] down_q;    // which row of places
            wire [1:0] across_more;
            wire [1:0] down_more;
            wire last_across = across_q == across_more;
            wire [WORD_BITS-1:0] across;
            wire [WORD_BITS-1:0] down;
            wire left, right, above, below;

            serial_places #(.SIDE(SIDE), .HALO(HALO), .SCALE(1), .WORD_BITS(WORD_BITS)) u_across (
                .inner_i(x_q), .first_i(column_q == {COLUMN_BITS{1'b0}}), .last_i(last_column),
                .place_i(across_q), .more_o(across_more), .before_o(left), .after_o(right),
                .offset_o(across)
            );

            serial_places #(.SIDE(SIDE), .HALO(HALO), .SCALE(STRIDE), .WORD_BITS(WORD_BITS)) u_down (
                .inner_i(y_q), .first_i(row_q == {ROW_BITS{1'b0}}), .last_i(last_row),
                .place_i(down_q), .more_o(down_more), .before_o(above), .after_o(below),
                .offset_o(down)
            );

            assign last_place = last_across && down_q == down_more;
            assign place_o = take_o || busy_q;
            assign word_o = word_q + across + down;

            always @(posedge clk_i) begin
                if (rst_i) begin
                    busy_q   <= 1'b0;
                    across_q <= 2'd0;
                    down_q   <= 2'd0;
                end else if (place_o) begin
                    busy_q   <= !last_place;
                    across_q <= last_across ? 2'd0 : across_q + 2'd1;
                    if (last_across) down_q <= last_place ? 2'd0 : down_q + 2'd1;
                end
            end

            serial_neighbor #(
                .COLUMNS(COLUMNS), .FOLD(FOLD), .SLOT_BITS(SLOT_BITS), .LANE_BITS(LANE_BITS)
            ) u_neighbor (
                .lane_i(lane_q), .slot_i(slot_q), .left_i(left), .right_i(right), .above_i(above),
                .below_i(below), .lane_o(lane_o), .slot_o(slot_o)
            );
        end
    endgenerate

endmodule

`default_nettype wire
