// SPDX-License-Identifier: MIT OR Apache-2.0
// Registers the controls of the sequencer for a group of lanes, so that no net reaches all lanes. Every group has registers
// of its own, which synthesis must keep.
//
// Controls for the address come in the clock of the address, those for the word read in the clock of the word (WORD clocks
// later), and those for the accumulator in its clock (LATE clocks later).
`default_nettype none

(* keep_hierarchy = "yes" *)
module serial_group #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter ADDRESS_BITS = 7,  // bits of an address in the memory of a lane
    parameter WORD = 0,          // clocks from an address to its word
    parameter LATE = 0,          // clocks from an address to the accumulator
    parameter RASTER = 0,        // 1: one pixel for all lanes; 0: one pixel per lane
    parameter GROUP = 0,         // number of this group; with RASTER a group has 64 lanes
    parameter LANE_BITS = 10,    // bits of the number of a lane, at least 1
    parameter ACC_BITS = 11,     // bits of the accumulator
    parameter COPIES = 0,        // not 0: lanes copy the region to its reference
    parameter BORDERS = 0,       // 1: sides on the frame's border are repeated
    parameter FILTER = 1,        // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter EDGE = 1,          // 1: the design has the feature `edge`
    parameter CORNER = 0,        // 1: the design has the feature `corner`
    parameter MAD = 0,           // 1: the design has the feature `mad`
    parameter VARIANCE = 0,      // 1: the design has the feature `variance`
    parameter RANGE = 0,         // 1: the design has the feature `range`
    parameter SURFACE = 0,       // 1: the design has the feature `surface`
    parameter SEGMENT = 0,       // 1: the design has the feature `segment`
    parameter FLOW = 0,          // 1: the design has the feature `flow`
    parameter SUMMARIES = 0,     // 1: irrelevant regions send the means of their blocks
    parameter ZONES = 0          // 1: regions have classes
) (
    input  wire                    clk_i,           // clock, rising edge
    input  wire                    rst_i,           // synchronous reset, active high
    // Loading of a frame.
    input  wire                    open_i,          // `parallel`: pixels can be taken after this edge
    input  wire                    valid_i,         // `parallel`: a pixel is offered
    input  wire                    take_i,          // `raster`: a pixel is taken
    input  wire [       WIDTH-1:0] pixel_i,         // `raster`: that pixel
    input  wire                    place_i,         // `raster`: that pixel is written to lane_i
    input  wire [   LANE_BITS-1:0] lane_i,          // `raster`: number of that lane
    // Address.
    input  wire [ADDRESS_BITS-1:0] address_i,       // address in the memory of a lane
    input  wire                    write_i,         // the accumulator is written to this address
    // Controls of the lanes.
    input  wire [    ACC_BITS-1:0] constant_i,      // the constant
    input  wire [            38:0] controls_i,      // the control word, see serial_controls
    input  wire [    ACC_BITS-1:0] keen_constant_i, // the constant of keen regions (ZONES)
    input  wire                    classing_i,      // classes move on by one lane (ZONES)
    // Outputs to the lanes: those of loading, then the inputs above, registered.
    output wire                    loading_o,       // pixels come from outside
    output wire [       WIDTH-1:0] pixel_o,         // the pixel that was taken last
    output wire [             7:0] rows_o,          // one bit per row of 8 lanes: it has the selected lane 8 * row + column
    output wire [             7:0] columns_o,       // one bit per column of 8 lanes: it has the selected lane
    output wire [ADDRESS_BITS-1:0] address_o,       // address_i, or the address of the next pixel
    output wire                    write_o,         // write_i, or a pixel comes in
    output wire [    ACC_BITS-1:0] constant_o,      // constant_i, in the clock of its use
    output wire [            38:0] controls_o,      // controls_i, each control in the clock of its use
    output wire [    ACC_BITS-1:0] keen_constant_o, // keen_constant_i, in the clock of its use (ZONES)
    output wire                    classing_o       // classing_i, in the clock in which scores move on (ZONES)
);

    generate
        if (LANE_BITS < 1) begin : g_lane_bits LANE_BITS_must_be_1_or_more u_refused (); end
    endgenerate

    // The initial value keeps synthesis from moving this register into the address port of the memory.
    reg [ADDRESS_BITS-1:0] address_q = {ADDRESS_BITS{1'b0}};
    reg loading_q;
    reg write_q;

    assign address_o = address_q;
    assign loading_o = loading_q;

    always @(posedge clk_i) begin
        if (rst_i) write_q <= 1'b0;
        else write_q <= write_i;
    end

    generate
        if (RASTER != 0) begin : g_raster
            localparam [LANE_BITS+5:0] OWN = GROUP;
            wire [LANE_BITS+5:0] lane = {6'd0, lane_i};
            wire own = place_i && lane >> 6 == OWN;
            wire unused_parallel = open_i || valid_i;
            reg [WIDTH-1:0] pixel_q;
            reg [7:0] rows_q;
            reg [7:0] columns_q;

            assign pixel_o   = pixel_q;
            assign rows_o    = rows_q;
            assign columns_o = columns_q;
            assign write_o   = write_q;

            always @(posedge clk_i) begin
                address_q <= address_i;
                loading_q <= place_i;
                columns_q <= 8'd1 << lane[2:0];
                if (take_i) pixel_q <= pixel_i;
                if (rst_i || !own) rows_q <= 8'd0;
                else rows_q <= 8'd1 << lane[5:3];
            end
        end else begin : g_parallel
            wire unused_raster = take_i || place_i || |lane_i;

            assign pixel_o   = pixel_i;
            assign rows_o    = 8'd0;
            assign columns_o = 8'd0;
            assign write_o   = write_q || (loading_q && valid_i);

            // While a frame enters, the address waits for its pixel.
            always @(posedge clk_i) begin
                if (rst_i) address_q <= {ADDRESS_BITS{1'b0}};
                else if (!loading_q || valid_i) address_q <= address_i;
                loading_q <= open_i;
            end
        end
    endgenerate

    // The designs that use each control, in the order of the control word.
    localparam [0:0] SPANS = SURFACE != 0 || FLOW != 0;
    localparam [0:0] SUMS = MAD != 0 || VARIANCE != 0 || RANGE != 0 || SPANS || SEGMENT != 0;
    localparam [0:0] SEARCHES = FILTER == 1 || FILTER == 2;
    localparam [0:0] RUNS = SEARCHES || EDGE != 0 || CORNER != 0;
    localparam [0:0] MEANS = SUMMARIES != 0;
    localparam [0:0] RETURNS = SUMMARIES != 0 && RASTER == 0;
    localparam [5:0] WITH_ADDRESS = {
        COPIES != 0, {3{BORDERS != 0}}, RETURNS, FILTER == 3
    };  // write_active, write_border, side, write_mean, write_high
    localparam [4:0] WITH_WORD = {
        1'b1, MAD != 0 || RANGE != 0, VARIANCE != 0, VARIANCE != 0 || (RANGE != 0 && MAD != 0), SPANS
    };  // from_memory, deviate, masked, from_aux, hold
    localparam [27:0] WITH_ACCUMULATOR = {
        RANGE != 0, 2'b11, SEARCHES || SEGMENT != 0, 3'b111,  // larger, subtract, by_sign, by_run, carry, enable, clear
        RUNS, CORNER != 0, RUNS, 1'b1, CORNER != 0, SEGMENT != 0,  // run, run_corner, run_clear, count, count_corner, count_side
        SPANS, SEGMENT != 0, SEGMENT != 0, SURFACE != 0,  // recall_sum, recall_mean, ceiling, shrink
        {2{FLOW != 0}},                                   // least, note
        {2{FILTER == 2}},                                 // probe, choose
        MAD != 0 || VARIANCE != 0 || RANGE != 0, SUMS, 1'b1, SUMS || MEANS,  // twice, divide, shift, keep
        RASTER != 0, RASTER == 0, RETURNS                 // fetch, unload, unload_mean
    };

    // The three parts of the control word. Its lowest bit is unload_mean.
    serial_control #(.WIDTH(6), .USED(WITH_ADDRESS)) u_with_address (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(controls_i[38:33]), .bits_o(controls_o[38:33])
    );
    serial_control #(.WIDTH(5), .USED(WITH_WORD), .LATE(WORD)) u_with_word (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(controls_i[32:28]), .bits_o(controls_o[32:28])
    );
    serial_control #(.WIDTH(ACC_BITS), .USED({ACC_BITS{1'b1}}), .LATE(WORD)) u_constant (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(constant_i), .bits_o(constant_o)
    );
    serial_control #(.WIDTH(28), .USED(WITH_ACCUMULATOR), .LATE(LATE)) u_with_accumulator (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(controls_i[27:0]), .bits_o(controls_o[27:0])
    );

    generate
        if (ZONES) begin : g_zones
            serial_control #(.WIDTH(ACC_BITS), .USED({ACC_BITS{1'b1}}), .LATE(WORD)) u_keen_constant (
                .clk_i(clk_i), .rst_i(rst_i), .bits_i(keen_constant_i), .bits_o(keen_constant_o)
            );
            serial_control #(.WIDTH(1), .USED(1'b1), .LATE(LATE)) u_classing (
                .clk_i(clk_i), .rst_i(rst_i), .bits_i(classing_i), .bits_o(classing_o)
            );
        end else begin : g_no_zones
            wire unused_zones = |keen_constant_i || classing_i;
            assign keen_constant_o = {ACC_BITS{1'b0}};
            assign classing_o = 1'b0;
        end
    endgenerate

endmodule

`default_nettype wire
