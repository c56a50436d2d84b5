// SPDX-License-Identifier: MIT OR Apache-2.0
// The controls of the sequencer, registered for a group of lanes, so that no net reaches all of them. Every
// group has registers of its own, which synthesis is to keep.
//
// This is the table of all controls: what each is for, and which designs use it. Those that go with the
// address come in its clock, those that work on the word read come in the word's clock, and those that work
// on the accumulator come in its clock.
`default_nettype none

(* keep_hierarchy = "yes" *)
module serial_group #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter ADDRESS_BITS = 7,  // of an address in the memory of a lane
    parameter WORD = 0,          // clocks from an address to the word in hand
    parameter LATE = 0,          // ... to the accumulator
    parameter RASTER = 0,        // 1: one pixel for all lanes; 0: one for each
    parameter GROUP = 0,         // number of this group; with RASTER groups have 64 lanes
    parameter LANE_BITS = 10,    // of the number of a lane, at least 1
    parameter ACC_BITS = 11,     // of the accumulator
    parameter COPIES = 0,        // 1: an active lane copies the region to its reference
    parameter BORDERS = 0,       // 1: sides on the frame's border are repeated
    parameter MEDIAN = 1,        // 1: pixels are denoised
    parameter EDGE = 1,          // 1: the design has the feature `edge`
    parameter CORNER = 0,        // ... `corner`
    parameter MAD = 0,           // ... `mad`
    parameter VARIANCE = 0       // ... `variance`
) (
    input  wire                    clk_i,           // clock, rising edge
    input  wire                    rst_i,           // synchronous reset, active high
    // Loading.
    input  wire                    open_i,          // `parallel`: pixels can be taken after this edge
    input  wire                    valid_i,         // `parallel`: a pixel comes in
    input  wire                    take_i,          // `raster`: a pixel is taken
    input  wire [       WIDTH-1:0] pixel_i,         // `raster`: that pixel
    input  wire                    place_i,         // `raster`: it is to be written to a lane
    input  wire [   LANE_BITS-1:0] lane_i,          // ... to this one
    // With the address.
    input  wire [ADDRESS_BITS-1:0] address_i,       // in the memory of a lane
    input  wire                    write_i,         // write the accumulator there
    input  wire                    write_active_i,  // write if the first flag is set
    input  wire                    write_border_i,  // write if the side is on the frame's border
    input  wire [             1:0] side_i,          // left, right, top, bottom
    // With the word read, or with the accumulator.
    input  wire [    ACC_BITS-1:0] constant_i,      // the operand, unless from_memory
    input  wire                    from_memory_i,   // the operand is the word read
    input  wire                    subtract_i,      // invert the operand
    input  wire                    by_sign_i,       // invert it if the accumulator is not negative
    input  wire                    by_run_i,        // invert it if five were counted
    input  wire                    carry_i,         // add one to an inverted operand
    input  wire                    enable_i,        // the accumulator takes the sum
    input  wire                    clear_i,         // the accumulator becomes 0
    input  wire                    run_i,           // count in unary
    input  wire                    run_corner_i,    // ... equal ones in a row
    input  wire                    run_clear_i,     // the unary count becomes 0
    input  wire                    count_i,         // score a hit
    input  wire                    count_corner_i,  // ... of `corner`
    input  wire                    double_i,        // the operand is the accumulator itself
    input  wire                    divide_i,        // keep the sum only if it is not negative
    input  wire                    deviate_i,       // the operand is |2^FRACTION * word - aux|
    input  wire                    masked_i,        // do not add it unless its bit under the constant is 1
    input  wire                    from_aux_i,      // the operand is aux
    input  wire                    shift_i,         // scores move on by one lane
    input  wire                    keep_i,          // the score becomes the accumulator
    input  wire                    fetch_i,         // the score becomes the word read
    input  wire                    unload_i,        // the word read leaves if its region is active
    // To the lanes: loading, the rest as above.
    output wire                    loading_o,       // pixels come from outside
    output wire [       WIDTH-1:0] pixel_o,         // the pixel taken last
    output wire [             7:0] rows_o,          // lane 8 * row + column of the group is selected: its row
    output wire [             7:0] columns_o,       // ... its column
    output wire [ADDRESS_BITS-1:0] address_o,       // address_i, or of the next pixel
    output wire                    write_o,         // write_i, or a pixel that comes in
    output wire                    write_active_o,  // write_active_i, registered
    output wire                    write_border_o,  // write_border_i, registered
    output wire [             1:0] side_o,          // side_i, registered
    output wire [    ACC_BITS-1:0] constant_o,      // constant_i, registered
    output wire                    from_memory_o,   // from_memory_i, registered
    output wire                    subtract_o,      // subtract_i, registered
    output wire                    by_sign_o,       // by_sign_i, registered
    output wire                    by_run_o,        // by_run_i, registered
    output wire                    carry_o,         // carry_i, registered
    output wire                    enable_o,        // enable_i, registered
    output wire                    clear_o,         // clear_i, registered
    output wire                    run_o,           // run_i, registered
    output wire                    run_corner_o,    // run_corner_i, registered
    output wire                    run_clear_o,     // run_clear_i, registered
    output wire                    count_o,         // count_i, registered
    output wire                    count_corner_o,  // count_corner_i, registered
    output wire                    double_o,        // double_i, registered
    output wire                    divide_o,        // divide_i, registered
    output wire                    deviate_o,       // deviate_i, registered
    output wire                    masked_o,        // masked_i, registered
    output wire                    from_aux_o,      // from_aux_i, registered
    output wire                    shift_o,         // shift_i, registered
    output wire                    keep_o,          // keep_i, registered
    output wire                    fetch_o,         // fetch_i, registered
    output wire                    unload_o         // unload_i, registered
);

    generate
        if (LANE_BITS < 1) begin : g_lane_bits LANE_BITS_must_be_1_or_more u_refused (); end
    endgenerate

    // The initial value keeps synthesis from moving this register into the memory's address port.
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

    // Which designs use a control, if not all.
    localparam SUMS = MAD != 0 || VARIANCE != 0;
    localparam RUNS = MEDIAN != 0 || EDGE != 0 || CORNER != 0;

    // With the address.
    serial_control #(.USED(COPIES)) u_write_active (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(write_active_i), .bits_o(write_active_o)
    );
    serial_control #(.USED(BORDERS)) u_write_border (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(write_border_i), .bits_o(write_border_o)
    );
    serial_control #(.WIDTH(2), .USED(BORDERS)) u_side (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(side_i), .bits_o(side_o)
    );

    // With the word read.
    serial_control #(.WIDTH(ACC_BITS), .LATE(WORD)) u_constant (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(constant_i), .bits_o(constant_o)
    );
    serial_control #(.LATE(WORD)) u_from_memory (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(from_memory_i), .bits_o(from_memory_o)
    );
    serial_control #(.USED(MAD), .LATE(WORD)) u_deviate (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(deviate_i), .bits_o(deviate_o)
    );
    serial_control #(.USED(VARIANCE), .LATE(WORD)) u_masked (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(masked_i), .bits_o(masked_o)
    );
    serial_control #(.USED(VARIANCE), .LATE(WORD)) u_from_aux (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(from_aux_i), .bits_o(from_aux_o)
    );

    // With the accumulator.
    serial_control #(.LATE(LATE)) u_subtract (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(subtract_i), .bits_o(subtract_o)
    );
    serial_control #(.LATE(LATE)) u_by_sign (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(by_sign_i), .bits_o(by_sign_o)
    );
    serial_control #(.USED(MEDIAN), .LATE(LATE)) u_by_run (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(by_run_i), .bits_o(by_run_o)
    );
    serial_control #(.LATE(LATE)) u_carry (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(carry_i), .bits_o(carry_o)
    );
    serial_control #(.LATE(LATE)) u_enable (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(enable_i), .bits_o(enable_o)
    );
    serial_control #(.LATE(LATE)) u_clear (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(clear_i), .bits_o(clear_o)
    );
    serial_control #(.USED(RUNS), .LATE(LATE)) u_run (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(run_i), .bits_o(run_o)
    );
    serial_control #(.USED(CORNER), .LATE(LATE)) u_run_corner (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(run_corner_i), .bits_o(run_corner_o)
    );
    serial_control #(.USED(RUNS), .LATE(LATE)) u_run_clear (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(run_clear_i), .bits_o(run_clear_o)
    );
    serial_control #(.LATE(LATE)) u_count (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(count_i), .bits_o(count_o)
    );
    serial_control #(.USED(CORNER), .LATE(LATE)) u_count_corner (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(count_corner_i), .bits_o(count_corner_o)
    );
    serial_control #(.USED(SUMS), .LATE(LATE)) u_double (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(double_i), .bits_o(double_o)
    );
    serial_control #(.USED(SUMS), .LATE(LATE)) u_divide (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(divide_i), .bits_o(divide_o)
    );
    serial_control #(.LATE(LATE)) u_shift (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(shift_i), .bits_o(shift_o)
    );
    serial_control #(.USED(SUMS), .LATE(LATE)) u_keep (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(keep_i), .bits_o(keep_o)
    );
    serial_control #(.USED(RASTER), .LATE(LATE)) u_fetch (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(fetch_i), .bits_o(fetch_o)
    );
    serial_control #(.USED(RASTER == 0), .LATE(LATE)) u_unload (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(unload_i), .bits_o(unload_o)
    );

endmodule

`default_nettype wire
