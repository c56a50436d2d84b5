// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays of `serial` with zones.

use super::{ZonedDesign, check_designs};
use foveate_cosim::Simulator;

/// Designs in which the classes of regions reach their lanes after different delays, and in which
/// lanes use a level in every kind of step.
const DESIGNS: [ZonedDesign; 11] = [
    ZonedDesign {
        purpose: "a lane for each region",
        grid: (3, 2),
        toml: "region.size = 4\nhardware.organization = 'serial'\n",
    },
    ZonedDesign {
        purpose: "empty slots",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 4, feed = 'raster' }\n\
               spatial = [{ feature = 'edge' }, { feature = 'corner' }]\ndenoise.filter = 'none'\n",
    },
    ZonedDesign {
        purpose: "one lane",
        grid: (3, 1),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 3 }\nregion.neighborhood = 'shared'\n\
               spatial = [{ feature = 'corner' }, { feature = 'variance' }]\ndecision.combine = 'all'\n",
    },
    ZonedDesign {
        purpose: "deep, with block memory and an operand register",
        grid: (2, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2, pipelining = 'deep', memory = 'block' }\n\
               spatial = [{ feature = 'edge' }, { feature = 'mad' }]\n",
    },
    ZonedDesign {
        purpose: "deep, with distributed memory",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2, pipelining = 'deep', feed = 'raster' }\n\
               spatial = [{ feature = 'corner' }]\ndenoise.filter = 'binomial3x3'\n",
    },
    ZonedDesign {
        purpose: "a switching median and `segment`",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2 }\ndenoise.filter = 'switching3x3'\n\
               spatial = [{ feature = 'segment', min_score = 2 }]\ntemporal.reference = 'last-sent'\n",
    },
    ZonedDesign {
        purpose: "`flow` and `surface`",
        grid: (2, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2, feed = 'raster' }\ndenoise.filter = 'none'\n\
               spatial = [{ feature = 'flow' }, { feature = 'surface' }, { feature = 'edge' }]\n",
    },
    ZonedDesign {
        purpose: "four means",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2 }\nrender.irrelevant = 'mean'\nzones.off_level = 9\n",
    },
    ZonedDesign {
        purpose: "one mean, with raster feed, deep",
        grid: (3, 2),
        toml: "region.size = 5\nhardware = { organization = 'serial', fold = 3, feed = 'raster', pipelining = 'deep' }\n\
               spatial = [{ feature = 'range' }]\nrender = { irrelevant = 'mean', payload = 'raw' }\n",
    },
    ZonedDesign {
        purpose: "the start of frames",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2, sync = true }\n",
    },
    ZonedDesign {
        purpose: "constant thresholds",
        grid: (3, 2),
        toml: "region.size = 4\nhardware = { organization = 'serial', fold = 2, thresholds = 'constant' }\n\
               spatial = [{ feature = 'edge', level = 300, min_score = 4 }]\nrender.irrelevant = 'mean'\n\
               zones = { off_level = 40, areas = [{ class = 'keen', rectangle = [4, 0, 8, 4] }, { class = 'off', \
               rectangle = [0, 4, 4, 4] }, { class = 'always', rectangle = [8, 4, 4, 4] }], keen = { \
               spatial = [{ feature = 'edge', level = 60, min_score = 2 }], temporal = { level = 2, min_count = 1 }, \
               periphery = { level = 1 } } }\n",
    },
];

#[test]
fn serial_arrays_with_zones_agree() {
    check_designs(&DESIGNS, Simulator::Verilator);
}
