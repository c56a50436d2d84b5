// SPDX-License-Identifier: MIT OR Apache-2.0
// Replays recorded vectors through `rpu` and compares every output at every clock, bit by bit
// and four-state: an X is a mismatch. An output that means something only with a valid bit is compared
// where that bit is expected.
//
//   +vectors=FILE  the vectors, by default vectors.hex. A line is one clock: the inputs, then the
//                  outputs that are expected after its rising edge with these inputs still applied,
//                  hexadecimal, in the order in which they are declared below
//   +stop          ends at the first mismatch
//   +waves=FILE    writes waves of everything: VCD, or FST with `vvp SIMULATION -fst`
//
// Prints the first mismatch of each output. The last line starts with PASS or FAIL.

`default_nettype none

module rpu_replay;

  // Inputs, and what the vectors say that they are next. ($fscanf does not write to inputs itself
  // because Verilator 5.006 overlooks that they change then.)
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

  // Outputs, what they should be, and whether they have been wrong.
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
  integer columns;
  integer clocks;
  integer failures;

  // The next line of the vectors; `columns` tells whether there was one.
  task read_line;
    begin
      columns = $fscanf(file, "%h %h %h %h %h %h %h %h %h %h %h %h %h %h %h",
        rst_i_next,
        valid_i_next,
        pixel_i_next,
        edge_level_i_next,
        edge_min_i_next,
        temporal_level_i_next,
        temporal_min_i_next,
        decision_valid_o_expected,
        srs_o_expected,
        trs_o_expected,
        active_o_expected,
        edge_score_o_expected,
        temporal_count_o_expected,
        forward_valid_o_expected,
        forward_pixel_o_expected);
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
    clocks = 0;
    failures = 0;
    columns = 0;
    if (file != 0) read_line;
    while (columns == 15 && !(failures != 0 && $test$plusargs("stop"))) begin
      apply;
      #5 clk_i = 1'b1;
      #4 compare;
      clocks = clocks + 1;
      #1 clk_i = 1'b0;
      read_line;
    end
    if (file == 0) $display("FAIL cannot read the vectors from %0s", path);
    else if (failures != 0) $display("FAIL %0d of 8 outputs in %0d clocks", failures, clocks);
    else if (columns > 0) $display("FAIL line %0d of the vectors is incomplete", clocks + 1);
    else if (clocks == 0) $display("FAIL there are no vectors in %0s", path);
    else $display("PASS %0d clocks", clocks);
    $finish;
  end

endmodule

`default_nettype wire
