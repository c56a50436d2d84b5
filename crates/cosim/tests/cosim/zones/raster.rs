// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cores of `raster` with zones.

use super::{ZonedDesign, check_designs};
use foveate_cosim::Simulator;

/// Designs in which the class of a region reaches the parts of the core after different delays:
/// plain and deep, with none, one and two windows, with and without a second pass, with words of
/// one and more pixels.
const DESIGNS: [ZonedDesign; 14] = [
    ZonedDesign {
        purpose: "two windows",
        grid: (5, 3),
        toml: "region.size = 4\nspatial = [{ feature = 'edge' }, { feature = 'corner' }]\n\
               hardware.organization = 'raster'\n",
    },
    ZonedDesign {
        purpose: "one window: `corner` alone",
        grid: (4, 3),
        toml: "region.size = 4\ndenoise.filter = 'none'\nspatial = [{ feature = 'corner' }]\n\
               hardware.organization = 'raster'\n",
    },
    ZonedDesign {
        purpose: "no window, and a second pass",
        grid: (4, 3),
        toml: "region.size = 4\ndenoise.filter = 'none'\nspatial = [{ feature = 'segment', min_score = 2 }]\n\
               hardware.organization = 'raster'\n",
    },
    ZonedDesign {
        purpose: "no window, no second pass",
        grid: (6, 2),
        toml: "region.size = 3\ndenoise.filter = 'none'\nspatial = [{ feature = 'variance' }]\n\
               hardware.organization = 'raster'\n",
    },
    ZonedDesign {
        purpose: "a word for each row of a region",
        grid: (16, 2),
        toml: "region.size = 4\nregion.neighborhood = 'shared'\nhardware = { organization = 'raster', pixels_per_clock = 4 }\n\
               spatial = [{ feature = 'corner' }, { feature = 'surface' }]\n",
    },
    ZonedDesign {
        purpose: "deep, with sums",
        grid: (8, 3),
        toml: "region.size = 4\nhardware = { organization = 'raster', pixels_per_clock = 2, pipelining = 'deep' }\n\
               spatial = [{ feature = 'edge' }, { feature = 'corner' }, { feature = 'variance' }]\ndecision.combine = 'all'\n",
    },
    ZonedDesign {
        purpose: "deep, one window, with a second pass and means",
        grid: (5, 4),
        toml: "region.size = 4\nhardware = { organization = 'raster', pipelining = 'deep' }\n\
               spatial = [{ feature = 'segment', min_score = 2 }, { feature = 'range' }]\nrender.irrelevant = 'mean'\n",
    },
    ZonedDesign {
        purpose: "means and raw pixels",
        grid: (4, 3),
        toml: "region.size = 4\nrender = { irrelevant = 'mean', payload = 'raw' }\ntemporal.reference = 'last-sent'\n\
               hardware.organization = 'raster'\n",
    },
    ZonedDesign {
        purpose: "one mean, deep",
        grid: (4, 3),
        toml: "region.size = 5\nrender.irrelevant = 'mean'\nspatial = [{ feature = 'corner' }]\n\
               hardware = { organization = 'raster', pipelining = 'deep' }\n",
    },
    ZonedDesign {
        purpose: "last-sent with a second pass, and frames that are waited for",
        grid: (4, 2),
        toml: "region.size = 4\nspatial = [{ feature = 'mad' }]\ntemporal.reference = 'last-sent'\n\
               hardware.organization = 'raster'\n",
    },
    ZonedDesign {
        purpose: "an external store and decisions alone",
        grid: (4, 3),
        toml: "region.size = 4\nspatial = [{ feature = 'edge' }, { feature = 'variance' }]\n\
               hardware = { organization = 'raster', store = 'external', forward = false, pipelining = 'deep' }\n",
    },
    ZonedDesign {
        purpose: "the start of frames",
        grid: (4, 3),
        toml: "region.size = 4\nhardware = { organization = 'raster', sync = true }\n",
    },
    ZonedDesign {
        purpose: "constant thresholds",
        grid: (4, 3),
        toml: "region.size = 4\nhardware = { organization = 'raster', thresholds = 'constant' }\n\
               spatial = [{ feature = 'edge', level = 300, min_score = 4 }]\nrender.irrelevant = 'mean'\n\
               zones = { off_level = 40, areas = [{ class = 'keen', rectangle = [4, 0, 8, 8] }, { class = 'off', \
               rectangle = [0, 8, 4, 4] }, { class = 'always', rectangle = [12, 4, 4, 8] }], keen = { \
               spatial = [{ feature = 'edge', level = 60, min_score = 2 }], temporal = { level = 2, min_count = 1 }, \
               periphery = { level = 1 } } }\n",
    },
    ZonedDesign {
        purpose: "constant thresholds, deep, with a second pass",
        grid: (4, 3),
        toml: "region.size = 4\nhardware = { organization = 'raster', thresholds = 'constant', pipelining = 'deep' }\n\
               spatial = [{ feature = 'segment', level = 40, min_score = 4 }, { feature = 'corner', level = 60, min_score = 3 }]\n\
               zones = { areas = [{ class = 'keen', rectangle = [0, 0, 16, 12] }], keen = { temporal = { level = 1 }, \
               spatial = [{ feature = 'segment', level = 3, min_score = 1 }, { feature = 'corner', level = 9 }] } }\n",
    },
];

#[test]
fn raster_cores_with_zones_agree() {
    check_designs(&DESIGNS, Simulator::Iverilog);
}
