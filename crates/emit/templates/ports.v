// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// The core in the middle of a chip, to see the clock that it reaches there: every bit of a port but the clock is a
// register of the device. That of an input holds itself, that of an output is read by nobody. For synth/ only.
`default_nettype none

module {= module =}_ports (
    input wire clk_i  // clock, rising edge
);
{%- for port in ports %}
    wire {= port.range =}{= port.name =}{% if !port.input %}, unused_{= port.name =}{% endif %};
    {= before =}ports_register #(.WIDTH({= port.bits =})) u_{= port.name =} (
        .clk_i(clk_i), .d_i({= port.name =}), .q_o({% if !port.input %}unused_{% endif %}{= port.name =})
    );
{%- endfor %}

    {= module =} u_core (
{%- for port in ports %}
        .{= port.name =}({= port.name =}),
{%- endfor %}
        .{= clock =}(clk_i)
    );

endmodule

`default_nettype wire
