// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the pipelined organization. After a change of the RTL, a text that is no longer
//! found is replaced by one with the same effect.

use super::planted_fault::{FaultDesign, PlantedFault};

/// A median, edges, and `previous` references.
const PAPER: FaultDesign = FaultDesign::unit("");
/// The same RPU, six times.
const PAPER_ARRAY: FaultDesign = FaultDesign::array("", (3, 2));
/// Mean absolute deviation and variance, with a second pass.
const MAD_VARIANCE: FaultDesign = FaultDesign::unit(
    "denoise.filter = 'none'\nspatial = [{ feature = 'mad', mean_fraction_bits = 2 }, { feature = 'variance' }]\n",
);
/// Edges and corners, both of which must vote.
const EDGE_AND_CORNER: FaultDesign = FaultDesign::unit(
    "denoise.filter = 'none'\ndecision.combine = 'all'\nspatial = [{ feature = 'edge' }, { feature = 'corner' }]\n",
);
/// Thresholds in the Verilog.
const CONSTANT: FaultDesign =
    FaultDesign::unit("region.size = 5\nhardware.thresholds = 'constant'\n");
/// Raw pixels, and references that were sent.
const LAST_SENT: FaultDesign =
    FaultDesign::unit("temporal.reference = 'last-sent'\nrender.payload = 'raw'\n");
/// Means of four blocks.
const MEANS: FaultDesign = FaultDesign::unit("render.irrelevant = 'mean'\n");
/// A deep array that finds its frames.
const SYNC: FaultDesign = FaultDesign::array(
    "region.size = 3\ndenoise.filter = 'none'\nspatial = [{ feature = 'mad' }]\n\
     hardware = { pipelining = 'deep', sync = true }\n",
    (2, 2),
);

pub(super) const FAULTS: [PlantedFault; 12] = [
    PlantedFault {
        check: "the temporal count",
        port: "temporal_count_o",
        design: PAPER,
        module: "change_detector",
        from: "pixel_i} - {",
        to: "pixel_i} + {",
    },
    PlantedFault {
        check: "a score of the first pass",
        port: "edge_score_o",
        design: PAPER,
        module: "edge_detector",
        from: "assign hit_o          = sum_above || diff_above;",
        to: "assign hit_o = sum_above;",
    },
    PlantedFault {
        check: "a score of the second pass",
        port: "mad_score_o",
        design: MAD_VARIANCE,
        module: "deviation_sum",
        from: "scaled < mean_i ? mean_i - scaled",
        to: "scaled < mean_i ? scaled - mean_i",
    },
    PlantedFault {
        check: "a reset in the middle of a frame",
        port: "temporal_count_o",
        design: MAD_VARIANCE,
        module: "rpu",
        from: "tail_step <= front_step && !rst_i;",
        to: "tail_step <= front_step;",
    },
    PlantedFault {
        check: "a threshold at a port: the score that equals it",
        port: "srs_o",
        design: PAPER,
        module: "vote",
        from: "score_i >= minimum_i",
        to: "score_i > minimum_i",
    },
    PlantedFault {
        check: "a constant threshold: the score that equals it",
        port: "srs_o",
        design: CONSTANT,
        module: "rpu",
        from: "EDGE_MIN = 5'd5",
        to: "EDGE_MIN = 5'd4",
    },
    PlantedFault {
        check: "the decision, from votes that differ",
        port: "srs_o",
        design: EDGE_AND_CORNER,
        module: "decision",
        from: "ALL ? &votes_i",
        to: "!ALL ? &votes_i",
    },
    PlantedFault {
        check: "a forwarded word",
        port: "forward_pixel_o",
        design: LAST_SENT,
        module: "forward_gate",
        from: "pixel_o <= pixel_i;",
        to: "pixel_o <= {1'b0, pixel_i[WIDTH-2:0]};",
    },
    PlantedFault {
        check: "the valid bit of forwarded words",
        port: "forward_valid_o",
        design: PAPER,
        module: "forward_gate",
        from: "!step_i || !forward_i",
        to: "!step_i && !forward_i",
    },
    PlantedFault {
        check: "a summary, and when one is sent",
        port: "summary_o",
        design: MEANS,
        module: "region_summary",
        from: "if (active_i) shows_q",
        to: "if (srs_i) shows_q",
    },
    PlantedFault {
        check: "the pixels of one region beside those of another",
        port: "edge_score_o",
        design: PAPER_ARRAY,
        module: "rcm",
        from: "pixel_i[REGION*8+:8]",
        to: "pixel_i[(REGION^1)*8+:8]",
    },
    PlantedFault {
        check: "the error of a frame that has another length",
        port: "sync_error_o",
        design: SYNC,
        module: "frame_sync",
        from: "fits = inside_q != sof_i;",
        to: "fits = inside_q || sof_i;",
    },
];
