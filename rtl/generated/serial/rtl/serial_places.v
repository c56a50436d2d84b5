// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the places of a pixel in one direction: a place in its own region, then in the halo of a neighboring region, or in
// the halo that repeats the pixel at the frame's border. Combinational.
`default_nettype none

module serial_places #(
    parameter SIDE = 8,      // pixels of a side of a region, at least 2 * HALO
    parameter HALO = 1,      // pixels around a region, 1 or 2
    parameter SCALE = 1,     // address distance of neighboring pixels in this direction
    parameter WORD_BITS = 7  // bits of an address inside a slot
) (
    input  wire [$clog2(SIDE)-1:0] inner_i,   // position of the pixel in its region
    input  wire                    first_i,   // no region is before this one
    input  wire                    last_i,    // no region is after this one
    input  wire [             1:0] place_i,   // number of the place; 0 is the place in the own region
    output wire [             1:0] more_o,    // number of places besides that in the own region
    output wire                    before_o,  // this place is in the region before
    output wire                    after_o,   // this place is in the region after
    output wire [   WORD_BITS-1:0] offset_o   // address distance from the pixel's word without a halo
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (HALO < 1 || HALO > 2) begin : g_halo HALO_must_be_1_or_2 u_refused (); end
        if (SIDE < 2 * HALO) begin : g_side SIDE_must_be_twice_HALO_or_more u_refused (); end
        if (SCALE < 1) begin : g_scale SCALE_must_be_1_or_more u_refused (); end
    endgenerate

    localparam INNER_BITS = $clog2(SIDE);
    /* verilator lint_off WIDTH */
    localparam [INNER_BITS-1:0] NEAR = HALO;
    localparam [INNER_BITS-1:0] FAR = SIDE - HALO;
    localparam [INNER_BITS-1:0] LAST = SIDE - 1;
    localparam [WORD_BITS-1:0] OWN = HALO * SCALE;
    localparam [WORD_BITS-1:0] REGION = SIDE * SCALE;
    localparam [WORD_BITS-1:0] ONE = SCALE;
    localparam [1:0] REPEATED = HALO;
    /* verilator lint_on WIDTH */

    wire near_first = inner_i < NEAR;
    wire near_last = inner_i >= FAR;
    wire repeats_first = first_i && inner_i == {INNER_BITS{1'b0}};
    wire repeats_last = last_i && inner_i == LAST;
    wire other = place_i != 2'd0;

    assign more_o = (repeats_first || repeats_last) ? REPEATED
        : {1'b0, (near_first && !first_i) || (near_last && !last_i)};
    assign before_o = other && near_first && !first_i;
    assign after_o = other && near_last && !last_i;

    reg [WORD_BITS-1:0] offset;
    always @* begin
        offset = OWN;
        if (before_o) offset = OWN + REGION;
        else if (after_o) offset = OWN - REGION;
        else if (other && repeats_first) offset = place_i == 2'd1 ? {WORD_BITS{1'b0}} : ONE;
        else if (other && repeats_last) offset = place_i == 2'd1 ? OWN + ONE : OWN + ONE + ONE;
    end
    assign offset_o = offset;

endmodule

`default_nettype wire
