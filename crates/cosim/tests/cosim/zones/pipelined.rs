// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays of `pipelined` with zones.

use super::{ZonedDesign, check_designs};
use foveate_cosim::Simulator;

/// Designs whose classes travel through different registers: plain and deep, with and without
/// windows, and with and without a second pass.
const DESIGNS: [ZonedDesign; 12] = [
    ZonedDesign { purpose: "a median and edges", grid: (3, 2), toml: "region.size = 4\n" },
    ZonedDesign {
        purpose: "no window at all",
        grid: (3, 2),
        toml: "region.size = 3\ndenoise.filter = 'none'\nspatial = [{ feature = 'variance' }]\n",
    },
    ZonedDesign {
        purpose: "no window, and no register in front of the tail",
        grid: (3, 2),
        toml: "region.size = 2\nspatial = [{ feature = 'edge', level = 9, min_score = 2 }]\ntemporal.min_count = 2\n\
         region.neighborhood = 'shared'\ndenoise.filter = 'none'\n",
    },
    ZonedDesign {
        purpose: "two windows, shared",
        grid: (3, 2),
        toml: "region.size = 4\nregion.neighborhood = 'shared'\nspatial = [{ feature = 'edge' }, { feature = 'corner' }]\n\
         decision.combine = 'all'\ntemporal.reference = 'last-sent'\n",
    },
    ZonedDesign {
        purpose: "a second pass",
        grid: (3, 2),
        toml: "region.size = 4\nspatial = [{ feature = 'segment', min_score = 3 }, { feature = 'mad' }]\n",
    },
    ZonedDesign {
        purpose: "a second pass with last-sent",
        grid: (3, 2),
        toml: "region.size = 4\ndenoise.filter = 'none'\nspatial = [{ feature = 'segment', min_score = 3 }, { feature = 'edge' }]\n\
         temporal.reference = 'last-sent'\nrender = { irrelevant = 'mean', payload = 'raw' }\n",
    },
    ZonedDesign {
        purpose: "four means",
        grid: (3, 2),
        toml: "region.size = 4\nrender.irrelevant = 'mean'\nzones.off_level = 9\n",
    },
    ZonedDesign {
        purpose: "one mean",
        grid: (3, 2),
        toml: "region.size = 5\nrender.irrelevant = 'mean'\nspatial = [{ feature = 'corner' }]\n",
    },
    ZonedDesign {
        purpose: "deep",
        grid: (3, 2),
        toml: "region.size = 4\nhardware.pipelining = 'deep'\nspatial = [{ feature = 'edge' }, { feature = 'corner' }]\n",
    },
    ZonedDesign {
        purpose: "deep, with a second pass and means",
        grid: (3, 2),
        toml: "region.size = 4\nhardware.pipelining = 'deep'\nspatial = [{ feature = 'segment', min_score = 3 }, { feature = 'range' }]\n\
         temporal.reference = 'last-sent'\nrender.irrelevant = 'mean'\nregion.neighborhood = 'shared'\n",
    },
    ZonedDesign {
        purpose: "constant thresholds",
        grid: (3, 2),
        toml: "region.size = 4\nhardware.thresholds = 'constant'\nspatial = [{ feature = 'edge', level = 300, min_score = 4 }]\n\
         render.irrelevant = 'mean'\nzones = { off_level = 40, keen = { spatial = [{ feature = 'edge', level = 60, min_score = 2 }], \
         temporal = { level = 2, min_count = 1 }, periphery = { level = 1 } } }\n",
    },
    ZonedDesign {
        purpose: "constant thresholds, deep, with a second pass",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { thresholds = 'constant', pipelining = 'deep' }\n\
         spatial = [{ feature = 'segment', level = 40, min_score = 4 }]\nzones = { keen = { temporal = { level = 1 }, \
         spatial = [{ feature = 'segment', level = 3, min_score = 1 }] } }\n",
    },
];

#[test]
fn pipelined_arrays_with_zones_agree() {
    check_designs(&DESIGNS, Simulator::Iverilog);
}
