// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the frame synchronization, in front of each organization.

use super::fault_designs::FaultDesign::{
    SyncPipelined as Pipelined, SyncRaster as Raster, SyncSerial as Serial,
};
use super::faults::{RtlFault, fault};

/// All faults, by module.
#[rustfmt::skip]
pub(crate) const FAULTS: &[RtlFault] = &[
    fault("operator", Pipelined, "frame_sync", "fits = inside_q != sof_i;", "fits = inside_q || sof_i;"),
    fault("operator", Raster, "frame_sync", "fits = inside_q != sof_i;", "fits = inside_q == sof_i;"),
    fault("operator", Pipelined, "frame_sync", "comes = open_i && valid_i && !fill_q;", "comes = open_i && valid_i;"),
    fault("operator", Raster, "frame_sync", "comes = open_i && valid_i && !fill_q;", "comes = valid_i && !fill_q;"),
    fault("operator", Serial, "frame_sync", "passes = open_i && valid_o;", "passes = valid_o;"),
    fault("operator", Raster, "frame_sync", "ready_o = open_i && !fill_q;", "ready_o = open_i;"),
    fault("operator", Pipelined, "frame_sync", "valid_o = fill_q || (valid_i && fits);", "valid_o = valid_i && (fill_q || fits);"),
    fault("operator", Serial, "frame_sync", "valid_o = fill_q || (valid_i && fits);", "valid_o = valid_i && fits;"),
    fault("constant", Raster, "frame_sync", "BEFORE_LAST = BEATS - 2;", "BEFORE_LAST = BEATS - 1;"),
    fault("constant", Pipelined, "frame_sync", "BEFORE_LAST = BEATS - 2;", "BEFORE_LAST = BEATS - 3;"),
    fault("width", Serial, "frame_sync", "beat_q + 1'b1;", "{1'b0, beat_q[BEAT_BITS-2:0] + 1'b1};"),
    fault("operator", Pipelined, "frame_sync", "start_q  <= last_q && !fill_q;", "start_q  <= last_q;"),
    fault("constant", Serial, "frame_sync", "if (last_q) fill_q <= 1'b0;", ""),
    fault("constant", Raster, "frame_sync", "fill_q  <= inside_q;", "fill_q  <= 1'b0;"),
    fault("constant", Pipelined, "frame_sync", "            start_q <= 1'b0;\n        end\n        error_q", "        end\n        error_q"),
    fault("operator", Serial, "frame_sync", "(inside_q || start_q)", "inside_q"),
    fault("operator", Pipelined, "frame_sync", "(inside_q || start_q)", "1'b1"),
    fault("reset", Pipelined, "frame_sync", "            inside_q <= 1'b0;\n", ""),
    fault("reset", Raster, "frame_sync", "            fill_q   <= 1'b0;\n", ""),
    fault("reset", Serial, "frame_sync", "            start_q  <= 1'b0;\n", ""),
    fault("reset", Pipelined, "frame_sync", "            beat_q   <= {BEAT_BITS{1'b0}};\n", ""),

    fault("constant", Pipelined, "rcm", "BEATS = 9;", "BEATS = 8;"),
    fault("index", Pipelined, "rcm", ".valid_i(beat)", ".valid_i(valid_i)"),
    fault("constant", Serial, "rcm", "BEATS = COLUMNS * ROWS * 16;", "BEATS = ROWS * 16;"),
    fault("constant", Raster, "rcm", "(COLUMNS * 4 - 3) * (ROWS * 4 - 1)", "(COLUMNS * 4 - 3) * (ROWS * 4)"),
];
