// SPDX-License-Identifier: MIT OR Apache-2.0
// Replays recorded vectors through `rpu` and compares every output at every clock, bit by bit and with four states: an X
// is a mismatch. An output that means something only with a valid bit is compared at the clocks at which the vectors expect
// that bit.
//
// The vectors show 22 frames of 1 x 1 regions.
// Decisions: 7 active, 11 held, 4 blank; 15 comparisons with an earlier frame.
//
//   +vectors=FILE  the vectors, by default vectors.hex: lines of hexadecimal numbers. The first number of
//                  a line has one bit for each value that differs from the line before: bit 0 for the first
//                  input declared below, then the other inputs, then the expected outputs. These values
//                  follow. If the bit above all of these is 1, the second number is the number of clocks for
//                  which the line holds; otherwise it holds for one clock. A line 0 is the end.
//                  Inputs are applied before a rising edge. Outputs are expected after it, with these inputs
//                  still applied.
//   +stop          ends at the first mismatch
//    +ends=FILE     after a mismatch, ends at the next clock in this list of growing hexadecimal numbers
//    +waves=FILE    writes the waves of all signals: VCD, or FST with `vvp SIMULATION -fst`
//
// Prints the first mismatch of each output, then a line that starts with PASS, FAIL or INCOMPLETE (no mismatch, but the
// vectors do not cover everything). The simulator's exit code is 0 only with PASS.

