// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faults of the raster organization. After a change of the RTL, a text that is no longer found
//! is replaced by one with the same effect.

use super::planted_fault::{FaultDesign, PlantedFault};

/// The paper's scores, in a frame that the core completes on the right and below.
const PAPER: FaultDesign = FaultDesign::whole_frame(
    "frame = { width = 13, height = 14 }\nregion = { size = 4, neighborhood = 'shared' }\n\
     hardware.organization = 'raster'\n",
);
/// A deep core with words of two pixels, edges and corners, raw pixels that leave, and `last-sent`
/// references. It has few rows of regions, so that frames wait.
const LAST_SENT: FaultDesign = FaultDesign::whole_frame(
    "frame = { width = 31, height = 7 }\nregion.size = 4\ndecision.combine = 'all'\n\
     spatial = [{ feature = 'edge' }, { feature = 'corner' }]\ntemporal.reference = 'last-sent'\n\
     render.payload = 'raw'\nhardware = { organization = 'raster', pixels_per_clock = 2, pipelining = 'deep' }\n",
);
/// An external store, without forwarding.
const EXTERNAL: FaultDesign = FaultDesign::whole_frame(
    "frame = { width = 64, height = 8 }\nregion.size = 4\ndenoise.filter = 'none'\n\
     hardware = { organization = 'raster', pixels_per_clock = 4, pipelining = 'deep', store = 'external', forward = false }\n",
);
/// Means of four blocks, of regions that may be lost.
const MEANS: FaultDesign = FaultDesign::whole_frame(
    "frame = { width = 16, height = 15 }\nregion.size = 4\ndenoise.filter = 'none'\n\
     render.irrelevant = 'mean'\nhardware.organization = 'raster'\n",
);

pub(super) const FAULTS: [PlantedFault; 12] = [
    PlantedFault {
        check: "the temporal count",
        port: "temporal_count_o",
        design: PAPER,
        module: "raster_change",
        from: "word_i[lane*WIDTH+:WIDTH]} - {",
        to: "word_i[lane*WIDTH+:WIDTH]} + {",
    },
    PlantedFault {
        check: "a score",
        port: "edge_score_o",
        design: PAPER,
        module: "raster_edge",
        from: "hit_q <= sum_above || diff_above;",
        to: "hit_q <= sum_above;",
    },
    PlantedFault {
        check: "a threshold: the score that equals it",
        port: "srs_o",
        design: PAPER,
        module: "vote",
        from: "score_i >= minimum_i",
        to: "score_i > minimum_i",
    },
    PlantedFault {
        check: "the decision, from votes that differ",
        port: "srs_o",
        design: LAST_SENT,
        module: "raster_decision",
        from: "relevant = ALL ? &decided_votes",
        to: "relevant = ALL ? |decided_votes",
    },
    PlantedFault {
        check: "the handshake of pixels: when a frame must wait",
        port: "ready_o",
        design: LAST_SENT,
        module: "raster_control",
        from: "&& !busy_i;",
        to: ";",
    },
    PlantedFault {
        check: "a forwarded word",
        port: "forward_pixel_o",
        design: LAST_SENT,
        module: "raster_forward",
        from: "RAW ? raw_i : scored_i",
        to: "scored_i",
    },
    PlantedFault {
        check: "the handshake of forwarded words: a sink that is not ready",
        port: "forward_valid_o",
        design: PAPER,
        module: "raster_readout",
        from: "assign step_o = !valid_o || ready_i;",
        to: "assign step_o = ready_i;",
    },
    PlantedFault {
        check: "a loss, at the last clock at which a region may still leave",
        port: "lost_valid_o",
        design: PAPER,
        module: "raster_readout",
        from: "oldest_age >= AGE",
        to: "oldest_age > AGE",
    },
    PlantedFault {
        check: "the end of a region that is lost while it leaves",
        port: "forward_abort_o",
        design: PAPER,
        module: "raster_readout",
        from: "abort = held_stale && !first_o",
        to: "abort = held_stale",
    },
    PlantedFault {
        check: "the reset of a flag that stays",
        port: "lost_o",
        design: PAPER,
        module: "raster_forward",
        from: "            lost_o       <= 1'b0;\n",
        to: "",
    },
    PlantedFault {
        check: "a summary, and when one is sent",
        port: "summary_o",
        design: MEANS,
        module: "raster_decision",
        from: "(!decided_shown || decided_differs)",
        to: "decided_differs",
    },
    PlantedFault {
        check: "the handshake with an external store",
        port: "underrun_o",
        design: EXTERNAL,
        module: "raster_external",
        from: "reference_ready_o && !reference_valid_i",
        to: "!reference_valid_i",
    },
];
