// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Relevance computation module (RCM): COLUMNS x ROWS regional processing units. The lane of a region has the number
// row * COLUMNS + column. All units take their pixels at the same clocks and decide at the same clock.
`default_nettype none

module rcm #(
    parameter COLUMNS = {= columns =},  // regions in a row of regions
    parameter ROWS = {= rows =}      // rows of regions
) (
{%- for port in ports %}
    {= port.declaration =}  // {= port.doc =}
{%- endfor %}
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (COLUMNS > {= widest =}) begin : g_widest COLUMNS_must_be_{= widest =}_or_less u_refused (); end
        if (ROWS > {= highest =}) begin : g_highest ROWS_must_be_{= highest =}_or_less u_refused (); end
    endgenerate
{%- include "sync.v" %}

    wire [COLUMNS*ROWS-1:0] decision_valid;

    genvar row, column;
    generate
        for (row = 0; row < ROWS; row = row + 1) begin : g_row
            for (column = 0; column < COLUMNS; column = column + 1) begin : g_column
                localparam REGION = row * COLUMNS + column;

                rpu u_rpu (
{%- for pin in pins %}
                    .{= pin.name =}({= pin.connection =}){% if !loop.last %},{% endif %}
{%- endfor %}
                );
            end
        end
    endgenerate

    // decision_valid is the same for every unit.
    assign decision_valid_o = decision_valid[0];
    wire unused_decision_valid = |decision_valid;

endmodule

`default_nettype wire
