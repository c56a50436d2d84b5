// SPDX-License-Identifier: MIT OR Apache-2.0
// The reference is the region as it was last active, and is valid from then on until a blanking SRS = 0. It is read with a
// pixel and used one clock later, when the pixel is counted; the decision of the frame before is known then.
module properties #(parameter BLANKS = 1, parameter SIDE = 2) (
    input wire clk_i, rst_i, step, srs, trs, pixel
);
    `include "reset.vh"
    localparam PIXELS = SIDE * SIDE;
    localparam ADDRESS_BITS = $clog2(PIXELS);
    (* anyconst *) wire [ADDRESS_BITS-1:0] watched;
    always @* assume(watched < PIXELS);
    wire read_last, read_done, last, done;
    wire [15:0] read_place, read_seen, place, seen;
    frames #(.PIXELS(PIXELS)) u_read (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(read_last), .done_o(read_done), .place_o(read_place),
        .seen_o(read_seen)
    );
    reg count, pixel_q;
    frames #(.PIXELS(PIXELS)) u_counted (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(count), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );
    // The decision of the frame before, as module `decision` holds it.
    reg active_q;
    wire forward = done ? srs && trs : active_q;
    always @(posedge clk_i) begin
        active_q <= !rst_i && forward;
        count    <= !rst_i && step;
        pixel_q  <= pixel;
    end
    wire read, valid;
    deep_last_sent #(.WIDTH(1), .PIXELS(PIXELS), .ADDRESS_BITS(ADDRESS_BITS), .BLANKS(BLANKS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .address_i(read_place[ADDRESS_BITS-1:0]), .pixel_i(pixel), .sent_o(read),
        .step_i(count), .decided_i(done), .srs_i(srs), .forward_i(forward), .valid_o(valid)
    );
    reg reference;
    always @(posedge clk_i) reference <= read;
    // The values by the contract.
    reg sent, known, usable;
    wire usable_now = done && srs && trs ? 1'b1 : done && !srs && BLANKS != 0 ? 1'b0 : usable;
    always @(posedge clk_i) begin
        usable <= !rst_i && usable_now;
        if (rst_i) known <= 1'b0;
        else if (count && place == watched && forward) begin
            sent  <= pixel_q;
            known <= 1'b1;
        end
    end
    always @* if (started) begin
        assert(valid == usable_now);
        if (count && place == watched && !forward) begin
            if (known) assert(reference == sent);
            if (valid) assert(known);
        end
    end
endmodule
