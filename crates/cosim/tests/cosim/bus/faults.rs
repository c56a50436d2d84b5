// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the periphery of an array on AXI. After a change of the RTL, a text that is no
//! longer found is replaced by one with the same effect.

/// A small core without parts that take long to build.
pub(crate) const SMALL: &[&str] = &[
    "frame={width=60,height=27}",
    "region.size=4",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
];
/// A core whose regions have an odd number of values, in parts of several values, and whose rows do
/// not fill a word.
pub(crate) const ODD: &[&str] = &[
    "frame={width=63,height=24}",
    "region.size=5",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
    "hardware.thresholds='constant'",
];
/// A core with means, raw pixels, and words of two pixels in lanes of 16 bits.
pub(crate) const MEANS: &[&str] = &[
    "frame={width=64,height=32,pixel_bits=10}",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
    "render={irrelevant='mean',payload='raw'}",
    "temporal.reference='last-sent'",
    "hardware.pixels_per_clock=2",
];

/// A core whose references depend on what was sent, and so on every threshold.
pub(crate) const LAST_SENT: &[&str] =
    &["frame={width=64,height=40}", "denoise.filter='none'", "temporal.reference='last-sent'"];

/// A core whose regions come faster than their places are known.
pub(crate) const SHORT_REGIONS: &[&str] = &[
    "frame={width=64,height=132}",
    "region.size=4",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
    "hardware.pixels_per_clock=4",
];

/// A fault: one edit of one file.
pub(crate) struct BusFault {
    /// The module whose file is edited.
    pub(crate) module: &'static str,
    /// The text, which the file must contain exactly once.
    pub(crate) from: &'static str,
    pub(crate) to: &'static str,
    /// The design in which the fault is planted.
    pub(crate) design: &'static [&'static str],
}

const fn fault(
    design: &'static [&'static str],
    module: &'static str,
    from: &'static str,
    to: &'static str,
) -> BusFault {
    BusFault { module, from, to, design }
}

