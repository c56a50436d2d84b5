// SPDX-License-Identifier: MIT OR Apache-2.0
// Follows the frames that are under way, and what each of them has still to send. At most two are under way: one whose
// packets leave, and one that is taken. The FRAME packet of the second waits for the END packet of the first. Outputs depend
// on registers alone, so they show an event after the edge at which its input is 1.
`default_nettype none

module packet_frames #(
    parameter PENDING_BITS = 10,  // bits of the number of regions of a frame that wait to leave
    parameter REGION_BITS = 15,   // bits of the number of a region
    parameter ROW_BITS = 8        // bits of the number of a row of regions
) (
    input  wire                 clk_i,            // clock, rising edge
    input  wire                 rst_i,            // synchronous reset, active high
    input  wire                 forget_i,         // resets as rst_i does, but frames are counted on
    input  wire [         63:0] time_i,           // the present time, in ticks
    input  wire                 begin_i,          // a frame begins
    input  wire                 skip_i,           // a frame is offered and skipped
    input  wire                 decided_frame_i,  // lowest bit of the number since reset of the frame that is decided
    input  wire                 decided_last_i,   // the last region of that frame is decided at this edge
    input  wire                 sends_i,          // a region of that frame that sends something is decided at this edge
    input  wire                 row_dropped_i,    // a row of that frame is dropped at this edge
    input  wire                 whole_i,          // all of a region has come
    input  wire                 whole_frame_i,    // lowest bit of the number since reset of that region's frame
    input  wire                 lost_i,           // a region was lost
    input  wire                 lost_frame_i,     // lowest bit of the number since reset of the lost region's frame
    input  wire                 opened_i,         // the FRAME packet has left
    input  wire                 ended_i,          // the END packet has left
    output wire                 admit_o,          // a frame may begin
    output wire                 behind_o,         // the FRAME packet of a decided frame has not left, so that no frame may begin soon
    output wire                 busy_o,           // a frame is under way
    output wire                 announced_o,      // a FRAME packet waits, or leaves
    output wire                 first_o,          // the next FRAME packet is the first since reset
    output wire [         63:0] time_o,           // time at which the announced frame began
    output wire [         31:0] number_o,         // number of the announced frame; after its FRAME, of the frame that leaves
    output wire [         31:0] frames_o,         // number of frames that were offered
    output wire                 frame_o,          // lowest bit of the number since reset of the frame that leaves
    output wire                 closed_o,         // all decisions of that frame are made, and none of its regions is under way
    output wire [REGION_BITS:0] dropped_o,        // number of its regions that were lost
    output wire [   ROW_BITS:0] dropped_rows_o    // number of its rows that were dropped
);

    reg announced_q, open_q, deciding_q, first_q, frame_q;
    reg [1:0] decided_q;  // one bit per frame: all of its regions are decided
    reg [63:0] time_q;
    reg [31:0] count_q, announced_number_q, number_q;
    reg [2*PENDING_BITS-1:0] pending_q;
    reg [2*REGION_BITS+1:0] dropped_q;
    reg [2*ROW_BITS+1:0] dropped_rows_q;

    always @(posedge clk_i) begin
        if (decided_last_i) begin
            deciding_q                 <= 1'b0;
            decided_q[decided_frame_i] <= 1'b1;
        end
        if (opened_i) begin
            announced_q <= 1'b0;
            open_q      <= 1'b1;
            first_q     <= 1'b0;
        end
        if (ended_i) begin
            open_q             <= 1'b0;
            frame_q            <= !frame_q;
            decided_q[frame_q] <= 1'b0;
        end
        if (begin_i) begin
            announced_q        <= 1'b1;
            deciding_q         <= 1'b1;
            time_q             <= time_i;
            announced_number_q <= count_q;
        end
        if (begin_i || skip_i) count_q <= count_q + 1'b1;
        // No END packet leaves while a FRAME packet does. So this number is that of the frame whose packets leave.
        if (announced_q && !open_q) number_q <= announced_number_q;
        if (rst_i || forget_i) begin
            announced_q <= 1'b0;
            open_q      <= 1'b0;
            deciding_q  <= 1'b0;
            first_q     <= 1'b1;
            frame_q     <= 1'b0;
            decided_q   <= 2'd0;
        end
        if (rst_i) count_q <= 32'd0;
    end

    genvar frame;
    generate
        for (frame = 0; frame < 2; frame = frame + 1) begin : g_frame
            wire sends = sends_i && decided_frame_i == frame;
            wire whole = whole_i && whole_frame_i == frame;
            wire lost = lost_i && lost_frame_i == frame;
            wire [PENDING_BITS-1:0] pending = pending_q[frame*PENDING_BITS+:PENDING_BITS];
            wire [REGION_BITS:0] dropped = dropped_q[frame*(REGION_BITS+1)+:REGION_BITS+1];
            wire [ROW_BITS:0] dropped_rows = dropped_rows_q[frame*(ROW_BITS+1)+:ROW_BITS+1];
            wire clear = rst_i || forget_i || (ended_i && frame_q == frame);
            always @(posedge clk_i) begin
                pending_q[frame*PENDING_BITS+:PENDING_BITS] <=
                    rst_i || forget_i ? {PENDING_BITS{1'b0}} :
                    pending + {{(PENDING_BITS - 1) {1'b0}}, sends} - {{(PENDING_BITS - 1) {1'b0}}, whole} - {{(PENDING_BITS - 1) {1'b0}}, lost};
                if (lost) dropped_q[frame*(REGION_BITS+1)+:REGION_BITS+1] <= dropped + 1'b1;
                if (row_dropped_i && decided_frame_i == frame) dropped_rows_q[frame*(ROW_BITS+1)+:ROW_BITS+1] <= dropped_rows + 1'b1;
                if (clear) begin
                    dropped_q[frame*(REGION_BITS+1)+:REGION_BITS+1] <= {(REGION_BITS + 1) {1'b0}};
                    dropped_rows_q[frame*(ROW_BITS+1)+:ROW_BITS+1]  <= {(ROW_BITS + 1) {1'b0}};
                end
            end
        end
    endgenerate

    assign admit_o = !announced_q && !deciding_q;
    assign behind_o = announced_q && !deciding_q;
    assign busy_o = announced_q || open_q || deciding_q;
    assign announced_o = announced_q;
    assign first_o = first_q;
    assign time_o = time_q;
    assign number_o = number_q;
    assign frames_o = count_q;
    assign frame_o = frame_q;
    wire [PENDING_BITS-1:0] pending_regions = frame_q ? pending_q[PENDING_BITS+:PENDING_BITS] : pending_q[0+:PENDING_BITS];
    assign closed_o = decided_q[frame_q] && pending_regions == {PENDING_BITS{1'b0}};
    assign dropped_o = frame_q ? dropped_q[REGION_BITS+1+:REGION_BITS+1] : dropped_q[0+:REGION_BITS+1];
    assign dropped_rows_o = frame_q ? dropped_rows_q[ROW_BITS+1+:ROW_BITS+1] : dropped_rows_q[0+:ROW_BITS+1];

endmodule

`default_nettype wire
