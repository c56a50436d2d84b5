// SPDX-License-Identifier: MIT OR Apache-2.0
// Takes a frame row by row, and computes the place of each pixel: lane, slot and address. If neighborhoods are shared, a
// pixel has several places, one per clock, in both directions: its own region, the halos of the neighbors that show it, and
// the halos that repeat it at the frame's border. ready_o is 0 meanwhile.
`default_nettype none

module serial_raster_feed #(
    parameter SIDE = 8,       // pixels of a side of a region, 4 to 64
    parameter HALO = 0,       // pixels of the halo around a region
    parameter COLUMNS = 28,   // regions in a row of regions
    parameter ROWS = 28,      // rows of regions
    parameter FOLD = 1,       // regions of a lane
    parameter WORD_BITS = 7,  // bits of an address inside a slot
    parameter SLOT_BITS = 1,  // bits of the number of a slot, at least 1
    parameter LANE_BITS = 10  // bits of the number of a lane, at least 1
) (
    input  wire                 clk_i,     // clock, rising edge
    input  wire                 rst_i,     // synchronous reset, active high
    input  wire                 valid_i,   // a pixel is offered
    input  wire                 reopen_i,  // the frame before is done
    output wire                 ready_o,   // an offered pixel is taken
    output wire                 take_o,    // a pixel is taken
    output wire                 place_o,   // the pixel is written to the place below
    output wire                 last_o,    // this is the last place of the last pixel
    output wire [LANE_BITS-1:0] lane_o,    // lane of the place
    output wire [SLOT_BITS-1:0] slot_o,    // slot of the place
    output wire [WORD_BITS-1:0] word_o     // address of the place inside the slot
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
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
    localparam [WORD_BITS-1:0] SEGMENT = SIDE - 1;                // address distance back to the start of a row of a region
    localparam [WORD_BITS-1:0] NEXT_LINE = STRIDE - (SIDE - 1);
    /* verilator lint_on WIDTH */

    reg ready_q;
    reg [INNER_BITS-1:0] x_q;  // column of the pixel in its region
    reg [INNER_BITS-1:0] y_q;
    reg [COLUMN_BITS-1:0] column_q;  // column of the pixel's region
    reg [ROW_BITS-1:0] row_q;
    reg [WORD_BITS-1:0] word_q;  // y_q * STRIDE + x_q
    reg [LANE_BITS-1:0] lane_q;
    reg [SLOT_BITS-1:0] slot_q;
    reg [LANE_BITS-1:0] row_lane_q;  // lane of the first region of the row of regions
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
            reg [1:0] across_q;  // number of the place in its row of places
            reg [1:0] down_q;    // number of that row of places
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
