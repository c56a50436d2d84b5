// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the periphery of an array on AXI: one for each kind of check. Mutation
//! (`scripts/mutation.sh`) changes every line of its modules. After a change of the RTL, a text
//! that is no longer found is replaced by one with the same effect.

/// A small core without parts that take long to build.
pub(crate) const SMALL: &[&str] = &[
    "frame={width=60,height=27}",
    "region.size=4",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
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

/// A core with zones whose map takes more than one word, with means of regions that are off.
pub(crate) const ZONED: &[&str] = &[
    "frame={width=64,height=44}",
    "region.size=4",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
    "render.irrelevant='mean'",
    "zones={off_level=20,areas=[{class='off',rectangle=[0,0,32,44]}],keen={temporal={level=2},spatial=[{feature='variance',min_score=1}]}}",
];

/// A core with zones whose array waits for the sink behind a frame, because the frame has two rows.
pub(crate) const SHALLOW: &[&str] = &[
    "frame={width=64,height=8}",
    "region.size=4",
    "denoise.filter='none'",
    "spatial=[{feature='variance'}]",
    "render.irrelevant='mean'",
    "zones={off_level=20,areas=[{class='off',rectangle=[0,0,32,8]}],keen={temporal={level=2}}}",
];

/// A fault: one edit of one file, and the check that must find it.
pub(crate) struct BusFault {
    /// The check that the fault proves.
    pub(crate) check: &'static str,
    /// The port at which the core must differ.
    pub(crate) port: &'static str,
    /// The design in which the fault is planted.
    pub(crate) design: &'static [&'static str],
    /// The module whose file is edited.
    pub(crate) module: &'static str,
    /// The text, which the file must contain exactly once.
    pub(crate) from: &'static str,
    pub(crate) to: &'static str,
}

pub(crate) const FAULTS: [BusFault; 25] = [
    BusFault {
        check: "the bytes of a packet",
        port: "m_axis_packets",
        design: SMALL,
        module: "packet_crc",
        from: "32'hEDB88320",
        to: "32'hEDB88321",
    },
    BusFault {
        check: "the means of a region",
        port: "m_axis_packets",
        design: MEANS,
        module: "packet_regions",
        from: "summary ? ONE",
        to: "1'b0 ? ONE",
    },
    BusFault {
        check: "a word that waits for the sink",
        port: "m_axis_packets",
        design: SMALL,
        module: "packet_writer",
        from: "wire step = !valid_o || ready_i;",
        to: "wire step = 1'b1;",
    },
    BusFault {
        check: "the order of packets: each REGION once, in its frame",
        port: "m_axis_packets",
        design: SMALL,
        module: "packet_writer",
        from: "region_frame_i == frame_i",
        to: "1'b1",
    },
    BusFault {
        check: "the counts of what was dropped",
        port: "m_axis_packets",
        design: SMALL,
        module: "packet_rows",
        from: "dropped_o = row_end && drops",
        to: "dropped_o = 1'b0",
    },
    BusFault {
        check: "a frame that must be skipped",
        port: "m_axis_packets",
        design: SMALL,
        module: "packet_frames",
        from: "behind_o = announced_q && !deciding_q",
        to: "behind_o = 1'b0",
    },
    BusFault {
        check: "the repair of damaged video",
        port: "m_axis_packets",
        design: SMALL,
        module: "axi_video",
        from: "first_word ? COPY : FILL",
        to: "COPY",
    },
    BusFault {
        check: "a threshold that holds from the next frame on",
        port: "m_axis_packets",
        design: LAST_SENT,
        module: "axi_registers",
        from: "        if (begin_i) temporal_level_taken_q <= temporal_level_q;\n",
        to: "",
    },
    BusFault {
        check: "the handshake of the video",
        port: "s_axis_video",
        design: SMALL,
        module: "axi_video",
        from: "LAST_LINE = LINES - 1",
        to: "LAST_LINE = LINES - 2",
    },
    BusFault {
        check: "the value of a register",
        port: "s_axi",
        design: SMALL,
        module: "axi_registers",
        from: "default: found = 32'd0",
        to: "default: found = 32'd1",
    },
    BusFault {
        check: "the handshake of the registers: an answer that waits",
        port: "s_axi_b",
        design: SMALL,
        module: "axi_registers",
        from: "answered_q <= write_q || (answered_q && !bready_i)",
        to: "answered_q <= write_q",
    },
    BusFault {
        check: "an event at the clock of its clear",
        port: "interrupt_o",
        design: SMALL,
        module: "axi_registers",
        from: "if (eol_early_i || interrupt_test",
        to: "if (eol_early_i && !(write_q && written == 10'd10) || interrupt_test",
    },
    BusFault {
        check: "the version of the map in a FRAME packet",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "if (frame_begins) frame_version_q",
        to: "if (opened) frame_version_q",
    },
    BusFault {
        check: "a commit while a frame begins",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "commit_q && !rst && !frame_begins && !opening_q",
        to: "commit_q && !rst && frame_begins",
    },
    BusFault {
        check: "the address of the window of classes",
        port: "s_axi",
        design: ZONED,
        module: "rcm_axi",
        from: "if (zone_write) zone_address_q",
        to: "if (zone_word_write) zone_address_q",
    },
    BusFault {
        check: "the version of a map in a FRAME packet that waits",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "if (frame_begins) frame_version_q <= version_q;",
        to: "frame_version_q <= version_q;",
    },
    BusFault {
        check: "a commit between the beginning of a frame and its first word",
        port: "m_axis_packets",
        design: SHALLOW,
        module: "rcm_axi",
        from: "commit_q && !rst && !frame_begins && !opening_q",
        to: "commit_q && !rst && !frame_begins",
    },
    BusFault {
        check: "a commit at the edge of a restart",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "!zone_write && !zone_commit;",
        to: "!zone_write;",
    },
    BusFault {
        check: "the bytes of a commit",
        port: "m_axis_packets",
        design: ZONED,
        module: "axi_registers",
        from: "wstrb_i[0]) zone_control_commit_q",
        to: "|wstrb_i) zone_control_commit_q",
    },
    BusFault {
        check: "the address after a reset",
        port: "s_axi",
        design: ZONED,
        module: "rcm_axi",
        from: "        if (rst) zone_address_q <= ",
        to: "        if (1'b0) zone_address_q <= ",
    },
    BusFault {
        check: "a commit that waits at a reset",
        port: "s_axi",
        design: ZONED,
        module: "rcm_axi",
        from: "        if (rst) zone_address_q <= ",
        to: "        if (rst) commit_q <= 1'b0;\n        if (rst) zone_address_q <= ",
    },
    BusFault {
        check: "a commit that a reset cancels",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "zone_commit_write && !zone_pending && !rst",
        to: "zone_commit_write && !zone_pending",
    },
    BusFault {
        check: "a commit in a reset",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "zone_commit = commit_q && !rst",
        to: "zone_commit = commit_q",
    },
    BusFault {
        check: "the first map in the second bank",
        port: "m_axis_packets",
        design: ZONED,
        module: "class_memory",
        from: "words_q[WORDS+i] = FIRST[32*i+:32]",
        to: "words_q[WORDS+i] = 32'd0",
    },
    BusFault {
        check: "a version that stays at a reset",
        port: "m_axis_packets",
        design: ZONED,
        module: "rcm_axi",
        from: "if (rst) zone_address_q",
        to: "if (rst) version_q <= 16'd0;\n        if (rst) zone_address_q",
    },
];
