// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the serial organization. After a change of the RTL, a text that is no longer found
//! is replaced by one with the same effect.

use super::planted_fault::{FaultDesign, PlantedFault};

/// The paper's scores in small regions.
const PAPER: FaultDesign =
    FaultDesign::array("region.size = 4\nhardware.organization = 'serial'\n", (2, 1));
/// Edges and corners, both of which must vote.
const EDGE_AND_CORNER: FaultDesign = FaultDesign::array(
    "region.size = 4\ndenoise.filter = 'none'\ndecision.combine = 'all'\n\
     spatial = [{ feature = 'edge' }, { feature = 'corner' }]\nhardware.organization = 'serial'\n",
    (2, 1),
);
/// Displacements of regions.
const FLOW: FaultDesign = FaultDesign::array(
    "region.size = 4\ndenoise.filter = 'none'\nspatial = [{ feature = 'flow' }]\n\
     hardware.organization = 'serial'\n",
    (2, 1),
);
/// Pixels in the order of the frame.
const RASTER_FEED: FaultDesign = FaultDesign::array(
    "region.size = 4\ndenoise.filter = 'none'\nhardware = { organization = 'serial', feed = 'raster' }\n",
    (3, 2),
);
/// Two regions per lane, one of which is empty in the last lane.
const FOLDED: FaultDesign = FaultDesign::array(
    "region.size = 4\ndenoise.filter = 'none'\nhardware = { organization = 'serial', fold = 2 }\n",
    (3, 1),
);
/// Thresholds in the Verilog.
const CONSTANT: FaultDesign = FaultDesign::array(
    "region.size = 4\nhardware = { organization = 'serial', thresholds = 'constant' }\n",
    (2, 1),
);
/// Means of four blocks of raw pixels.
const MEANS: FaultDesign = FaultDesign::array(
    "region.size = 4\nrender = { payload = 'raw', irrelevant = 'mean' }\n\
     hardware = { organization = 'serial', fold = 2 }\n",
    (3, 1),
);
/// An array that finds its frames.
const SYNC: FaultDesign = FaultDesign::array(
    "region = { size = 4, neighborhood = 'shared' }\ndenoise.filter = 'none'\n\
     hardware = { organization = 'serial', feed = 'raster', sync = true }\n",
    (2, 2),
);

pub(super) const FAULTS: [PlantedFault; 12] = [
    PlantedFault {
        check: "the temporal count and the scores, which share a port",
        port: "score_o",
        design: PAPER,
        module: "carry_adder",
        from: "} - {~other_i",
        to: "} + {~other_i",
    },
    PlantedFault {
        check: "a displacement",
        port: "displacement_x_o",
        design: FLOW,
        module: "serial_flow",
        from: "preceding_q <= {y, x}",
        to: "preceding_q <= {x, y}",
    },
    PlantedFault {
        check: "a threshold at a port: the score that equals it",
        port: "srs_o",
        design: PAPER,
        module: "serial_decision",
        from: "score_o >= minimum;",
        to: "score_o > minimum;",
    },
    PlantedFault {
        check: "a constant threshold: the count that equals it",
        port: "trs_o",
        design: CONSTANT,
        module: "serial_decision",
        from: "score_o >= minimum;",
        to: "score_o > minimum;",
    },
    PlantedFault {
        check: "the decision, from votes that differ",
        port: "srs_o",
        design: EDGE_AND_CORNER,
        module: "serial_decision",
        from: "flags_i[1] && vote : flags_i[1] || vote",
        to: "flags_i[1] || vote : flags_i[1] || vote",
    },
    PlantedFault {
        check: "the handshake of pixels: when the array takes them",
        port: "ready_o",
        design: PAPER,
        module: "serial_parallel_feed",
        from: "LAST = PIXELS - 1;",
        to: "LAST = PIXELS - 2;",
    },
    PlantedFault {
        check: "a forwarded word",
        port: "forward_pixel_o",
        design: PAPER,
        module: "serial_array",
        from: "words[i*WIDTH+:WIDTH];\n            end",
        to: "words[0+:WIDTH];\n            end",
    },
    PlantedFault {
        check: "the valid bit of forwarded words",
        port: "forward_valid_o",
        design: RASTER_FEED,
        module: "serial_sequencer",
        from: "RASTER != 0 ? shifting : unloading",
        to: "unloading",
    },
    PlantedFault {
        check: "a slot without a region",
        port: "score_valid_o",
        design: FOLDED,
        module: "serial_decision",
        from: "region_i} < BEHIND",
        to: "region_i} <= BEHIND",
    },
    PlantedFault {
        check: "a summary, and when one is sent",
        port: "summary_o",
        design: MEANS,
        module: "serial_summary",
        from: "(!shows || differs)",
        to: "!shows",
    },
    PlantedFault {
        check: "the reset of the outputs",
        port: "score_valid_o",
        design: PAPER,
        module: "serial_shown",
        from: "if (rst_i) bits_q <= {(LATE + 1) * WIDTH{1'b0}};\n        else bits_q",
        to: "bits_q",
    },
    PlantedFault {
        check: "the error of a frame that has another length",
        port: "sync_error_o",
        design: SYNC,
        module: "frame_sync",
        from: "(inside_q || start_q)",
        to: "inside_q",
    },
];
