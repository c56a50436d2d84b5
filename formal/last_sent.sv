// SPDX-License-Identifier: MIT OR Apache-2.0
// The reference is the region as it was last active, and is valid from then on until a blanking SRS = 0.
module properties #(parameter BLANKS = 1, parameter SIDE = 2) (
    input wire clk_i, rst_i, step, srs, trs, pixel
);
    `include "reset.vh"
    localparam PIXELS = SIDE * SIDE;
    localparam ADDRESS_BITS = $clog2(PIXELS);
    (* anyconst *) wire [ADDRESS_BITS-1:0] watched;
    always @* assume(watched < PIXELS);
    wire last, done;
    wire [15:0] place, seen;
    frames #(.PIXELS(PIXELS)) u_frames (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );
    // The decision of the frame before, as module `decision` holds it.
    reg active_q;
    wire forward = done ? srs && trs : active_q;
    always @(posedge clk_i) active_q <= !rst_i && forward;
    wire reference, valid;
    last_sent #(.WIDTH(1), .PIXELS(PIXELS), .ADDRESS_BITS(ADDRESS_BITS), .BLANKS(BLANKS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .address_i(place[ADDRESS_BITS-1:0]), .decided_i(done),
        .srs_i(srs), .forward_i(forward), .pixel_i(pixel), .reference_o(reference), .valid_o(valid)
    );
    // The values by the contract.
    reg sent, known, usable;
    wire usable_now = done && srs && trs ? 1'b1 : done && !srs && BLANKS != 0 ? 1'b0 : usable;
    always @(posedge clk_i) begin
        usable <= !rst_i && usable_now;
        if (rst_i) known <= 1'b0;
        else if (step && place == watched && forward) begin
            sent  <= pixel;
            known <= 1'b1;
        end
    end
    always @* if (started) begin
        assert(valid == usable_now);
        if (step && place == watched) begin
            if (forward) assert(reference == pixel);
            else if (known) assert(reference == sent);
            if (valid && !forward) assert(known);
        end
    end
endmodule
