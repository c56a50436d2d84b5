// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// {= title =}
//   scores   {= summary =}
//   lanes    {= fold =} regions each, {= memory =}
//   frame    {= clocks =}
//
// Outputs follow registers and memories; those of the decision also depend on the threshold inputs at once. Keep thresholds
// still from the first pixel of a frame until ready_o is 1 again.
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

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (COLUMNS > {= widest =}) begin : g_widest COLUMNS_must_be_{= widest =}_or_less u_refused (); end
        if (ROWS > {= highest =}) begin : g_highest ROWS_must_be_{= highest =}_or_less u_refused (); end
{%- if fold > 1 %}
        if (COLUMNS * ROWS < {= fold =}) begin : g_fold
            COLUMNS_times_ROWS_must_be_{= fold =}_or_more u_refused ();
        end
{%- endif %}
    endgenerate

    localparam LANES = {= lanes =};
    localparam SLOTS = {= slots =};  // number of slots, empty ones included
{%- include "sync.v" %}

    wire [{= slot_range =}:0] region;
    wire [{= center_bits - 1 =}:0] position;
    wire [{= slot_bits - 1 =}:0] slot;
{%- if first_map.is_none() %}
    wire unused_zone_pending;
{%- endif %}
{%- if !summarizes %}
    wire summary;
{%- endif %}
{%- if !displaces %}
    wire [1:0] displacement_x;
    wire [1:0] displacement_y;
{%- endif %}
    wire unused_beside = |region || |position || |slot{% if !summarizes %} || summary{% endif %}{% if !displaces %} || |displacement_x || |displacement_y{% endif %}{% if half_level %} || edge_level_i[0]{% if first_map.is_some() %} || keen_edge_level_i[0]{% endif %}{% endif %};

    serial_array #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .LANES(LANES), .FOLD({= fold =}),
        .LANE_BITS(LANES > 1 ? $clog2(LANES) : 1), .REGION_BITS(SLOTS > 1 ? $clog2(SLOTS) : 1),
{%- for parameter in parameters %}
        .{= parameter.0 =}({= parameter.1 =}){% if !loop.last %},{% endif %}
{%- endfor %}
    ) u_array (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i({= valid =}), .ready_o({= ready =}), .pixel_i(pixel_i),
        .temporal_level_i({= temporal_level =}),
        .keen_temporal_level_i({= keen_temporal_level =}),
{%- for level in levels %}
        .{= level.0 =}({= level.1 =}),
{%- endfor %}
        .minima_i({ {%- for minimum in minima %}{% if !loop.first %}, {% endif %}{= minimum =}{% endfor -%} }),
        .keen_minima_i({ {%- for minimum in keen_minima %}{% if !loop.first %}, {% endif %}{= minimum =}{% endfor -%} }),
        .summary_level_i({= summary_level =}),
        .keen_summary_level_i({= keen_summary_level =}),
        .off_summary_level_i({= off_summary_level =}),
{%- for port in classes %}
        .{= port.0 =}({= port.1 =}),
{%- endfor %}
        .score_valid_o(score_valid_o), .score_index_o(score_index_o), .region_o(region), .score_o(score_o),
        .decision_valid_o(decision_valid_o), .srs_o(srs_o), .trs_o(trs_o), .active_o(active_o),
        .displacement_x_o({% if displaces %}displacement_x_o{% else %}displacement_x{% endif %}),
        .displacement_y_o({% if displaces %}displacement_y_o{% else %}displacement_y{% endif %}),
        .summary_o({% if summarizes %}summary_o{% else %}summary{% endif %}),
        .forward_valid_o(forward_valid_o), .forward_pixel_o(forward_pixel_o),
        .forward_slot_o(slot), .forward_position_o(position)
    );

    assign region_o = region[{= region_range =}:0];
    assign forward_position_o = position[{= position_bits - 1 =}:0];
{%- if raster %}
    assign forward_region_o = region[{= region_range =}:0];
{%- else if fold > 1 %}
    assign forward_slot_o = slot;
{%- endif %}

endmodule

`default_nettype wire
