// SPDX-License-Identifier: MIT OR Apache-2.0
// What the sequencer says, registered for a group of lanes, so that no net reaches all of them. Every
// group has registers of its own, which synthesis is to keep.
`default_nettype none

(* keep_hierarchy = "yes" *)
module serial_group #(
    parameter WIDTH = 8,             // bits of a pixel
    parameter ADDRESS_BITS = 7,
    parameter BLOCK = 0,             // 1: a word comes a clock after its address
    parameter RASTER = 0,
    parameter GROUP = 0,             // number of this group of 64 lanes
    parameter LANE_BITS = 10,        // of the number of a lane
    parameter ACCESS_BITS = 1,
    parameter [ACCESS_BITS-1:0] ACCESS_USED = 1'b1,
    parameter EXECUTE_BITS = 1,
    parameter [EXECUTE_BITS-1:0] EXECUTE_USED = 1'b1
) (
    input  wire                    clk_i,
    input  wire                    rst_i,
    // Loading.
    input  wire                    open_i,     // `parallel`: pixels can be taken after this edge
    input  wire                    valid_i,
    input  wire                    take_i,     // `raster`: a pixel is taken
    input  wire [       WIDTH-1:0] pixel_i,
    input  wire                    place_i,    // `raster`: it is to be written to a lane
    input  wire [   LANE_BITS-1:0] lane_i,
    // Working.
    input  wire [ADDRESS_BITS-1:0] address_i,
    input  wire                    write_i,
    input  wire [ ACCESS_BITS-1:0] access_i,   // what goes with the address
    input  wire [EXECUTE_BITS-1:0] execute_i,  // what works on the word read
    // To the lanes.
    output wire                    loading_o,
    output wire [       WIDTH-1:0] pixel_o,
    output wire [             7:0] rows_o,     // lane 8 * row + column of the group is selected
    output wire [             7:0] columns_o,
    output wire [ADDRESS_BITS-1:0] address_o,
    output wire                    write_o,
    output wire [ ACCESS_BITS-1:0] access_o,
    output wire [EXECUTE_BITS-1:0] execute_o
);

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

    serial_registers #(.WIDTH(ACCESS_BITS), .USED(ACCESS_USED)) u_access (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(access_i), .bits_o(access_o)
    );

    wire [EXECUTE_BITS-1:0] execute;
    serial_registers #(.WIDTH(EXECUTE_BITS), .USED(EXECUTE_USED)) u_execute (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i(execute_i), .bits_o(execute)
    );

    generate
        if (BLOCK != 0) begin : g_late
            serial_registers #(.WIDTH(EXECUTE_BITS), .USED(EXECUTE_USED)) u_late (
                .clk_i(clk_i), .rst_i(rst_i), .bits_i(execute), .bits_o(execute_o)
            );
        end else begin : g_at_once
            assign execute_o = execute;
        end
    endgenerate

endmodule

`default_nettype wire
