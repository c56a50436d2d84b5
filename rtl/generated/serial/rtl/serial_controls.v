// SPDX-License-Identifier: MIT OR Apache-2.0
// What the lanes of the serial array do in a step: the control word.
//
// serial_group knows which designs use which control, and serial_lane takes the word apart. Both have the order of this
// file: first what goes with the address, then what works on the word read, then what works on the accumulator.
`default_nettype none

module serial_controls #(
    parameter LAST_SENT = 0,  // 1: the reference is `last-sent`, else `previous`
    parameter RASTER = 0,     // 1: pixels leave by the chain of scores
    parameter KEEPS = 0       // 1: the score becomes the accumulator, for `mad`, `variance` or the sum of a block
) (
    input  wire [33:0] step_i,     // what goes on, see serial_states
    input  wire [ 3:0] tap_i,      // number of the neighbor
    input  wire [ 1:0] part_i,     // half of a gradient, part of a ring's step, side of the border
    input  wire        counts_i,   // the center is a pixel of the region
    input  wire        spent_i,    // the number that is shifted is shifted out
    output wire [26:0] controls_o  // the control word
);

    // The step.
    wire loading, draining, rotating, unloading, shifting, denoising, bordering, temporal, copying;
    wire starting, searching, adjusting, reading, writing, relating, testing;
    wire gradient, gradient_test, ring, ring_test, ring_last;
    wire summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping;
    wire averaging, returning, storing, showing;
    assign {
        loading, draining, rotating, unloading, shifting,
        denoising, bordering, temporal, copying,
        starting, searching, adjusting, reading, writing, relating, testing,
        gradient, gradient_test, ring, ring_test, ring_last,
        summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping,
        averaging, returning, storing, showing
    } = step_i;
    wire unused_step = denoising || averaging || returning || |tap_i;

    wire idle = loading || draining;
    wire compares = searching && !adjusting;                  // a neighbor with the candidate
    wire tests = testing || gradient_test || ring_test;       // the accumulator against a level
    wire half_done = gradient_test && !part_i[0];             // one of two gradients of a pixel
    wire scores = (gradient_test && part_i[0]) || (ring_test && ring_last);  // all of a pixel is done
    wire takes_old = LAST_SENT == 0 && writing;               // the reference is the word that the median replaces

    // With the address: write
    wire write_active = LAST_SENT != 0 && writing && copying;  // ... if the first flag is set
    wire write_border = writing && bordering;                  // ... if the side is on the frame's border
    wire [1:0] side = part_i;                                  // ... left, right, top, bottom
    wire write_mean = storing;                                 // ... the score, and not the accumulator

    // With the word read: the operand is the constant, or
    wire from_memory = !tests && !starting && !adjusting && !halving && !dividing;  // ... the word
    wire deviate = deviating;                                  // ... |2^FRACTION * word - aux|
    wire masked = squaring || correcting;                      // ... and is only added if its bit under the constant is 1
    wire from_aux = correcting;                                // ... aux

    // With the accumulator: it takes the sum of itself and the operand.
    wire subtract = compares || writing || relating || dividing || correcting  // invert the operand
        || (gradient && !gradient_test && part_i[0] == tap_i[2]) || (ring && part_i[0]);
    wire by_sign = tests;                                      // ... if the accumulator is not negative
    wire by_run = adjusting;                                   // ... if five were counted
    wire carry = (!tests && !searching) || (adjusting && !spent_i);  // add one to an inverted operand
    wire enable = starting || adjusting || reading || takes_old || relating || gradient || ring || summing
        || doubling || halving || dividing || deviating || squaring || correcting;  // take the sum
    wire clear = idle || tests || (writing && !temporal) || clearing || keeping;    // become 0

    // ... and the counts
    wire run = compares || half_done || ring_test;             // count in unary
    wire run_corner = ring;                                    // ... equal ones in a row
    wire run_clear = idle || adjusting || scores;              // the unary count becomes 0
    wire count = (testing && counts_i) || scores;              // score a hit
    wire count_corner = ring;                                  // ... of `corner`

    // ... and the rest.
    wire twice = doubling;                                     // the operand is the accumulator itself
    wire divide = dividing;                                    // keep the sum only if it is not negative
    wire shift = rotating || shifting;                         // scores move on by one lane
    wire coded = RASTER != 0 && KEEPS != 0;                    // both of the next two: scores move on, too
    wire keep = keeping || (coded && shift);                   // the score becomes the accumulator
    wire fetch = RASTER != 0 && (unloading || (coded && shift));  // ... the word read
    wire unload = RASTER == 0 && unloading;                    // the word read leaves if its region is active
    wire unload_mean = showing;                                // ... if its summary is sent; the score becomes 0

    assign controls_o = {
        write_active, write_border, side, write_mean,
        from_memory, deviate, masked, from_aux,
        subtract, by_sign, by_run, carry, enable, clear,
        run, run_corner, run_clear, count, count_corner,
        twice, divide, shift, keep, fetch, unload, unload_mean
    };

endmodule

`default_nettype wire
