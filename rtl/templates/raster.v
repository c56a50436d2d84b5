// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// {= title =}
//   scores   {= summary =}
//   words    {= lanes =} pixels, {= pipelining =} pipelining
//   frame    {= clocks =}
//
// Keep thresholds still from the first word of a frame until ready_o is 1 after its last word.
`default_nettype none

module {= module =} #(
    parameter COLUMNS = {= columns =},  // regions in a row of regions
    parameter ROWS = {= rows =}{% if first_map.is_some() %},{% endif %}      // rows of regions
{%- if let Some(map) = first_map %}
    parameter [2*COLUMNS*ROWS-1:0] CLASSES =  // the first map of classes, 2 bits for each region, region 0 lowest
    {= map =}
{%- endif %}
) (
{%- for port in ports %}
    {= port.declaration =}  // {= port.doc =}
{%- endfor %}
);
{%- for constant in constants %}
    localparam [{= constant.width - 1 =}:0] {= constant.name =} = {= constant.width =}'d{= constant.value =};
{%- endfor %}
{%- if first_map.is_none() %}
    wire unused_zone_pending;
{%- endif %}
{%- for port in unused %}
    wire {% if port.range.len() > 0 %}{= port.range =} {% endif %}unused_{= port.name =};
{%- endfor %}
{%- include "sync.v" %}

    raster_core #(
        .COLUMNS(COLUMNS), .ROWS(ROWS),
        .FRAME_WIDTH(COLUMNS * {= n =}{% if pad_columns > 0 %} - {= pad_columns =}{% endif %}), .FRAME_HEIGHT(ROWS * {= n =}{% if pad_rows > 0 %} - {= pad_rows =}{% endif %}),
        .REGION_BITS($clog2(COLUMNS * ROWS)),
{%- for parameter in parameters %}
        .{= parameter.0 =}({= parameter.1 =}){% if !loop.last %},{% endif %}
{%- endfor %}
    ) u_core (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i({= valid =}), .pixel_i(pixel_i), .ready_o({= ready =}),
{%- for level in levels %}
        .{= level.0 =}({= level.1 =}),
{%- endfor %}
        .minima_i({ {%- for minimum in minima %}{% if !loop.first %}, {% endif %}{= minimum =}{% endfor -%} }),
        .keen_minima_i({ {%- for minimum in keen_minima %}{% if !loop.first %}, {% endif %}{= minimum =}{% endfor -%} }),
{%- for port in classes %}
        .{= port.0 =}({= port.1 =}),
{%- endfor %}
        .decision_valid_o(decision_valid_o), .region_o(region_o), .srs_o(srs_o), .trs_o(trs_o), .active_o(active_o),
        .scores_o({ {%- for score in scores %}{% if !loop.first %}, {% endif %}{= score =}{% endfor -%} }),
{%- for stream in streams %}
        .{= stream.0 =}({= stream.1 =}){% if !loop.last %},{% endif %}
{%- endfor %}
    );

endmodule

`default_nettype wire
