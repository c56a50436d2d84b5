{%- if let Some(sync) = sync %}

    // Only whole frames reach what is behind.
    localparam BEATS = {= sync.beats =};
    wire beat;
{%- if sync.is_always_open %}
    wire unused_ready;
{%- else %}
    wire open;
{%- endif %}

    frame_sync #(.BEATS(BEATS), .BEAT_BITS($clog2(BEATS))) u_sync (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .sof_i(sof_i), .open_i({% if sync.is_always_open %}1'b1{% else %}open{% endif %}),
        .ready_o({% if sync.is_always_open %}unused_ready{% else %}ready_o{% endif %}), .valid_o(beat), .error_o(sync_error_o)
    );
{%- endif %}
