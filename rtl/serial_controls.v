// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the control word: what the lanes of the serial array do in a step. Combinational.
//
// serial_group knows which designs use which control, and serial_lane takes the word apart. Both use the order of this file:
// controls for the address first, then those for the word read, then those for the accumulator. serial_sequencer and
// serial_array pass the word on.
`default_nettype none

module serial_controls #(
    parameter FILTER = 1,     // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter COPIES = 0,     // not 0: the reference is copied after the last score; 0: it is overwritten pixel by pixel
    parameter RASTER = 0,     // 1: pixels leave through the chain of scores
    parameter KEEPS = 0       // 1: the score can take the accumulator
) (
    input  wire [50:0] step_i,     // the step: one bit for each action, in the order of serial_states
    input  wire [ 3:0] tap_i,      // number of the neighbor that is read
    input  wire [ 1:0] part_i,     // half of a gradient or of a pair of steps, part of a filter or of a ring's step, or side of the border
    input  wire        counts_i,   // the center is a pixel of the region
    input  wire        spent_i,    // the shifted number has no bits left
    output wire [38:0] controls_o  // the control word
);

    // The bits of the step.
    wire loading, draining, rotating, unloading, shifting, denoising, bordering, temporal, copying;
    wire starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing;
    wire gradient, gradient_test, ring, ring_test, ring_last;
    wire summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping, ranging, spreading;
    wire recalling, retrieving, removing, counting, spanning, leveling, below, rounding, shrinking;
    wire matching, lessening, noting;
    wire averaging, returning, storing, showing;
    assign {
        loading, draining, rotating, unloading, shifting,
        denoising, bordering, temporal, copying,
        starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing,
        gradient, gradient_test, ring, ring_test, ring_last,
        summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping, ranging, spreading,
        recalling, retrieving, removing, counting, spanning, leveling, below, rounding, shrinking,
        matching, lessening, noting,
        averaging, returning, storing, showing
    } = step_i;
    wire unused_step = averaging || returning || matching || tap_i[3];

    localparam BLENDS = FILTER == 3;
    wire blends = BLENDS && denoising;                        // windows are summed, and sums are not yet divided by 16
    wire idle = loading || draining;
    wire compares = searching && !adjusting;                  // a neighbor is compared with the candidate
    wire tests = testing || gradient_test || ring_test;       // the accumulator is compared with a level
    wire half_done = gradient_test && !part_i[0];             // the first of two gradients of a pixel is done
    wire scores = (gradient_test && part_i[0]) || (ring_test && ring_last);  // all comparisons of a pixel are done
    wire takes_old = COPIES == 0 && writing && !blends;       // the reference is the word that the median replaces

    // Controls for the address: what is written.
    wire write_active = COPIES != 0 && writing && copying;     // write if the first flag is set, or in every lane
    wire write_border = writing && bordering;                  // write if the side is on the frame's border
    wire [1:0] side = part_i;                                  // number of that side: left, right, top, bottom
    wire write_mean = storing;                                 // write the score instead of the accumulator
    wire write_high = blends && writing;                       // write the accumulator, divided by 16

    // Controls for the word read: the choice of the operand, which is the constant without any of these.
    wire from_memory = !tests && !starting && !adjusting && !halving && !dividing
        && !(blending && &part_i) && !recalling && !retrieving && !leveling && !rounding && !noting;  // the operand is the word
    wire deviate = deviating || (ranging && spreading);        // the operand is |2^FRACTION * word - aux|
    wire masked = squaring || correcting;                      // take the sum only if the bit of the operand under the constant is 1
    wire from_aux = correcting || (ranging && spreading);      // the operand is aux; with deviate: |word - aux|

    wire hold = spanning && !part_i[0];                        // hold the word: the next is read as its distance from it

    // Controls for the accumulator, which takes the sum of itself and the operand.
    wire subtract = compares || writing || relating || dividing || correcting || (ranging && !part_i[0])  // invert the operand
        || removing || counting || below || rounding || probing || (blending && part_i == 2'd0)
        || (gradient && !gradient_test && part_i[0] == tap_i[2]) || (ring && part_i[0]);
    wire larger = ranging;                                     // keep the larger: first compare, then take the operand if it is
    wire by_sign = tests;                                      // invert the operand if the accumulator is not negative
    wire by_run = adjusting || (leveling && !below);           // invert the operand if five were counted, or below is the smaller side
    wire carry = (!(tests && !blends) && !searching && !(probing && !part_i[0]) && !rounding)
        || (adjusting && !spent_i);                            // add one to an inverted operand
    wire enable = starting || adjusting || reading || takes_old || relating || gradient || ring || summing
        || doubling || halving || dividing || deviating || squaring || correcting || (ranging && part_i[0])
        || recalling || retrieving || leveling || (spanning && part_i[0])
        || blending || (choosing && part_i[0]);  // take the sum
    wire probed = probing && part_i[0] && tap_i[2:0] == 3'd7;  // the center has been compared with all neighbors
    wire clear = idle || tests || (writing && (!temporal || blends)) || clearing || keeping
        || probed || (choosing && !part_i[0]);                 // clear the accumulator
    wire probe = probing && part_i[0];                         // note if a neighbor is above, and another one below
    wire choose = choosing;                                    // clear, or take the sum, only where probing found a neighbor above and one below

    // Controls for the counts.
    wire run = compares || half_done || ring_test || (probing && !part_i[0]);  // count in unary
    wire run_corner = ring;                                    // count in unary the hits of equal sign in a row
    wire run_clear = idle || adjusting || scores || probed;    // the unary count becomes 0
    wire count = (testing && counts_i) || scores || counting;  // add a hit to the score
    wire count_corner = ring;                                  // this hit is one of `corner`
    wire count_side = counting;                                // this hit is one of `segment`

    // Controls for `aux` and for the bounds.
    wire recall_sum = retrieving;                              // the next bit is the highest of a sum in `aux`, and not the sign; with least: the highest of the smallest product
    wire recall_mean = recalling;                              // the next bit is the highest of a mean in `aux`, and not the sign
    wire ceiling = leveling || rounding;                       // add one only if the mean has a fraction; with clear: note whether it has one
    wire shrink = shrinking;                                   // clear the accumulator unless it is negative

    // Controls for `flow`.
    wire least = lessening;                                    // the register of the smallest product turns in place of `aux`, and takes the bit of the smaller product
    wire note = noting;                                        // the displacement becomes the operand if it was the best so far

    // Other controls.
    wire twice = doubling;                                     // the operand is the accumulator itself
    wire divide = dividing || recalling || retrieving;         // take the sum only if the next bit of `aux` is 1
    wire shift = rotating || shifting;                         // scores move to the next lane
    wire coded = RASTER != 0 && KEEPS != 0;                    // keep and fetch together have a meaning of their own here: scores move on
    wire keep = keeping || (coded && shift);                   // the score becomes the accumulator
    wire fetch = RASTER != 0 && (unloading || (coded && shift));  // the score becomes the word read
    wire unload = RASTER == 0 && unloading;                    // the word read leaves if its region is active
    wire unload_mean = showing;                                // the word read leaves if its region's summary is sent; the score becomes 0

    assign controls_o = {
        write_active, write_border, side, write_mean, write_high,
        from_memory, deviate, masked, from_aux, hold,
        larger, subtract, by_sign, by_run, carry, enable, clear,
        run, run_corner, run_clear, count, count_corner, count_side,
        recall_sum, recall_mean, ceiling, shrink, least, note, probe, choose,
        twice, divide, shift, keep, fetch, unload, unload_mean
    };

endmodule

`default_nettype wire
