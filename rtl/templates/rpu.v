// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Regional processing unit (RPU): one {= n =}x{= n =} region of {= p =}-bit pixels, {= stream_pixels =} pixels per frame.
//   scores   {= summary =}
//   latency  {= latency =}
//
// Outputs change after the rising edge of clk_i. Only srs_o, trs_o{% if periphery.is_some() %}, active_o and summary_o{% else %} and active_o{% endif %} also depend on the threshold inputs at
// once. A threshold is read when it is used, so keep thresholds still while a frame is under way.
`default_nettype none

module rpu (
{%- for port in ports %}
    {= port.declaration =}  // {= port.doc =}
{%- endfor %}
);
{%- for constant in constants %}
    localparam [{= constant.width - 1 =}:0] {= constant.name =} = {= constant.width =}'d{= constant.value =};
{%- endfor %}
{%- if let Some(filter) = filter %}

    // Denoising.
    wire raw_advance, raw_step, raw_top, raw_bottom, raw_left, raw_right;
    wire [{= p - 1 =}:0] raw_upper, raw_middle, raw_lower, raw_center;
    wire [{= raw_address_bits - 1 =}:0] unused_raw_address;
    wire unused_raw_last;
    wire denoised_valid;
    wire [{= p - 1 =}:0] denoised_pixel;
    {%- if shared %}

    window_shared #(.SIDE({= stream_side =}), .SIDE_BITS({= stream_side_bits =}), .ADDRESS_BITS({= raw_address_bits =})) u_raw_window (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .border_i(4'b0000),
        .advance_o(raw_advance), .step_o(raw_step), .address_o(unused_raw_address), .last_o(unused_raw_last),
        .top_o(raw_top), .bottom_o(raw_bottom), .left_o(raw_left), .right_o(raw_right)
    );
    {%- else %}

    window_isolated #(.SIDE({= n =}), .ADDRESS_BITS({= address_bits =})) u_raw_window (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i),
        .advance_o(raw_advance), .step_o(raw_step), .address_o(unused_raw_address), .last_o(unused_raw_last),
        .top_o(raw_top), .bottom_o(raw_bottom), .left_o(raw_left), .right_o(raw_right)
    );
    {%- endif %}

    window_column #(.WIDTH({= p =}), .SIDE({= stream_side =})) u_raw_column (
        .clk_i(clk_i), .advance_i(raw_advance), .top_i(raw_top), .bottom_i(raw_bottom), .pixel_i(pixel_i),
        .upper_o(raw_upper), .middle_o(raw_middle), .lower_o(raw_lower), .center_o(raw_center)
    );

    {%- if deep %}

    // The column before the incoming one is the center's column. This flag says that it is the first of its row.
    reg raw_center_left_q;
    always @(posedge clk_i) if (raw_advance) raw_center_left_q <= raw_left;

    {= filter.module =} #(.WIDTH({= p =}), .LANES(1){% if filter.is_switching %}, .SWITCHING(1){% endif %}, .DEEP(0)) {= filter.instance =} (
        .clk_i(clk_i), .step_i(raw_advance), .left_i(raw_center_left_q), .right_i(raw_right),
        .top_i(1'b0), .bottom_i(1'b0), .upper_i(raw_upper), .middle_i(raw_middle), .lower_i(raw_lower), .{= filter.output =}(denoised_pixel)
    );

    bit_delay #(.DEPTH({= filter_registers =})) u_denoised_valid (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(raw_step), .bit_o(denoised_valid)
    );
    {%- else %}

    {= filter.module =} #(.WIDTH({= p =}){% if filter.is_switching %}, .SWITCHING(1){% endif %}) {= filter.instance =} (
        .clk_i(clk_i), .rst_i(rst_i), .advance_i(raw_advance), .step_i(raw_step),
        .left_i(raw_left), .right_i(raw_right),
        .upper_i(raw_upper), .middle_i(raw_middle), .lower_i(raw_lower),
        .valid_o(denoised_valid), .{= filter.output =}(denoised_pixel)
    );
    {%- endif %}
    {%- if keeps_raw %}

    // The raw center is delayed as much as the result of the filter.
    wire [{= p - 1 =}:0] denoised_raw;
    line_delay #(.WIDTH({= p =}), .DEPTH({= filter_registers =})) u_denoised_raw (
        .clk_i(clk_i), .advance_i(1'b1), .data_i(raw_center), .data_o(denoised_raw)
    );
    {%- else %}
    wire unused_raw_center = |raw_center;
    {%- endif %}
{%- else %}

    wire denoised_valid = valid_i;
    wire [{= p - 1 =}:0] denoised_pixel = pixel_i;
{%- endif %}
{%- if window %}

    // Windows of the features.
    wire window_advance, window_top, window_bottom, window_left, window_right;
    wire [{= p - 1 =}:0] window_upper, window_middle, window_lower;
{%- endif %}
    wire front_step, front_last;
    wire [{= address_bits - 1 =}:0] front_address;
    wire [{= p - 1 =}:0] front_pixel;
{%- if keeps_raw %}
    wire [{= p - 1 =}:0] front_raw;
{%- endif %}
{%- if window %}
    {%- if shared %}

    window_shared #(.SIDE({= window_side =}), .SIDE_BITS({= window_side_bits =}), .ADDRESS_BITS({= address_bits =})) u_window (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(denoised_valid), .border_i({% if border %}border_i{% else %}4'b0000{% endif %}),
        .advance_o(window_advance), .step_o(front_step), .address_o(front_address), .last_o(front_last),
        .top_o(window_top), .bottom_o(window_bottom), .left_o(window_left), .right_o(window_right)
    );
    {%- else %}

    window_isolated #(.SIDE({= n =}), .ADDRESS_BITS({= address_bits =})) u_window (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(denoised_valid),
        .advance_o(window_advance), .step_o(front_step), .address_o(front_address), .last_o(front_last),
        .top_o(window_top), .bottom_o(window_bottom), .left_o(window_left), .right_o(window_right)
    );
    {%- endif %}

    window_column #(.WIDTH({= p =}), .SIDE({= window_side =})) u_column (
        .clk_i(clk_i), .advance_i(window_advance), .top_i(window_top), .bottom_i(window_bottom),
        .pixel_i(denoised_pixel), .upper_o(window_upper), .middle_o(window_middle),
        .lower_o(window_lower), .center_o(front_pixel)
    );
    {%- if keeps_raw %}

    line_delay #(.WIDTH({= p =}), .DEPTH({= window_side + 1 =})) u_front_raw (
        .clk_i(clk_i), .advance_i(window_advance), .data_i(denoised_raw), .data_o(front_raw)
    );
    {%- endif %}
{%- else %}
    assign front_step = denoised_valid;
    assign front_pixel = denoised_pixel;
    {%- if keeps_raw %}
    assign front_raw = denoised_raw;
    {%- endif %}

    position_counter #(.PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =})) u_position (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(front_step), .address_o(front_address), .last_o(front_last)
    );
{%- endif %}
{%- if zones %}

    // The class of the region in the frame whose pixels leave the last window.
    wire [1:0] front_class, held_class;
    region_class u_class (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(front_step), .last_i(front_last), .class_i(zone_i),
        .class_o(front_class), .held_o(held_class)
    );
    {%- if !windowed.is_empty() %}
    wire front_keen = front_class == 2'd2;
    {%- endif %}
{%- endif %}
{%- for feature in windowed %}

    wire {= feature.name =}_hit;
    {= feature.name =}_detector #(.WIDTH({= p =}){= feature.parameters =}{% if deep %}, .DEEP(1){% endif %}) u_{= feature.name =} (
        .clk_i(clk_i), .advance_i(window_advance), .left_i(window_left), .right_i(window_right),
        .upper_i(window_upper), .middle_i(window_middle), .lower_i(window_lower),
        .level_i({= feature.level =}), .hit_o({= feature.name =}_hit)
    );
{%- endfor %}
{%- if sums %}

    // Sums of the region, which are complete before the tail.
    wire sum_done;
    wire [{= sum_bits - 1 =}:0] pixel_sum;
    region_sum #(.WIDTH({= p =}), .SUM_BITS({= sum_bits =})) u_pixel_sum (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(front_step), .last_i(front_last),
        .value_i(front_pixel), .done_o(sum_done), .sum_o(pixel_sum)
    );
{%- endif %}
{%- if tail_delay %}

    // {% if deep %}The tail begins with registers.{% else %}The tail runs a clock behind, so that every score is final at once.{% endif %}
    reg tail_step, tail_last;
    reg [{= address_bits - 1 =}:0] tail_address = {= address_bits =}'d0;  // initial value: keeps it out of the store's port
    reg [{= p - 1 =}:0] tail_pixel;
    {%- if keeps_raw %}
    reg [{= p - 1 =}:0] tail_raw;
    {%- endif %}
    {%- if !deep %}
    {%- for feature in windowed %}
    reg tail_{= feature.name =}_hit;
    {%- endfor %}
    {%- endif %}
    {%- if zones %}
    reg [1:0] tail_class;
    {%- endif %}
    always @(posedge clk_i) begin
        tail_step <= front_step && !rst_i;
        tail_last <= front_last;
        tail_address <= front_address;
        tail_pixel <= front_pixel;
        {%- if keeps_raw %}
        tail_raw <= front_raw;
        {%- endif %}
        {%- if !deep %}
        {%- for feature in windowed %}
        tail_{= feature.name =}_hit <= {= feature.name =}_hit;
        {%- endfor %}
        {%- endif %}
        {%- if zones %}
        tail_class <= front_class;
        {%- endif %}
    end
{%- else %}

    wire tail_step = front_step;
    wire tail_last = front_last;
    wire [{= address_bits - 1 =}:0] tail_address = front_address;
    wire [{= p - 1 =}:0] tail_pixel = front_pixel;
    {%- if keeps_raw %}
    wire [{= p - 1 =}:0] tail_raw = front_raw;
    {%- endif %}
    {%- for feature in windowed %}
    wire tail_{= feature.name =}_hit = {= feature.name =}_hit;
    {%- endfor %}
    {%- if zones %}
    wire [1:0] tail_class = front_class;
    {%- endif %}
{%- endif %}
{%- if deep %}

    // The store is read and written in one clock. Pixels are compared in that clock and counted in the next one.
    reg count_step, count_last;
    {%- if zones %}
    reg [1:0] count_class;
    {%- endif %}
    always @(posedge clk_i) begin
        count_step <= tail_step && !rst_i;
        count_last <= tail_last;
        {%- if zones %}
        count_class <= tail_class;
        {%- endif %}
    end
{%- endif %}
{%- if zones %}

    // The class in the frame that is counted, in the last complete frame (done), and in the frame that is decided.
    wire {= count =}_keen = {= count =}_class == 2'd2;
    {%- if tail_delay %}
    reg [1:0] done_class;
    {%- if second_pass %}
    reg [1:0] decided_class;
    {%- endif %}
    always @(posedge clk_i) begin
        if ({= count =}_step && {= count =}_last) begin
            done_class <= {= count =}_class;
            {%- if second_pass %}
            decided_class <= done_class;
            {%- endif %}
        end
    end
    wire unused_held_class = |held_class;
    {%- else %}
    wire [1:0] done_class = held_class;
    {%- endif %}
    {%- if !second_pass %}
    wire [1:0] decided_class = done_class;
    {%- endif %}
    wire decided_keen = decided_class == 2'd2;
    {%- if segment.is_some() %}
    wire done_keen = done_class == 2'd2;
    {%- endif %}
{%- endif %}

    wire done, stored, second;
    frame_progress u_progress (
        .clk_i(clk_i), .rst_i(rst_i), .step_i({= count =}_step), .last_i({= count =}_last),
        .done_o(done), .stored_o(stored), .second_o(second)
    );
    wire decided = {% if second_pass %}done && second{% else %}done{% endif %};
    assign decision_valid_o = decided;
    wire srs, forward;

    // The stored frames, which are read as they are overwritten.
    wire [{= p - 1 =}:0] previous_pixel;
    frame_store #(.WIDTH({= p =}), .PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =})) u_previous (
        .clk_i(clk_i), .write_i(tail_step), .address_i(tail_address), .data_i(tail_pixel), .data_o(previous_pixel)
    );
{%- if keeps_second %}
    wire [{= p - 1 =}:0] second_pixel;
    frame_store #(.WIDTH({= p =}), .PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =})) u_second (
        .clk_i(clk_i), .write_i(tail_step), .address_i(tail_address), .data_i(previous_pixel), .data_o(second_pixel)
    );
{%- endif %}
{%- if keeps_raw %}
    wire [{= p - 1 =}:0] previous_raw;
    frame_store #(.WIDTH({= p =}), .PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =})) u_previous_raw (
        .clk_i(clk_i), .write_i(tail_step), .address_i(tail_address), .data_i(tail_raw), .data_o(previous_raw)
    );
    {%- if second_pass %}
    wire [{= p - 1 =}:0] second_raw;
    frame_store #(.WIDTH({= p =}), .PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =})) u_second_raw (
        .clk_i(clk_i), .write_i(tail_step), .address_i(tail_address), .data_i(previous_raw), .data_o(second_raw)
    );
    {%- endif %}
{%- endif %}

    // Temporal score.
{%- if last_sent %}
    wire [{= p - 1 =}:0] sent_pixel;
    wire sent_valid;
    {%- if deep %}
    deep_last_sent #(.WIDTH({= p =}), .PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =}), .BLANKS({= blanks =})) u_last_sent (
        .clk_i(clk_i), .rst_i(rst_i), .address_i(tail_address), .pixel_i({= decided_pixel =}), .sent_o(sent_pixel),
        .step_i(count_step), .decided_i(decided), .srs_i(srs), .forward_i(forward), .valid_o(sent_valid)
    );
    {%- else %}
    last_sent #(.WIDTH({= p =}), .PIXELS({= pixels =}), .ADDRESS_BITS({= address_bits =}), .BLANKS({= blanks =})) u_last_sent (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(tail_step), .address_i(tail_address), .decided_i(decided),
        .srs_i(srs), .forward_i(forward), .pixel_i({= decided_pixel =}),
        .reference_o(sent_pixel), .valid_o(sent_valid)
    );
    {%- endif %}
{%- endif %}
{%- for name in compared %}
    wire {= name =}_changed;
    {%- if deep %}
    reg [{= p =}:0] {= name =}_difference;
    always @(posedge clk_i) {= name =}_difference <= {1'b0, tail_pixel} - {1'b0, {= name =}_pixel};
    magnitude_above #(.WIDTH({= p + 1 =})) u_{= name =}_change (
        .value_i({= name =}_difference), .level_i({= temporal_level =}), .above_o({= name =}_changed)
    );
    {%- else %}
    change_detector #(.WIDTH({= p =})) u_{= name =}_change (
        .pixel_i(tail_pixel), .reference_i({= name =}_pixel), .level_i({= temporal_level =}),
        .hit_o({= name =}_changed)
    );
    {%- endif %}
{%- endfor %}
{%- for reference in references %}
    wire [{= count_bits - 1 =}:0] {= reference.name =}_count;
    hit_counter #(.WIDTH({= count_bits =})) u_{= reference.name =}_count (
        .clk_i(clk_i), .rst_i(rst_i), .restart_i(done),
        .hit_i({= count =}_step && ({= reference.hit =})), .count_o({= reference.name =}_count)
    );
{%- endfor %}
{%- if references.len() > 1 %}
    wire [{= count_bits - 1 =}:0] temporal_count;
    candidate_count #(.WIDTH({= count_bits =}), .PIXELS({= pixels =})) u_temporal_count (
        .previous_sent_i(forward), .valid_i(sent_valid),
        .previous_count_i(previous_count), .sent_count_i(sent_count), .count_o(temporal_count)
    );
{%- else %}
    wire [{= count_bits - 1 =}:0] temporal_count = {= references[0].name =}_count;
{%- endif %}

    // Spatial scores.
{%- for feature in windowed %}
    wire [{= count_bits - 1 =}:0] {= feature.name =}_score;
    hit_counter #(.WIDTH({= count_bits =})) u_{= feature.name =}_count (
        .clk_i(clk_i), .rst_i(rst_i), .restart_i(done), .hit_i({= count =}_step && {% if !deep %}tail_{% endif %}{= feature.name =}_hit),
        .count_o({= feature.name =}_score)
    );
{%- endfor %}
{%- if let Some(variance) = variance %}
    wire [{= variance.square_bits - 1 =}:0] square = front_pixel * front_pixel;
    wire [{= variance.square_sum_bits - 1 =}:0] square_sum;
    wire square_done;
    {%- if deep %}
    reg [{= variance.square_bits - 1 =}:0] square_q;
    reg square_step_q, square_last_q;
    always @(posedge clk_i) begin
        square_q      <= square;
        square_step_q <= front_step && !rst_i;
        square_last_q <= front_last;
    end
    {%- endif %}
    region_sum #(.WIDTH({= variance.square_bits =}), .SUM_BITS({= variance.square_sum_bits =})) u_square_sum (
        .clk_i(clk_i), .rst_i(rst_i), .step_i({% if deep %}square_step_q{% else %}front_step{% endif %}), .last_i({% if deep %}square_last_q{% else %}front_last{% endif %}),
        .value_i(square{% if deep %}_q{% endif %}), .done_o(square_done), .sum_o(square_sum)
    );
    wire [{= variance.score_bits - 1 =}:0] variance_score;
    variance_score #(
        .PIXELS({= pixels =}), .SUM_BITS({= sum_bits =}), .SQUARE_SUM_BITS({= variance.square_sum_bits =}),
        .PRODUCT_BITS({= variance.product_bits =}), .SCORE_BITS({= variance.score_bits =}){% if deep %}, .DEEP(1){% endif %}
    ) u_variance (
        .clk_i(clk_i), .rst_i(rst_i), .done_i(square_done), .sum_i(pixel_sum), .square_sum_i(square_sum),
        .score_o(variance_score)
    );
    {%- if mean.is_none() %}
    wire unused_sum_done = sum_done;
    {%- endif %}
{%- endif %}
{%- if range %}
    {%- if deep %}
    reg [{= p - 1 =}:0] range_pixel_q;
    reg range_step_q, range_last_q;
    always @(posedge clk_i) begin
        range_pixel_q <= front_pixel;
        range_step_q  <= front_step && !rst_i;
        range_last_q  <= front_last;
    end
    {%- endif %}
    wire [{= p - 1 =}:0] range_score;
    region_range #(.WIDTH({= p =})) u_range (
        .clk_i(clk_i), .rst_i(rst_i), .step_i({% if deep %}range_step_q{% else %}front_step{% endif %}), .last_i({% if deep %}range_last_q{% else %}front_last{% endif %}),
        .value_i({% if deep %}range_pixel_q{% else %}front_pixel{% endif %}), .range_o(range_score)
    );
{%- endif %}
{%- if let Some(surface_bits) = surface_bits %}
    wire [{= surface_bits - 1 =}:0] surface_score;
    region_surface #(.WIDTH({= p =}), .SCORE_BITS({= surface_bits =}){% if deep %}, .DEEP(1){% endif %}) u_surface (
        .clk_i(clk_i), .rst_i(rst_i), .advance_i(window_advance), .step_i(front_step), .last_i(front_last),
        .left_i(window_left), .right_i(window_right), .middle_i(window_middle), .lower_i(window_lower),
        .score_o(surface_score)
    );
    {%- if windowed.is_empty() %}
    wire unused_window_upper = |window_upper;
    {%- endif %}
{%- endif %}
{%- if let Some(mean) = mean %}
    wire [{= mean.bits - 1 =}:0] mean;
    region_mean #(
        .SUM_BITS({= sum_bits =}), .FRACTION({= mean.fraction =}), .DIVIDEND_BITS({= mean.dividend_bits =}),
        .MEAN_BITS({= mean.bits =}), .FACTOR_BITS({= mean.factor_bits =}),
        .HALF({= mean.dividend_bits =}'d{= pixels / 2 =}), .FACTOR({= mean.factor_bits =}'d{= mean.factor =}), .SHIFT({= mean.shift =})
    ) u_mean (
        .clk_i(clk_i), .done_i(sum_done), .sum_i(pixel_sum), .mean_o(mean)
    );
    {%- if let Some(mad_bits) = mad_bits %}
    wire [{= mad_bits - 1 =}:0] mad_score;
    deviation_sum #(
        .WIDTH({= p =}), .FRACTION({= mean.fraction =}), .MEAN_BITS({= mean.bits =}), .SUM_BITS({= mad_bits =}){% if deep %}, .DEEP(1){% endif %}
    ) u_deviation (
        .clk_i(clk_i), .rst_i(rst_i), .enable_i(stored), .restart_i(done), .step_i({= count =}_step),
        .pixel_i(previous_pixel), .mean_i(mean), .sum_o(mad_score)
    );
    {%- endif %}
    {%- if let Some(segment) = segment %}
    wire [{= segment.score_bits - 1 =}:0] segment_score;
    segment_score #(
        .WIDTH({= p =}), .FRACTION({= mean.fraction =}), .MEAN_BITS({= mean.bits =}), .PIXELS({= pixels =}), .SCORE_BITS({= segment.score_bits =}){% if deep %}, .DEEP(1){% endif %}
    ) u_segment (
        .clk_i(clk_i), .rst_i(rst_i), .enable_i(stored), .restart_i(done), .step_i({= count =}_step),
        .pixel_i(previous_pixel), .mean_i(mean), .level_i({= segment.level =}), .score_o(segment_score)
    );
    {%- endif %}
{%- endif %}

    // Decision.
{%- for score in scores %}
    {%- if score.is_held %}
    score_hold #(.WIDTH({= score.width =})) u_{= score.name =}_hold (
        .clk_i(clk_i), .rst_i(rst_i), .load_i(done), .score_i({= score.name =}), .score_o({= score.name =}_o)
    );
    {%- else %}
    assign {= score.name =}_o = {= score.name =};
    {%- endif %}
    wire {= score.name =}_vote;
    vote #(.WIDTH({= score.width =})) u_{= score.name =}_vote (
        .score_i({= score.name =}_o), .minimum_i({= score.minimum =}), .vote_o({= score.name =}_vote)
    );
{%- endfor %}
    decision #(.FEATURES({= votes.len() =}), .ALL({= all =})) u_decision (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(decided),
        .votes_i({% if zones %}decided_class[0] ? { {{= votes.len() =} {decided_class[1]} } } : {% endif %}{ {%- for vote in votes %}{% if !loop.first %}, {% endif %}{= vote =}_vote{% endfor -%} }), .trs_i(temporal_count_vote),
        .srs_o(srs), .trs_o(trs_o), .active_o(active_o), .forward_o(forward)
    );
    assign srs_o = srs;
{%- if let Some(periphery) = periphery %}

    // Summaries of irrelevant regions.
    wire mean_leaves;
    wire [{= p - 1 =}:0] leaving_mean;
    region_summary #(
        .WIDTH({= p =}), .SIDE({= n =}), .BLOCKS({= periphery.blocks =}), .ADDRESS_BITS({= address_bits =}){% if window && !shared %}, .AHEAD(1){% endif %},
        .SUM_BITS({= periphery.sum_bits =}), .FACTOR_BITS({= periphery.factor_bits =}), .FACTOR({= periphery.factor_bits =}'d{= periphery.factor =}), .SHIFT({= periphery.shift =}){% if second_pass %}, .SECOND(1){% endif %}{% if deep %}, .DEEP(1){% endif %}
    ) u_summary (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(tail_step), .address_i(tail_address), .pixel_i({= periphery.pixel =}),
        .done_i(done), .decided_i(decided), .srs_i(srs), .active_i(active_o), .level_i({= periphery.level =}),
        .summary_o(summary_o), .leaves_o(mean_leaves), .mean_o(leaving_mean)
    );
{%- endif %}

    // Pixels that are forwarded.
    {%- if deep %}
    reg [{= p - 1 =}:0] leaving_pixel;
    always @(posedge clk_i) leaving_pixel <= {= forward_pixel =};
    {%- endif %}
    forward_gate #(.WIDTH({= p =})) u_forward (
        .clk_i(clk_i), .rst_i(rst_i), .step_i({= count =}_step),
        {%- if periphery.is_some() %}
        .forward_i(forward || mean_leaves), .pixel_i(mean_leaves ? leaving_mean : {% if deep %}leaving_pixel{% else %}{= forward_pixel =}{% endif %}),
        {%- else %} .forward_i(forward), .pixel_i({% if deep %}leaving_pixel{% else %}{= forward_pixel =}{% endif %}),
        {%- endif %}
        .valid_o(forward_valid_o), .pixel_o(forward_pixel_o)
    );
{%- for name in unused %}
    wire unused_{= name =} = {= name =};
{%- endfor %}

endmodule

`default_nettype wire
