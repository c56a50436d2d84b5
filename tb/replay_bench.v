// SPDX-License-Identifier: MIT OR Apache-2.0
// Replays recorded vectors through `{= top =}` and compares every output at every clock, bit by bit and with four states: an X
// is a mismatch. An output that means something only with a valid bit is compared at the clocks at which the vectors expect
// that bit.
//
{%- for line in comment_lines %}
// {= line =}
{%- endfor %}
{%- if !comment_lines.is_empty() %}
//
{%- endif %}
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

module {= bench =};

  // Inputs, and their next values in the vectors. ($fscanf does not write to inputs itself, because Verilator 5.006 then
  // overlooks that they change.)
  reg {= clock.declared =} = 1'b0;
  {%- for port in inputs %}
  reg {= port.declared =};
  {%- endfor %}
  {%- for port in inputs %}
  reg {= port.next =};
  {%- endfor %}

  // Outputs, their expected values, and flags of those that have been wrong.
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
  reg [63:0] last;  // after a mismatch, the run ends at this clock
  reg [31:0] run;  // number of clocks for which the line holds
  reg [{= columns =}:0] changes;  // the first number of the line
  reg is_whole;  // every value of the line could be read
  {%- if shortcoming.is_none() %}
  reg has_passed = 1'b0;
  {%- endif %}
  {%- if has_lanes %}
  integer lane;
  {%- endif %}

  // Reads the next line of the vectors.
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

  // Decides where a run without a mismatch ends.
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