/// All faults, by module.
#[rustfmt::skip]
pub(crate) const FAULTS: &[BusFault] = &[
    fault(SMALL, "packet_crc", "32'hEDB88320", "32'hEDB88321"),
    fault(SMALL, "packet_crc", "columns[from][to]", "columns[from][31-to]"),
    fault(SMALL, "packet_place", "next >= DIVISOR", "next > DIVISOR"),
    fault(ODD, "packet_place", "<= STEPS[STEP_BITS-1:0];", "<= STEPS[STEP_BITS-1:0] - 1'b1;"),

    fault(SMALL, "packet_rows", "trs_i, srs_i}", "srs_i, trs_i}"),
    fault(MEANS, "packet_rows", "DECISION_BITS == 4 && summary_i", "1'b0"),
    fault(SMALL, "packet_rows", "LAST_ROW = ROWS - 1", "LAST_ROW = ROWS - 2"),
    fault(SMALL, "packet_rows", "LAST_COLUMN = COLUMNS - 1", "LAST_COLUMN = COLUMNS - 2"),
    fault(SMALL, "packet_rows", "full_q[collect_q] : drops_q", "1'b0 : drops_q"),
    fault(SMALL, "packet_rows", "full_q[collect_q] : drops_q", "|full_q : drops_q"),
    fault(SMALL, "packet_rows", "dropped_o = row_end && drops", "dropped_o = 1'b0"),
    fault(SMALL, "packet_rows", "row_o = leave_q ?", "row_o = !leave_q ?"),
    fault(SMALL, "packet_rows", "valid_frame_o = frames_q[leave_q]", "valid_frame_o = frames_q[!leave_q]"),
    fault(SMALL, "packet_rows", "            column_q  <= {COLUMN_BITS{1'b0}};\n", ""),
    fault(SMALL, "packet_rows", "            full_q    <= 2'd0;\n", ""),
    fault(ODD, "packet_rows", "beyond_q ? {BITS{1'b0}} : found", "found"),

    fault(SMALL, "packet_regions", "ends = take && last_i && !abort_i", "ends = take && last_i"),
    fault(SMALL, "packet_regions", "ready_o = !full && !ending_q", "ready_o = !ending_q"),
    fault(SHORT_REGIONS, "packet_regions", "whole_o = (ends || ending_q) && !unknown", "whole_o = ends"),
    fault(MEANS, "packet_regions", "{frame_q, summary_q, row, column};", "{frame_q, !summary_q, row, column};"),
    fault(MEANS, "packet_regions", "summary ? ONE", "1'b0 ? ONE"),
    fault(SMALL, "packet_regions", "wire [VALUE_BITS:0] value = first_i ?", "wire [VALUE_BITS:0] value = 1'b0 ?"),
    fault(ODD, "packet_regions", "counts[lane] ? part", "1'b1 ? part"),
    fault(SMALL, "packet_regions", "            taken_q  <= {(PLACE_BITS + 1) {1'b0}};\n", ""),

    fault(SMALL, "packet_frames", "if (begin_i || skip_i) count_q", "if (begin_i) count_q"),
    fault(SMALL, "packet_frames", "admit_o = !announced_q && !deciding_q", "admit_o = !deciding_q"),
    fault(SMALL, "packet_frames", "if (announced_q && !open_q) number_q", "if (announced_q) number_q"),
    fault(SMALL, "packet_frames", "            first_q     <= 1'b0;\n", ""),
    fault(SMALL, "packet_frames", "behind_o = announced_q && !deciding_q", "behind_o = 1'b0"),
    fault(SMALL, "packet_frames", "closed_o = decided_q[frame_q] && ", "closed_o = decided_q[frame_q] || "),
    fault(SMALL, "packet_frames", "clear = rst_i || forget_i || (ended_i", "clear = rst_i || forget_i || (1'b0"),
    fault(SMALL, "packet_frames", "if (rst_i) count_q <= 32'd0;", ""),
    fault(SMALL, "packet_frames", "wire lost = lost_i && lost_frame_i == frame;", "wire lost = 1'b0;"),

    fault(SMALL, "packet_writer", "wire step = !valid_o || ready_i;", "wire step = 1'b1;"),
    fault(SMALL, "packet_writer", "\"ETAEVOF\"", "\"ETAEVOG\""),
    fault(SMALL, "packet_writer", "                if (last_q) crc_q <= 32'hFFFFFFFF;\n", ""),
    fault(MEANS, "packet_writer", "is_region && RAW != 0, flag_0", "1'b0, flag_0"),
    fault(SMALL, "packet_writer", "if (region_take_o) sent_q", "if (row_take_o) sent_q"),
    fault(SMALL, "packet_writer", "row_frame_i == frame_i", "1'b1"),
    fault(SMALL, "packet_writer", "region_frame_i == frame_i", "1'b1"),
    fault(SMALL, "packet_writer", "kind_q == END && any_dropped", "1'b0"),
    fault(SMALL, "packet_writer", "last_o = data_last_q", "last_o = 1'b0"),
    fault(SMALL, "packet_writer", "            crc_q        <= 32'hFFFFFFFF;\n", ""),
    fault(SMALL, "packet_writer", "            phase_q <= IDLE;\n            open_q  <= 1'b0;", "            open_q  <= 1'b0;"),

    fault(SMALL, "axi_video", "ready_o = !come_q || take;", "ready_o = !come_q || ready_i;"),
    fault(SMALL, "axi_video", "LAST_LINE = LINES - 1", "LAST_LINE = LINES - 2"),
    fault(SMALL, "axi_video", "if (too_short) state_q <= FILL;", "if (1'b0) state_q <= FILL;"),
    fault(SMALL, "axi_video", "else if (too_long) state_q <= DROP;", "else if (1'b0) state_q <= DROP;"),
    fault(SMALL, "axi_video", "last_line ? SEEK : LINE;", "LINE;"),
    fault(SMALL, "axi_video", "first_word ? COPY : FILL", "COPY"),
    fault(SMALL, "axi_video", "complete_q ? SEEK : LINE;", "LINE;"),
    fault(SMALL, "axi_video", "(!sof_q || skips)", "!sof_q"),
    fault(SMALL, "axi_video", "repair_o    <= !damaged_q && (", "repair_o    <= ("),
    fault(SMALL, "axi_video", "sof_late_o  <= too_late", "sof_late_o  <= 1'b0"),
    fault(MEANS, "axi_video", "come_pixel_q[(LANES-1)*WIDTH+:WIDTH]", "come_pixel_q[0+:WIDTH]"),
    fault(SMALL, "axi_video", "pass && state_q != COPY)", "1'b0)"),
    fault(SMALL, "axi_video", ".read_address_i(next_word)", ".read_address_i(word_q)"),
    fault(SMALL, "axi_video", "            state_q     <= SEEK;\n            word_q ", "            word_q "),

    fault(SMALL, "axi_registers", "        if (begin_i) temporal_level_taken_q", "        temporal_level_taken_q"),
    fault(SMALL, "axi_registers", "&& !write_q && !(answered_q", "&& !(answered_q"),
    fault(SMALL, "axi_registers", "answered_q <= write_q || (answered_q && !bready_i)", "answered_q <= write_q"),
    fault(SMALL, "axi_registers", "found_q    <= read_q || (found_q && !rready_i)", "found_q    <= read_q"),
    fault(SMALL, "axi_registers", "written == 10'd8 && wstrb_i[0]) control_wait_q", "written == 10'd8 && wstrb_i[0]) control_enable_q"),
    fault(SMALL, "axi_registers", "events_eol_late_q && interrupt_enable_eol_late_q", "interrupt_enable_eol_late_q"),
    fault(SMALL, "axi_registers", "        control_restart_q <= 1'b0;\n", ""),
    fault(SMALL, "axi_registers", "default: found = 32'd0", "default: found = 32'd1"),
    fault(SMALL, "axi_registers", "            control_enable_q <= 1'd1;", "            control_enable_q <= 1'd0;"),

    fault(SMALL, "rcm_axi", "(behind && !waits)", "behind"),
    fault(SMALL, "rcm_axi", "may_begin && enable && !restarting_q", "may_begin && enable"),
    fault(SMALL, "rcm_axi", "restarting_q && !busy && idle_video && idle_packets", "restarting_q"),
    fault(SMALL, "rcm_axi", "skips = frame_skipped && enable", "skips = frame_skipped"),
    fault(SMALL, "rcm_axi", "m_axis_packets_tkeep = 8'hFF", "m_axis_packets_tkeep = 8'h7F"),
    fault(SMALL, "rcm_axi", "if (lost_valid) dropped_q", "if (region_take) dropped_q"),
    fault(SMALL, "rcm_axi", "rst ? 64'd0 : time_q + 1'b1", "64'd0"),
    fault(SMALL, "rcm_axi", ".time_i(frame_time)", ".time_i(time_q)"),
    fault(MEANS, "rcm_axi", ".summary_level_i(summary_level)", ".summary_level_i(s_axis_video_tdata[9:0])"),

    fault(LAST_SENT, "axi_registers", "        if (begin_i) edge_level_taken_q <= edge_level_q;\n", ""),
    fault(LAST_SENT, "axi_registers", "        if (begin_i) edge_min_taken_q <= edge_min_q;\n", ""),
    fault(LAST_SENT, "axi_registers", "        if (begin_i) temporal_level_taken_q <= temporal_level_q;\n", ""),
    fault(LAST_SENT, "axi_registers", "        if (begin_i) temporal_min_taken_q <= temporal_min_q;\n", ""),
    fault(MEANS, "axi_registers", "        if (begin_i) variance_min_taken_q <= variance_min_q;\n", ""),
    fault(MEANS, "axi_registers", "        if (begin_i) summary_level_taken_q <= summary_level_q;\n", ""),
    fault(SMALL, "axi_registers", "if (row_dropped_i || interrupt_test", "if (row_dropped_i && !(write_q && written == 10'd10) || interrupt_test"),
    fault(SMALL, "axi_registers", "if (frame_done_i || interrupt_test", "if (frame_done_i && !(write_q && written == 10'd10) || interrupt_test"),
    fault(SMALL, "axi_registers", "if (eol_early_i || interrupt_test", "if (eol_early_i && !(write_q && written == 10'd10) || interrupt_test"),
    fault(SMALL, "axi_registers", "if (region_dropped_i || interrupt_test", "if (region_dropped_i && !(write_q && written == 10'd10) || interrupt_test"),
    fault(LAST_SENT, "raster_valid", "if (lost_i) lost_bits_q", "if (1'b0) lost_bits_q"),
];
