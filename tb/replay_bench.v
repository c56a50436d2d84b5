// SPDX-License-Identifier: MIT OR Apache-2.0
// Replays recorded vectors through `{= top =}` and compares every output at every clock, bit by bit
// and four-state: an X is a mismatch. An output that means something only with a valid bit is compared
// where that bit is expected.
//
{%- for line in about %}
// {= line =}
{%- endfor %}
{%- if !about.is_empty() %}
//
{%- endif %}
//   +vectors=FILE  the vectors, by default vectors.hex: lines of hexadecimal numbers. The first number of
//                  a line has a bit for each value that differs from the line before: bit 0 for the first
//                  input declared below, then the others, then the expected outputs. These values
//                  follow. The bit above them all says that the number of clocks comes first for which
//                  the line is good; without it that is one. A line 0 is the end.
//                  Inputs are applied, and outputs are expected after the rising edge with these inputs
//                  still applied.
//   +stop          ends at the first mismatch
//   +ends=FILE     with a mismatch, ends after as many clocks as the next of these numbers, hexadecimal and growing
//   +waves=FILE    writes waves of everything: VCD, or FST with `vvp SIMULATION -fst`
//
// Prints the first mismatch of each output, then a line that starts with PASS, FAIL or INCOMPLETE (no mismatch,
// but the vectors do not show everything). The simulator's exit code is 0 only with PASS.

`default_nettype none

module {= bench =};

  // Inputs, and what the vectors say that they are next. ($fscanf does not write to inputs itself
  // because Verilator 5.006 overlooks that they change then.)
  reg {= clock.declared =} = 1'b0;
  {%- for port in inputs %}
  reg {= port.declared =};
  {%- endfor %}
  {%- for port in inputs %}
  reg {= port.next =};
  {%- endfor %}

  // Outputs, what they should be, and whether they have been wrong.
  {%- for port in outputs %}
  wire {= port.declared =};
  {%- endfor %}
  {%- for port in outputs %}
  reg {= port.expected =};
  {%- endfor %}
  {%- for port in outputs %}
  reg {= port.name =}_failed = 1'b0;
  {%- endfor %}

  {= top =} {% if !parameters.is_empty() %}#({= parameters.join(", ") =}) {% endif %}dut (
    .{= clock.name =}({= clock.name =})
    {%- for port in inputs %},
    .{= port.name =}({= port.name =})
    {%- endfor %}
    {%- for port in outputs %},
    .{= port.name =}({= port.name =})
    {%- endfor %}
  );

  reg [8*1024-1:0] path;
  integer file;
  integer ends;
  integer failures;
  reg [63:0] clocks;
  reg [63:0] last;  // with a mismatch, the run ends after so many clocks
  reg [31:0] run;  // clocks for which the line is good
  reg [{= columns =}:0] changes;  // the first number of the line
  reg is_whole;  // whether every value of the line was there
  {%- if shortcoming.is_none() %}
  reg has_passed = 1'b0;
  {%- endif %}
  {%- if has_lanes %}
  integer lane;
  {%- endif %}

  // The next line of the vectors.
  task read_line;
    begin
      changes = {= columns + 1 =}'d0;
      run = 32'd1;
      is_whole = $fscanf(file, "%h", changes) == 1;
      if (changes[{= columns =}]) is_whole = $fscanf(file, "%h", run) == 1 && is_whole;
      {%- for port in inputs %}
      if (changes[{= loop.index0 =}]) is_whole = $fscanf(file, "%h", {= port.name =}_next) == 1 && is_whole;
      {%- endfor %}
      {%- for port in outputs %}
      if (changes[{= loop.index0 + inputs.len() =}]) is_whole = $fscanf(file, "%h", {= port.name =}_expected) == 1 && is_whole;
      {%- endfor %}
    end
  endtask

  // Where a run ends that has no mismatch yet.
  task read_end;
    begin
      if ($fscanf(ends, "%h", last) != 1) last = {64{1'b1}};
    end
  endtask

  task apply;
    begin
      {%- for port in inputs %}
      {= port.name =} = {= port.name =}_next;
      {%- endfor %}
    end
  endtask

  task compare;
    begin
      {%- for port in outputs %}
      {%- if port.lanes == 1 %}
      if ({= port.gate =}{= port.name =} !== {= port.name =}_expected && !{= port.name =}_failed) begin
        {= port.name =}_failed = 1'b1;
        failures = failures + 1;
        $display("MISMATCH clock %0d port {= port.name =} expected %h got %h",
                 clocks, {= port.name =}_expected, {= port.name =});
      end
      {%- else %}
      for (lane = 0; lane < {= port.lanes =}; lane = lane + 1) begin
        if ({= port.gate =}{= port.lane =} !== {= port.expected_lane =}
            && !{= port.name =}_failed) begin
          {= port.name =}_failed = 1'b1;
          failures = failures + 1;
          $display("MISMATCH clock %0d port {= port.name =} lane %0d expected %h got %h",
                   clocks, lane, {= port.expected_lane =},
                   {= port.lane =});
        end
      end
      {%- endif %}
      {%- endfor %}
    end
  endtask

  initial begin
    if ($value$plusargs("waves=%s", path)) begin
      $dumpfile(path);
      $dumpvars(0, {= bench =});
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
    changes = {= columns + 1 =}'d0;
    if (file != 0) read_line;
    while (is_whole && |changes && !(failures != 0 && clocks >= last)) begin
      apply;
      while (run != 32'd0 && !(failures != 0 && clocks >= last)) begin
        #5 {= clock.name =} = 1'b1;
        #4 compare;
        clocks = clocks + 64'd1;
        if (ends != 0 && failures == 0 && clocks == last) read_end;
        run = run - 32'd1;
        #1 {= clock.name =} = 1'b0;
      end
      read_line;
    end
    if (file == 0) $display("FAIL cannot read the vectors from %0s", path);
    else if (failures != 0) $display("FAIL %0d of {= outputs.len() =} outputs in %0d clocks", failures, clocks);
    else if (!is_whole) $display("FAIL the vectors end after %0d clocks, in the middle", clocks);
    {%- match shortcoming %}
    {%- when Some(shortcoming) %}
    else $display("INCOMPLETE %0d clocks without a mismatch, but {= shortcoming =}", clocks);
    $fatal(1, "not passed");
    {%- when None %}
    else if (clocks == 64'd0) $display("FAIL there are no vectors in %0s", path);
    else begin
      $display("PASS %0d clocks", clocks);
      has_passed = 1'b1;
    end
    if (has_passed) $finish;
    else $fatal(1, "not passed");
    {%- endmatch %}
  end

endmodule

`default_nettype wire
