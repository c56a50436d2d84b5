// SPDX-License-Identifier: MIT OR Apache-2.0
// One lane of the serial array: a memory, one accumulator, and a count. All its decisions follow from signs; addresses,
// constants and the order of steps come from the sequencer. docs/serial.md defines each step.
//
// The accumulator is, one after the other, the candidate of the median search, the difference from the reference, half of a
// gradient, and the sum of a region. |acc| > level is tested by adding ~level to a value that is not negative, and level to
// a negative one: the sign stays (`stays`) exactly if it is true.
//
// A median is searched bit by bit. A pixel is below the candidate if acc + ~pixel keeps the sign; five of nine such pixels
// clear the bit. `run_q` counts to five in unary, which takes no logic but its enable. For `edge` its lowest bit says that
// one of the two comparisons of a pixel was a hit; for `corner` it is the length of the run.
//
// For `switching3x3`, the center is compared with its neighbors first: `kept_q` says that one is below and another one above. Two
// steps after the median then act only in such lanes, and take the center. For `binomial3x3`, the accumulator is the sum of the
// window, less 16 times the reference, for the temporal test. It is made again, and written divided by 16.
//
// The range is found with two passes. The first keeps the larger of the accumulator and each word: a step compares them and
// clears the accumulator if the word is larger, and the next step then takes the word. The second pass does the same with the
// distances from the largest word, which is in `aux`.
//
// For `segment`, `aux` is the mean without its fraction. It is added bit by bit to the accumulator, and a level makes a bound of it.
// Each word is then subtracted from the bound, which stays, and the sign says whether the word counts. For `surface`, `aux` is the
// smallest sum so far. It is subtracted in the same way before a sum is made, which is cleared unless it is negative, and added
// again.
//
// For `flow`, a sum of distances from the reference moves to `aux`, and is added again bit by bit, as a product with its weight. From
// its highest bit on, the product moves to `least_q` in place of the smallest one so far, unless that one is smaller. Then the
// displacement is kept, too. At the end `aux` holds the sum of displacement 0. Its product, less the smallest one, is divided by its
// weight, and the quotient comes back from `aux` as the score.
//
// With DEEP the word read is in a register. The operand is, too, before it is inverted, if a feature computes it from the word. A
// hit is counted one clock after it was found, so a score is whole one clock after the last step of its pass.
`default_nettype none

(* keep_hierarchy = "yes" *)
module serial_lane #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter WORDS = 128,       // words of the memory
    parameter ADDRESS_BITS = 7,  // bits of an address in the memory
    parameter BLOCK = 0,         // 1: the memory is block RAM; 0: distributed RAM
    parameter DEEP = 0,          // 1: registers behind the word and the hit
    parameter ACC_BITS = 11,     // bits of the accumulator, which is signed
    parameter CHAIN_BITS = 7,    // bits of the word that goes around the ring of lanes
    parameter FLAGS = 1,         // number of flags that move with the score
    parameter RASTER = 0,        // 1: pixels enter by lane select and leave through the chain of scores
    parameter COPIES = 0,        // 1: an active lane copies the region to its reference; 2: every lane does; 0: none
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
    parameter FRACTION = 0,      // fraction bits of the mean of `mad`
    parameter SUMMARIES = 0,     // 1: irrelevant regions send the means of their blocks
    parameter DROPPED = 0,       // bits of a block's sum that the score does not take; 0 if a feature takes the accumulator
    parameter AUX_BITS = 1,      // bits of the second word: a mean, a sum, the largest pixel or a quotient
    parameter SUM_BITS = 14,     // `surface` and `flow`: bits of the sum of a region
    parameter PIXELS = 64,       // `segment`: pixels of a region
    parameter LEAST_BITS = 2,    // `flow`: bits of a sum times its weight
    parameter DISPLACEMENT_BITS = 1, // `flow`: bits of a displacement
    parameter ZONES = 0          // 1: keen regions have a constant of their own
) (
    input  wire                    clk_i,            // clock, rising edge
    // Memory.
    input  wire                    loading_i,        // pixels come from outside
    input  wire [       WIDTH-1:0] pixel_i,          // the pixel from outside
    input  wire [ADDRESS_BITS-1:0] address_i,        // address of the word that is read and written
    input  wire                    write_i,          // write the accumulator
    input  wire                    select_row_i,     // `raster`: write the pixel if this and select_column_i are 1
    input  wire                    select_column_i,  // `raster`: column part of the lane select
    input  wire [             3:0] sides_i,          // sides of the region on the frame's border: {bottom, top, right, left}
    // Controls.
    input  wire [    ACC_BITS-1:0] constant_i,       // the constant
    input  wire [            38:0] controls_i,       // the control word, see serial_controls
    input  wire [    ACC_BITS-1:0] keen_constant_i,  // the constant of keen regions (ZONES)
    input  wire                    classing_i,       // keen_i is the region's from the next clock on (ZONES)
    // Chain of scores.
    input  wire [  CHAIN_BITS-1:0] word_i,           // score of the lane before
    input  wire [       FLAGS-1:0] flags_i,          // flags of the lane before: active or TRS; then SRS so far or sent
    output wire [  CHAIN_BITS-1:0] word_o,           // score of this lane
    output wire [       FLAGS-1:0] flags_o,          // flags of this lane
    input  wire [DISPLACEMENT_BITS-1:0] displacement_i,  // displacement of the lane before (FLOW)
    output wire [DISPLACEMENT_BITS-1:0] displacement_o,  // displacement of this lane (FLOW)
    input  wire                    keen_i,           // the region of the lane before is keen (ZONES)
    output wire                    keen_o,           // the region of this lane is keen (ZONES)
    // Unloading.
    output wire                    leaves_o,         // the word read is a pixel of an active region, or a mean that is sent
    output wire [       WIDTH-1:0] pixel_o           // the word read, as the operand
);

    localparam SPANS = SURFACE != 0 || FLOW != 0;  // 1: words are read as distances from others
    localparam COMPUTES = MAD != 0 || VARIANCE != 0 || RANGE != 0 || SPANS;  // 1: an operand is computed from the word
    localparam SUMS = COMPUTES || SEGMENT != 0;  // 1: the lane has `aux`, and its score can take the accumulator
    localparam SEARCHES = FILTER == 1 || FILTER == 2;  // 1: medians are searched
    localparam KEEPS = SUMS || SUMMARIES != 0;  // 1: the score can take sums

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1 || WIDTH > 16) begin : g_width WIDTH_must_be_1_to_16 u_refused (); end
        if (ACC_BITS <= WIDTH) begin : g_acc_bits ACC_BITS_must_be_more_than_WIDTH u_refused (); end
        if (FILTER == 3 && ACC_BITS < WIDTH + 5) begin : g_acc_bits_2 ACC_BITS_must_hold_a_window u_refused (); end
        if (FLAGS < 1 || FLAGS > 2) begin : g_flags FLAGS_must_be_1_or_2 u_refused (); end
        if ((RASTER != 0 || SUMMARIES != 0) && CHAIN_BITS < WIDTH) begin : g_chain_bits
            CHAIN_BITS_must_hold_a_pixel u_refused ();
        end
        if (SUMS && CHAIN_BITS > ACC_BITS) begin : g_chain_bits_2
            CHAIN_BITS_must_be_ACC_BITS_or_less u_refused ();
        end
        if (SUMMARIES != 0 && FLAGS != 2) begin : g_flags_2 FLAGS_must_be_2_with_SUMMARIES u_refused (); end
        if (DROPPED < 0 || DROPPED >= ACC_BITS || (SUMS && DROPPED != 0)) begin : g_dropped
            DROPPED_must_be_0_with_sums_else_below_ACC_BITS u_refused ();
        end
        if (SUMS && (AUX_BITS < 2 || AUX_BITS > ACC_BITS)) begin : g_aux_bits
            AUX_BITS_must_be_2_to_ACC_BITS u_refused ();
        end
        if (MAD != 0 && AUX_BITS < WIDTH + FRACTION) begin : g_aux_bits_2
            AUX_BITS_must_hold_a_mean u_refused ();
        end
        if (SEGMENT != 0 && AUX_BITS < WIDTH) begin : g_aux_bits_3 AUX_BITS_must_hold_a_pixel u_refused (); end
        if (SPANS && AUX_BITS < SUM_BITS) begin : g_aux_bits_4 AUX_BITS_must_hold_a_sum u_refused (); end
        if (SEGMENT != 0 && CHAIN_BITS < $clog2(2 * PIXELS)) begin : g_chain_bits_3
            CHAIN_BITS_must_hold_two_counts u_refused ();
        end
        if (FLOW != 0 && (LEAST_BITS < 2 || LEAST_BITS >= ACC_BITS)) begin : g_least_bits
            LEAST_BITS_must_be_2_or_more_and_below_ACC_BITS u_refused ();
        end
        if (DISPLACEMENT_BITS < 1 || DISPLACEMENT_BITS > ACC_BITS) begin : g_displacement_bits
            DISPLACEMENT_BITS_must_be_1_to_ACC_BITS u_refused ();
        end
    endgenerate

    // The bits of the control word.
    wire write_active, write_border, from_memory, deviate, masked, from_aux, hold;
    wire larger, subtract, by_sign, by_run, carry, enable, clear, run, run_corner, run_clear, count, count_corner, count_side;
    wire recall_sum, recall_mean, ceiling, shrink, least, note, probe, choose;
    wire twice, divide, shift, keep, fetch, unload, unload_mean;
    wire write_mean, write_high;
    wire [1:0] side;
    assign {
        write_active, write_border, side, write_mean, write_high,
        from_memory, deviate, masked, from_aux, hold,
        larger, subtract, by_sign, by_run, carry, enable, clear,
        run, run_corner, run_clear, count, count_corner, count_side,
        recall_sum, recall_mean, ceiling, shrink, least, note, probe, choose,
        twice, divide, shift, keep, fetch, unload, unload_mean
    } = controls_i;

    // The constant of the region's class.
    wire [ACC_BITS-1:0] constant;
    generate
        if (ZONES) begin : g_zones
            reg keen_q;
            always @(posedge clk_i) if (classing_i) keen_q <= keen_i;
            assign keen_o = keen_q;
            assign constant = keen_q ? keen_constant_i : constant_i;
        end else begin : g_no_zones
            wire unused_zones = |keen_constant_i || classing_i || keen_i;
            assign keen_o = 1'b0;
            assign constant = constant_i;
        end
    endgenerate

    reg  [  ACC_BITS-1:0] acc_q;
    reg  [CHAIN_BITS-1:0] chain_q;
    reg  [     FLAGS-1:0] flags_q;
    wire [  ACC_BITS-1:0] operand;
    wire [  ACC_BITS-1:0] sum;
    wire [     WIDTH-1:0] word;
    wire [  AUX_BITS-1:0] aux;
    wire                  invert;
    wire                  hit;
    wire                  five;
    wire                  below_center;  // `switching3x3`: a neighbor is below the center
    wire                  below;  // `segment`: the pixels below are the smaller side
    wire                  stays = sum[ACC_BITS-1] == acc_q[ACC_BITS-1];

    assign word_o  = chain_q;
    assign flags_o = flags_q;

    generate
        if (RASTER != 0) begin : g_leaves_by_chain
            wire unused_unload = unload || unload_mean;
            assign leaves_o = 1'b0;
        end else if (SUMMARIES != 0) begin : g_leaves_or_mean
            assign leaves_o = (unload && flags_q[0]) || (unload_mean && flags_q[FLAGS-1]);
        end else begin : g_leaves
            wire unused_unload_mean = unload_mean;
            assign leaves_o = unload && flags_q[0];
        end
    endgenerate

    // Memory.
    wire selected = RASTER != 0 && select_row_i && select_column_i;
    wire copied   = COPIES != 0 && write_active && (COPIES == 2 || flags_q[0]);
    wire repeated = BORDERS != 0 && write_border && sides_i[side];
    wire [WIDTH-1:0] made;
    wire [WIDTH-1:0] result;

    generate
        if (FILTER == 3) begin : g_binomial
            assign made = write_high ? acc_q[4+:WIDTH] : acc_q[WIDTH-1:0];
        end else begin : g_no_binomial
            wire unused_write_high = write_high;
            assign made = acc_q[WIDTH-1:0];
        end
        if (SUMMARIES != 0 && RASTER == 0) begin : g_mean_returns
            assign result = write_mean ? chain_q[WIDTH-1:0] : made;
        end else begin : g_no_mean_returns
            wire unused_write_mean = write_mean;
            assign result = made;
        end
    endgenerate

    serial_memory #(
        .WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(BLOCK),
        .LATE(DEEP)
    ) u_memory (
        .clk_i(clk_i), .write_i(write_i || selected || copied || repeated), .address_i(address_i),
        .data_i(loading_i ? pixel_i : result), .data_o(word)
    );

    // `switching3x3`: the pixel is kept if a neighbor is above, and another one below.
    wire enables;
    wire clears;

    generate
        if (FILTER == 2) begin : g_switching
            reg kept_q;
            assign enables = enable && (!choose || kept_q);
            assign clears = clear && (!choose || kept_q);

            always @(posedge clk_i) begin
                if (probe) kept_q <= kept_q || (below_center && !stays);
                else if (clear && !choose) kept_q <= 1'b0;
            end
        end else begin : g_no_switching
            wire unused_choice = probe || choose || below_center;
            assign enables = enable;
            assign clears = clear;
        end
    endgenerate

    // Accumulator.
    wire [ACC_BITS-1:0] wide_word = {{(ACC_BITS - WIDTH) {1'b0}}, word};
    wire [ACC_BITS-1:0] found;   // the operand, before it is inverted
    wire [ACC_BITS-1:0] source;  // the operand, in the clock of the accumulator

    generate
        if (DEEP != 0 && COMPUTES) begin : g_operand
            reg [ACC_BITS-1:0] source_q;
            always @(posedge clk_i) source_q <= found;
            assign source  = source_q;
            assign pixel_o = source_q[WIDTH-1:0];
        end else begin : g_no_operand
            assign source  = found;
            assign pixel_o = word;
        end

        if (SUMS) begin : g_sums
            localparam TWICE = MAD != 0 || VARIANCE != 0 || RANGE != 0;
            localparam HIGHEST = SPANS ? SUM_BITS - 1 : 0;
            localparam SCALED = MAD != 0 ? FRACTION : 0;
            localparam MEAN_BITS = WIDTH + SCALED;
            wire [ACC_BITS-1:0] deviation;
            wire [ACC_BITS-1:0] choice;
            wire [ACC_BITS-1:0] read;      // the word, or its distance from the word that is held
            wire                deviates = (MAD != 0 || RANGE != 0) && deviate;
            wire                negative;
            wire                fraction;  // `segment`: the mean has a fraction
            wire                takes;     // the accumulator takes the sum, if `enable` is 1 as well

            if (MAD != 0 || RANGE != 0 || SPANS) begin : g_deviation
                wire [MEAN_BITS:0] whole = {{(MEAN_BITS + 1 - WIDTH) {1'b0}}, word};
                wire [MEAN_BITS:0] scaled =
                    (RANGE != 0 && from_aux) || (SPANS && !deviates) ? whole : whole << SCALED;
                wire [MEAN_BITS:0] other;
                wire [MEAN_BITS:0] difference = scaled - other;
                wire unused_aux = |aux;  // a mean has one bit, and this signal two
                assign negative = difference[MEAN_BITS];
                assign deviation = {{(ACC_BITS - MEAN_BITS) {1'b0}}, difference[MEAN_BITS-1:0]};

                if (SPANS) begin : g_held
                    // A word is held for one clock. At other times the register is 0, so that words pass the subtraction.
                    reg [WIDTH-1:0] held_q;
                    wire [MEAN_BITS:0] held = {{(MEAN_BITS + 1 - WIDTH) {1'b0}}, held_q};
                    assign other = deviates ? {1'b0, aux[MEAN_BITS-1:0]} : held;
                    assign read = deviation;
                    wire unused_word = |wide_word;
                    always @(posedge clk_i) held_q <= hold ? word : {WIDTH{1'b0}};
                end else begin : g_not_held
                    wire unused_hold = hold;
                    assign other = {1'b0, aux[MEAN_BITS-1:0]};
                    assign read = wide_word;
                end
            end else begin : g_no_deviation
                wire unused_deviate = deviate || hold || |aux;
                assign read = wide_word;
                assign negative = 1'b0;
                assign deviation = {ACC_BITS{1'b0}};
            end

            if (VARIANCE != 0) begin : g_masked
                wire [ACC_BITS-1:0] wide_aux = {{(ACC_BITS - AUX_BITS) {1'b0}}, aux};
                wire [ACC_BITS-1:0] plain = from_aux ? wide_aux : read;
                wire chosen = !masked || |(plain & constant);
                assign choice = (from_memory || from_aux) ? plain : constant;
                if (DEEP != 0) begin : g_late
                    reg chosen_q;
                    always @(posedge clk_i) chosen_q <= chosen;
                    assign takes = chosen_q;
                end else begin : g_now
                    assign takes = chosen;
                end
            end else begin : g_plain
                wire unused_masked = masked || from_aux;  // from_aux is used where `mad` scales the word and `range` does not
                assign choice = from_memory ? read : constant;
                assign takes  = 1'b1;
            end

            assign found = deviates ? deviation : choice;

            // A negative difference is inverted as well, in the bits of a mean. The bits above are those of a deviation, which is
            // not negative, and are inverted where it is subtracted.
            wire turned;
            wire turns = (SPANS || deviates) && negative;
            if (DEEP != 0 && (MAD != 0 || RANGE != 0 || SPANS)) begin : g_turned
                reg turns_q;
                always @(posedge clk_i) turns_q <= turns;
                assign turned = invert ^ turns_q;
            end else begin : g_at_once
                assign turned = invert ^ turns;
            end

            wire [ACC_BITS-1:0] inverted =
                source ^ {{(ACC_BITS - MEAN_BITS) {invert}}, {MEAN_BITS{turned}}};
            assign operand = TWICE && twice ? acc_q : inverted;

            carry_adder #(.WIDTH(ACC_BITS)) u_sum (
                .plain_i(acc_q), .other_i(operand), .carry_i(turned && carry && (SEGMENT == 0 || !ceiling || fraction)), .sum_o(sum)
            );

            // The next bit of `aux` is that of a quotient, or one that comes back.
            reg [AUX_BITS-1:0] aux_q;
            wire highest;  // the bit that comes back of a sum, or of the smallest product
            wire turns_aux = divide && (FLOW == 0 || !least);
            wire next = SPANS && recall_sum ? highest : SEGMENT != 0 && recall_mean ? aux_q[WIDTH-1] : stays;
            always @(posedge clk_i) begin
                if (shift) aux_q <= {AUX_BITS{1'b0}};
                else if (turns_aux) aux_q <= {aux_q[AUX_BITS-2:0], next};
            end
            assign aux = aux_q;

            if (FLOW != 0) begin : g_least
                // The smallest product so far. Both products come from their highest bit on, so the first bit in which they differ says
                // which is smaller.
                reg [LEAST_BITS-1:0] least_q;
                reg less_q;  // the new product is smaller
                reg more_q;  // it is larger
                reg [DISPLACEMENT_BITS-1:0] displacement_q;
                wire oldest = least_q[LEAST_BITS-1];
                wire smaller = less_q ? stays : more_q ? oldest : stays && oldest;
                assign highest = least ? oldest : aux_q[HIGHEST];
                assign displacement_o = displacement_q;

                always @(posedge clk_i) begin
                    if (shift) least_q <= {LEAST_BITS{1'b1}};
                    else if (divide && least) least_q <= {least_q[LEAST_BITS-2:0], recall_sum ? oldest : smaller};
                    if (note) begin
                        less_q <= 1'b0;
                        more_q <= 1'b0;
                    end else if (divide && least && !recall_sum) begin
                        less_q <= less_q || (!more_q && !stays && oldest);
                        more_q <= more_q || (!less_q && stays && !oldest);
                    end
                    if (shift) displacement_q <= displacement_i;
                    else if (note && !more_q) displacement_q <= source[DISPLACEMENT_BITS-1:0];
                end
            end else begin : g_no_least
                wire unused_least = least || note || |displacement_i;
                assign highest = aux_q[HIGHEST];
                assign displacement_o = {DISPLACEMENT_BITS{1'b0}};
            end

            wire taken = enables && takes && (!divide || next);
            wire cleared = clears || (SURFACE != 0 && shrink && !acc_q[ACC_BITS-1]);
            if (SEGMENT != 0) begin : g_fraction
                reg fraction_q;
                assign fraction = fraction_q;
                always @(posedge clk_i) if (ceiling && clear) fraction_q <= stays;
            end else begin : g_no_fraction
                assign fraction = 1'b0;
            end

            if (RANGE != 0) begin : g_range
                reg larger_q;  // the operand was larger than the accumulator in the step before
                wire replaces = larger && !enables && !stays;
                always @(posedge clk_i) begin
                    larger_q <= replaces;
                    if (cleared || replaces) acc_q <= {ACC_BITS{1'b0}};
                    else if (taken && (!larger || larger_q)) acc_q <= sum;
                end
            end else begin : g_no_range
                wire unused_larger = larger;
                always @(posedge clk_i) begin
                    if (cleared) acc_q <= {ACC_BITS{1'b0}};
                    else if (taken) acc_q <= sum;
                end
            end
        end else begin : g_no_sums
            wire unused_sums =
                larger || twice || divide || deviate || masked || from_aux || hold || recall_sum || shrink
                || least || note || |displacement_i;
            assign displacement_o = {DISPLACEMENT_BITS{1'b0}};
            wire unused_aux = |aux;
            assign aux = {AUX_BITS{1'b0}};
            assign found = from_memory ? wide_word : constant;
            assign operand = source ^ {ACC_BITS{invert}};

            carry_adder #(.WIDTH(ACC_BITS)) u_sum (
                .plain_i(acc_q), .other_i(operand), .carry_i(invert && carry), .sum_o(sum)
            );

            always @(posedge clk_i) begin
                if (clears) acc_q <= {ACC_BITS{1'b0}};
                else if (enables) acc_q <= sum;
            end
        end
    endgenerate

    // With ceiling, the side chooses and not the count of five.
    wire flips = SEGMENT != 0 && (!SEARCHES || ceiling) ? below : five;
    assign invert = subtract || (by_sign && !acc_q[ACC_BITS-1]) || ((SEARCHES || SEGMENT != 0) && by_run && flips);

    // Counts.
    wire hit_of_window;
    generate
        if (CORNER != 0) begin : g_run_corner
            // A run continues with a hit of the same sign, starts again with a hit of the other sign, and ends without a
            // hit. A run of five stays.
            reg  [4:0] run_q;
            reg        negative_q;
            wire       on = !run_corner || (stays && negative_q == acc_q[ACC_BITS-1]);
            wire       reaches = run_q[3] && on;
            assign five = run_q[4];
            assign below_center = run_q[0];
            assign hit_of_window = count_corner ? five || reaches : stays || run_q[0];

            always @(posedge clk_i) begin
                if (run_clear) run_q <= 5'b00000;
                else if (run && !five && (stays || run_corner))
                    run_q <= {reaches, run_q[2:0] & {3{on}}, stays};
                if (run) negative_q <= acc_q[ACC_BITS-1];
            end
        end else if (SEARCHES) begin : g_run
            reg [4:0] run_q;
            assign five = run_q[4];
            assign below_center = run_q[0];
            assign hit_of_window = stays || (EDGE != 0 && run_q[0]);

            always @(posedge clk_i) begin
                if (run_clear) run_q <= 5'b00000;
                else if (run && stays) run_q <= {run_q[3:0], 1'b1};
            end
            wire unused_corner = run_corner || count_corner;
        end else if (EDGE != 0) begin : g_run_edge
            reg run_q;
            assign five = 1'b0;
            assign below_center = 1'b0;
            assign hit_of_window = stays || run_q;

            always @(posedge clk_i) begin
                if (run_clear) run_q <= 1'b0;
                else if (run) run_q <= stays;
            end
            wire unused_corner = run_corner || count_corner;
        end else begin : g_no_run
            assign five = 1'b0;
            assign below_center = 1'b0;
            assign hit_of_window = stays;
            wire unused_run = run || run_clear || run_corner || count_corner;
        end
    endgenerate

    generate
        if (SEGMENT != 0) begin : g_side
            // After the words above, those not below are counted. So the count is PIXELS or more unless fewer are above.
            localparam COUNT_BITS = $clog2(2 * PIXELS);
            localparam [COUNT_BITS-1:0] EVERY = PIXELS[COUNT_BITS-1:0];
            reg below_q;
            assign below = below_q;
            assign hit = count_side ? sum[ACC_BITS-1] ^ below : hit_of_window;

            always @(posedge clk_i) begin
                if (shift) below_q <= 1'b0;
                else if (keep) below_q <= chain_q[COUNT_BITS-1:0] >= EVERY;
            end
        end else begin : g_no_side
            wire unused_side = count_side || recall_mean || ceiling;
            assign below = 1'b0;
            assign hit = hit_of_window;
        end
    endgenerate

    // The chain of scores. Scores that move on leave zeros behind, so nothing has to clear them. Words that are in the chain
    // after a reset move on with the temporal counts of the first frame, which are not shown.
    wire [CHAIN_BITS-1:0] summed;
    wire [CHAIN_BITS-1:0] fetched;
    wire [CHAIN_BITS-1:0] moved;
    wire scores = count && hit;
    wire scored;
    wire [CHAIN_BITS-1:0] counted;

    // The moving operand is on the direct input of the carry chain, so that a hit takes no second LUT for the lowest bit.
    carry_adder #(.WIDTH(CHAIN_BITS)) u_score (
        .plain_i(moved), .other_i({{(CHAIN_BITS - 1) {1'b0}}, scored}), .carry_i(1'b0), .sum_o(counted)
    );

    generate
        if (DEEP != 0) begin : g_scored
            reg scored_q;
            always @(posedge clk_i) scored_q <= scores;
            assign scored = scored_q;
        end else begin : g_scored_at_once
            assign scored = scores;
        end
        if (KEEPS && RASTER != 0) begin : g_coded
            // Both choices use word_i, so that one LUT per bit is enough.
            assign moved = fetch ? (keep ? word_i : fetched) : keep ? summed : chain_q;
        end else begin : g_chosen
            assign moved = shift ? word_i : fetch ? fetched : keep ? summed : chain_q;
        end
        if (!KEEPS) begin : g_not_summed
            assign summed = chain_q;
        end else if (CHAIN_BITS > ACC_BITS - DROPPED) begin : g_summed_extended
            assign summed = {{(CHAIN_BITS - ACC_BITS + DROPPED) {1'b0}}, acc_q[ACC_BITS-1:DROPPED]};
        end else begin : g_summed
            assign summed = acc_q[DROPPED+:CHAIN_BITS];
        end
        if (RASTER == 0) begin : g_not_fetched
            assign fetched = chain_q;
        end else if (CHAIN_BITS > WIDTH) begin : g_extended
            assign fetched = {{(CHAIN_BITS - WIDTH) {1'b0}}, pixel_o};
        end else begin : g_fetched
            assign fetched = pixel_o;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (shift) flags_q <= flags_i;
    end

    generate
        if (SUMMARIES != 0 && RASTER == 0) begin : g_emptied
            // A mean that has left is cleared, because it is no score.
            always @(posedge clk_i) begin
                if (unload_mean) chain_q <= {CHAIN_BITS{1'b0}};
                else chain_q <= counted;
            end
        end else begin : g_not_emptied
            always @(posedge clk_i) chain_q <= counted;
        end
    endgenerate

endmodule

`default_nettype wire
