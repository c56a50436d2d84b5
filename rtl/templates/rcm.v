// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Relevance computation module: COLUMNS x ROWS regional processing units, region row * COLUMNS + column
// in the lane of that number. All take their pixels at the same clocks and decide together.
`default_nettype none

module rcm #(
    parameter COLUMNS = {= columns =},  // regions side by side
    parameter ROWS = {= rows =}      // regions one below the other
) (
{%- for port in ports %}
    {= port.declaration =}  // {= port.doc =}
{%- endfor %}
);

    // Limits: out of them elaboration stops at a module that does not exist.
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

    // Every unit says the same.
    assign decision_valid_o = decision_valid[0];
    wire unused_decision_valid = |decision_valid;

endmodule

`default_nettype wire
