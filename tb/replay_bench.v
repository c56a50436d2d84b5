// SPDX-License-Identifier: MIT OR Apache-2.0
// Replays recorded vectors through `{= top =}` and compares every output at every clock, bit by bit
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
  integer columns;
  integer clocks;
  integer failures;
  {%- if has_lanes %}
  integer lane;
  {%- endif %}

  // The next line of the vectors; `columns` tells whether there was one.
  task read_line;
    begin
      columns = $fscanf(file, "{= scan_format =}"
        {%- for port in inputs %},
        {= port.name =}_next
        {%- endfor %}
        {%- for port in outputs %},
        {= port.name =}_expected
        {%- endfor %});
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
    clocks = 0;
    failures = 0;
    columns = 0;
    if (file != 0) read_line;
    while (columns == {= columns =} && !(failures != 0 && $test$plusargs("stop"))) begin
      apply;
      #5 {= clock.name =} = 1'b1;
      #4 compare;
      clocks = clocks + 1;
      #1 {= clock.name =} = 1'b0;
      read_line;
    end
    if (file == 0) $display("FAIL cannot read the vectors from %0s", path);
    else if (failures != 0) $display("FAIL %0d of {= outputs.len() =} outputs in %0d clocks", failures, clocks);
    else if (columns > 0) $display("FAIL line %0d of the vectors is incomplete", clocks + 1);
    else if (clocks == 0) $display("FAIL there are no vectors in %0s", path);
    else $display("PASS %0d clocks", clocks);
    $finish;
  end

endmodule

`default_nettype wire