`default_nettype none

module rpu_replay;

  // Inputs, and their next values in the vectors. ($fscanf does not write to inputs itself, because Verilator 5.006 then
  // overlooks that they change.)
  reg clk_i = 1'b0;
  reg rst_i;
  reg valid_i;
  reg [7:0] pixel_i;
  reg [10:0] edge_level_i;
  reg [6:0] edge_min_i;
  reg [7:0] temporal_level_i;
  reg [6:0] temporal_min_i;
  reg rst_i_next;
  reg valid_i_next;
  reg [7:0] pixel_i_next;
  reg [10:0] edge_level_i_next;
  reg [6:0] edge_min_i_next;
  reg [7:0] temporal_level_i_next;
  reg [6:0] temporal_min_i_next;

  // Outputs, their expected values, and flags of those that have been wrong.
  wire decision_valid_o;
  wire srs_o;
  wire trs_o;
  wire active_o;
  wire [6:0] edge_score_o;
  wire [6:0] temporal_count_o;
  wire forward_valid_o;
  wire [7:0] forward_pixel_o;
  reg decision_valid_o_expected;
  reg srs_o_expected;
  reg trs_o_expected;
  reg active_o_expected;
  reg [6:0] edge_score_o_expected;
  reg [6:0] temporal_count_o_expected;
  reg forward_valid_o_expected;
  reg [7:0] forward_pixel_o_expected;
  reg decision_valid_o_failed = 1'b0;
  reg srs_o_failed = 1'b0;
  reg trs_o_failed = 1'b0;
  reg active_o_failed = 1'b0;
  reg edge_score_o_failed = 1'b0;
  reg temporal_count_o_failed = 1'b0;
  reg forward_valid_o_failed = 1'b0;
  reg forward_pixel_o_failed = 1'b0;

  rpu dut (
    .clk_i(clk_i),
    .rst_i(rst_i),
    .valid_i(valid_i),
    .pixel_i(pixel_i),
    .edge_level_i(edge_level_i),
    .edge_min_i(edge_min_i),
    .temporal_level_i(temporal_level_i),
    .temporal_min_i(temporal_min_i),
    .decision_valid_o(decision_valid_o),
    .srs_o(srs_o),
    .trs_o(trs_o),
    .active_o(active_o),
    .edge_score_o(edge_score_o),
    .temporal_count_o(temporal_count_o),
    .forward_valid_o(forward_valid_o),
    .forward_pixel_o(forward_pixel_o)
  );

  reg [8*1024-1:0] path;
  integer file;
  integer ends;
  integer failures;
  reg [63:0] clocks;
  reg [63:0] last;  // after a mismatch, the run ends at this clock
  reg [31:0] run;  // number of clocks for which the line holds
  reg [15:0] changes;  // the first number of the line
  reg is_whole;  // every value of the line could be read
  reg has_passed = 1'b0;

  // Reads the next line of the vectors.
  task read_line;
    begin
      changes = 16'd0;
      run = 32'd1;
      is_whole = $fscanf(file, "%h", changes) == 1;
      if (changes[15]) is_whole = $fscanf(file, "%h", run) == 1 && is_whole;
      if (changes[0]) is_whole = $fscanf(file, "%h", rst_i_next) == 1 && is_whole;
      if (changes[1]) is_whole = $fscanf(file, "%h", valid_i_next) == 1 && is_whole;
      if (changes[2]) is_whole = $fscanf(file, "%h", pixel_i_next) == 1 && is_whole;
      if (changes[3]) is_whole = $fscanf(file, "%h", edge_level_i_next) == 1 && is_whole;
      if (changes[4]) is_whole = $fscanf(file, "%h", edge_min_i_next) == 1 && is_whole;
      if (changes[5]) is_whole = $fscanf(file, "%h", temporal_level_i_next) == 1 && is_whole;
      if (changes[6]) is_whole = $fscanf(file, "%h", temporal_min_i_next) == 1 && is_whole;
      if (changes[7]) is_whole = $fscanf(file, "%h", decision_valid_o_expected) == 1 && is_whole;
      if (changes[8]) is_whole = $fscanf(file, "%h", srs_o_expected) == 1 && is_whole;
      if (changes[9]) is_whole = $fscanf(file, "%h", trs_o_expected) == 1 && is_whole;
      if (changes[10]) is_whole = $fscanf(file, "%h", active_o_expected) == 1 && is_whole;
      if (changes[11]) is_whole = $fscanf(file, "%h", edge_score_o_expected) == 1 && is_whole;
      if (changes[12]) is_whole = $fscanf(file, "%h", temporal_count_o_expected) == 1 && is_whole;
      if (changes[13]) is_whole = $fscanf(file, "%h", forward_valid_o_expected) == 1 && is_whole;
      if (changes[14]) is_whole = $fscanf(file, "%h", forward_pixel_o_expected) == 1 && is_whole;
    end
  endtask

  // Decides where a run without a mismatch ends.
  task read_end;
    begin
      if ($fscanf(ends, "%h", last) != 1) last = {64{1'b1}};
    end
  endtask

  task apply;
    begin
      rst_i = rst_i_next;
      valid_i = valid_i_next;
      pixel_i = pixel_i_next;
      edge_level_i = edge_level_i_next;
      edge_min_i = edge_min_i_next;
      temporal_level_i = temporal_level_i_next;
      temporal_min_i = temporal_min_i_next;
    end
  endtask

  task compare;
    begin
      if (decision_valid_o !== decision_valid_o_expected && !decision_valid_o_failed) begin
        decision_valid_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port decision_valid_o expected %h got %h",
                 clocks, decision_valid_o_expected, decision_valid_o);
      end
      if (srs_o !== srs_o_expected && !srs_o_failed) begin
        srs_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port srs_o expected %h got %h",
                 clocks, srs_o_expected, srs_o);
      end
      if (trs_o !== trs_o_expected && !trs_o_failed) begin
        trs_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port trs_o expected %h got %h",
                 clocks, trs_o_expected, trs_o);
      end
      if (active_o !== active_o_expected && !active_o_failed) begin
        active_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port active_o expected %h got %h",
                 clocks, active_o_expected, active_o);
      end
      if (edge_score_o !== edge_score_o_expected && !edge_score_o_failed) begin
        edge_score_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port edge_score_o expected %h got %h",
                 clocks, edge_score_o_expected, edge_score_o);
      end
      if (temporal_count_o !== temporal_count_o_expected && !temporal_count_o_failed) begin
        temporal_count_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port temporal_count_o expected %h got %h",
                 clocks, temporal_count_o_expected, temporal_count_o);
      end
      if (forward_valid_o !== forward_valid_o_expected && !forward_valid_o_failed) begin
        forward_valid_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port forward_valid_o expected %h got %h",
                 clocks, forward_valid_o_expected, forward_valid_o);
      end
      if (forward_pixel_o !== forward_pixel_o_expected && !forward_pixel_o_failed) begin
        forward_pixel_o_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port forward_pixel_o expected %h got %h",
                 clocks, forward_pixel_o_expected, forward_pixel_o);
      end
    end
  endtask

  initial begin
    if ($value$plusargs("waves=%s", path)) begin
      $dumpfile(path);
      $dumpvars(0, rpu_replay);
    end
    if (!$value$plusargs("vectors=%s", path)) path = "vectors.hex";
    file = $fopen(path, "r");
    clocks = 64'd0;
    failures = 0;
    ends = 0;
    last = $test$plusargs("stop") ? 64'd0 : {64{1'b1}};
    if ($value$plusargs("ends=%s", path)) ends = $fopen(path, "r");
    if (ends != 0) read_end;
    is_whole = 1'b0;
    changes = 16'd0;
    if (file != 0) read_line;
    while (is_whole && |changes && !(failures != 0 && clocks >= last)) begin
      apply;
      while (run != 32'd0 && !(failures != 0 && clocks >= last)) begin
        #5 clk_i = 1'b1;
        #4 compare;
        clocks = clocks + 64'd1;
        if (ends != 0 && failures == 0 && clocks == last) read_end;
        run = run - 32'd1;
        #1 clk_i = 1'b0;
      end
      read_line;
    end
    if (file == 0) $display("FAIL cannot read the vectors from %0s", path);
    else if (failures != 0) $display("FAIL %0d of 8 outputs in %0d clocks", failures, clocks);
    else if (!is_whole) $display("FAIL the vectors end after %0d clocks, in the middle", clocks);
    else if (clocks == 64'd0) $display("FAIL there are no vectors in %0s", path);
    else begin
      $display("PASS %0d clocks", clocks);
      has_passed = 1'b1;
    end
    if (has_passed) $finish;
    else $fatal(1, "not passed");
  end

endmodule

`default_nettype wire
