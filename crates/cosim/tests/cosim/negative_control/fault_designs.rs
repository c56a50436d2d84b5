// SPDX-License-Identifier: MIT OR Apache-2.0
//! The designs in which faults are planted; together they use every module.

use crate::common::design;
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::{Design, DesignConfig};

/// A design in which faults are planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum FaultDesign {
    /// A median, edges, and `previous` references.
    Paper,
    /// Edges and corners without a filter, so that the counter of positions is that of the window.
    Corner,
    /// Mean absolute deviation and variance, without a window.
    MadVariance,
    /// Variance alone, whose result register is a port.
    Variance,
    /// Regions that do not fit into one bank of the frame store, and do not fill two.
    Banked,
    /// Mean absolute deviation with `last-sent` references, which has two candidates for the count.
    MadSent,
    /// Edges with `last-sent` references; raw pixels are forwarded.
    LastSent,
    /// A median and edges in `shared` neighborhoods.
    Shared,
    /// The paper's design with constant thresholds.
    Constant,
    /// A deep design with a median, edges and corners; raw pixels are forwarded.
    Deep,
    /// A deep design with edges and `last-sent` references.
    DeepSent,
    /// A deep design with mean absolute deviation, variance and `last-sent` references.
    DeepMadVariance,
    /// Means of four blocks, of pixels behind a window.
    Means,
    /// A deep design with means of raw pixels in blocks of 3x3.
    MeansDeep,
    /// One mean per region, with constant thresholds.
    MeansOne,
    /// Means of blocks of one pixel.
    MeansPixel,
    /// Means of blocks of 3x3 pixels, with a second pass.
    MeansSecond,
    /// A serial design with means of four blocks of raw pixels, and two slots per lane.
    SerialMeans,
    /// A deep serial design with means of blocks of 3x3 pixels and a raster feed.
    SerialMeansRaster,
    /// A deep serial design with means of blocks of one pixel, more than distributed memory takes.
    SerialMeansMany,
    /// A serial design with the paper's scores in small regions.
    SerialPaper,
    /// A serial design with edges alone and no filter.
    SerialEdge,
    /// A serial design with edges and corners, both of which must vote.
    SerialCorner,
    /// A serial design with mean absolute deviation alone.
    SerialMad,
    /// A serial design with variance and mean absolute deviation; the mean has more bits than the
    /// sum of a region.
    SerialVariance,
    /// A serial design with a raster feed, `shared` neighborhoods, folds and `last-sent`
    /// references.
    SerialSent,
    /// A serial design with a raster feed and `isolated` regions.
    SerialRaster,
    /// A serial design with two slots, one of which is empty in the last lane.
    SerialFold,
    /// A serial design with block memory.
    SerialBlock,
    /// A serial design with more than one group of lanes.
    SerialMany,
    /// A deep serial design with mean absolute deviation and edges, a raster feed and block memory.
    SerialDeep,
    /// A deep serial design with `shared` neighborhoods, `last-sent` references and pixels on every
    /// lane.
    SerialDeepSent,
    /// A serial design with a median, edges, corners and constant thresholds.
    SerialConstant,
    /// A raster core with the paper's scores, in a frame that the core completes on the right and
    /// below.
    RasterPaper,
    /// A deep raster core with words of two pixels, edges and corners, raw pixels that leave, and
    /// `last-sent` references. It has few rows of regions, so that frames wait.
    RasterSent,
    /// A raster core with mean absolute deviation and variance, a second pass, and no window.
    RasterMadVariance,
    /// A raster core with `last-sent` references, of regions that may be lost.
    RasterLost,
    /// A raster core with a frame of an odd number of words, in a memory with one port.
    RasterPairs,
    /// A deep raster core with more words than a bank of the store holds.
    RasterBanks,
    /// A raster core with an external store and without forwarding.
    RasterExternal,
    /// A raster core with means of four blocks, of regions that may be lost.
    RasterMeans,
    /// A deep raster core with means of raw pixels, blocks as wide as a word, and few rows of
    /// regions.
    RasterMeansDeep,
    /// A raster core with one mean of 3x3 pixels, and a second pass.
    RasterMeansOne,
    /// A raster core with means of four blocks, beside regions with `last-sent` references.
    RasterMeansSent,
    /// A deep array of RPUs with `sync` and a second pass.
    SyncPipelined,
    /// A serial array with `sync` and a raster feed.
    SyncSerial,
    /// A raster core with `sync`, of a frame that does not fill its last regions.
    SyncRaster,
}

impl FaultDesign {
    fn toml(self) -> &'static str {
        match self {
            Self::Paper => "",
            Self::Corner => {
                "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                 [[spatial]]\nfeature = \"corner\"\n[decision]\ncombine = \"all\"\n"
            }
            Self::MadVariance => {
                "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 mean_fraction_bits = 2\n[[spatial]]\nfeature = \"variance\"\n"
            }
            Self::Variance => "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"variance\"\n",
            Self::MadSent => {
                "[region]\nsize = 5\n[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 1\n\
                 [temporal]\nreference = \"last-sent\"\n"
            }
            Self::LastSent => {
                "[temporal]\nreference = \"last-sent\"\n[render]\npayload = \"raw\"\n"
            }
            Self::Banked => "[region]\nsize = 17\n",
            Self::Shared => "[region]\nneighborhood = \"shared\"\n",
            Self::Constant => "[region]\nsize = 5\n[hardware]\nthresholds = \"constant\"\n",
            Self::Deep => {
                "[[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"corner\"\n[render]\n\
                 payload = \"raw\"\n[hardware]\npipelining = \"deep\"\n"
            }
            Self::DeepSent => {
                "[denoise]\nfilter = \"none\"\n[temporal]\nreference = \"last-sent\"\n\
                 [hardware]\npipelining = \"deep\"\n"
            }
            Self::DeepMadVariance => {
                "[region]\nsize = 5\n[denoise]\nfilter = \"none\"\n[[spatial]]\n\
                 feature = \"mad\"\nmean_fraction_bits = 1\n[[spatial]]\nfeature = \"variance\"\n\
                 [temporal]\nreference = \"last-sent\"\n[hardware]\npipelining = \"deep\"\n"
            }
            Self::Means => "[render]\nirrelevant = \"mean\"\n",
            Self::MeansDeep => {
                "[region]\nsize = 6\n[render]\npayload = \"raw\"\nirrelevant = \"mean\"\n\
                 [hardware]\npipelining = \"deep\"\n"
            }
            Self::MeansOne => {
                "[region]\nsize = 4\n[render]\nirrelevant = \"mean\"\n[periphery]\nblocks = 1\n\
                 [hardware]\nthresholds = \"constant\"\n"
            }
            Self::MeansPixel => {
                "[region]\nsize = 2\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                 min_score = 1\n[temporal]\nmin_count = 1\n[render]\nirrelevant = \"mean\"\n"
            }
            Self::MeansSecond => {
                "[region]\nsize = 6\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 [render]\nirrelevant = \"mean\"\n"
            }
            Self::SerialMeans => {
                "[region]\nsize = 4\n[render]\npayload = \"raw\"\nirrelevant = \"mean\"\n\
                 [hardware]\norganization = \"serial\"\nfold = 2\n"
            }
            Self::SerialMeansRaster => {
                "[region]\nsize = 6\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 [temporal]\nreference = \"last-sent\"\n[render]\nirrelevant = \"mean\"\n[hardware]\n\
                 organization = \"serial\"\nfeed = \"raster\"\npipelining = \"deep\"\n"
            }
            Self::SerialMeansMany => {
                "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                 [[spatial]]\nfeature = \"corner\"\n[render]\nirrelevant = \"mean\"\n[periphery]\n\
                 blocks = 4\n[hardware]\norganization = \"serial\"\nmemory = \"block\"\n\
                 pipelining = \"deep\"\n"
            }
            Self::SerialPaper => "[region]\nsize = 4\n[hardware]\norganization = \"serial\"\n",
            Self::SerialEdge => {
                "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                 organization = \"serial\"\n"
            }
            Self::SerialCorner => {
                "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                 [[spatial]]\nfeature = \"corner\"\n[decision]\ncombine = \"all\"\n[hardware]\n\
                 organization = \"serial\"\n"
            }
            Self::SerialMad => {
                "[region]\nsize = 5\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 mean_fraction_bits = 2\n[hardware]\norganization = \"serial\"\n"
            }
            Self::SerialVariance => {
                "[frame]\npixel_bits = 3\n[region]\nsize = 6\n[denoise]\nfilter = \"none\"\n\
                 [[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 6\n\
                 [[spatial]]\nfeature = \"variance\"\n[hardware]\norganization = \"serial\"\n"
            }
            Self::SerialSent => {
                "[region]\nsize = 4\nneighborhood = \"shared\"\n[temporal]\n\
                 reference = \"last-sent\"\n[hardware]\norganization = \"serial\"\n\
                 feed = \"raster\"\nfold = 3\n"
            }
            Self::SerialRaster => {
                "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                 organization = \"serial\"\nfeed = \"raster\"\n"
            }
            Self::SerialFold => {
                "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                 organization = \"serial\"\nfold = 2\n"
            }
            Self::SerialBlock => {
                "[frame]\npixel_bits = 16\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                 organization = \"serial\"\nfold = 5\n"
            }
            Self::SerialMany => {
                "[frame]\npixel_bits = 1\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                 [[spatial]]\nfeature = \"edge\"\nlevel = 1\n[temporal]\nlevel = 0\n\
                 [hardware]\norganization = \"serial\"\nfeed = \"raster\"\n"
            }
            Self::SerialDeep => {
                "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 mean_fraction_bits = 1\n[[spatial]]\nfeature = \"edge\"\n[hardware]\n\
                 organization = \"serial\"\nfeed = \"raster\"\nmemory = \"block\"\n\
                 pipelining = \"deep\"\n"
            }
            Self::SerialDeepSent => {
                "[frame]\npixel_bits = 4\n[region]\nsize = 4\nneighborhood = \"shared\"\n\
                 [[spatial]]\nfeature = \"edge\"\nlevel = 9\n[[spatial]]\nfeature = \"variance\"\n\
                 min_score = 2\n[temporal]\nlevel = 2\nreference = \"last-sent\"\n[hardware]\n\
                 organization = \"serial\"\nmemory = \"block\"\nfold = 2\npipelining = \"deep\"\n"
            }
            Self::SerialConstant => {
                "[region]\nsize = 4\n[[spatial]]\nfeature = \"edge\"\n[[spatial]]\n\
                 feature = \"corner\"\n[hardware]\norganization = \"serial\"\n\
                 thresholds = \"constant\"\n"
            }
            Self::RasterPaper => {
                "[frame]\nwidth = 13\nheight = 14\n[region]\nsize = 4\nneighborhood = \"shared\"\n\
                 [hardware]\norganization = \"raster\"\n"
            }
            Self::RasterSent => {
                "[frame]\nwidth = 31\nheight = 7\n[region]\nsize = 4\n[[spatial]]\n\
                 feature = \"edge\"\n[[spatial]]\nfeature = \"corner\"\n[decision]\n\
                 combine = \"all\"\n[temporal]\nreference = \"last-sent\"\n[render]\n\
                 payload = \"raw\"\nirrelevant = \"zero\"\n[hardware]\norganization = \"raster\"\n\
                 pixels_per_clock = 2\npipelining = \"deep\"\n"
            }
            Self::RasterLost => {
                "[frame]\nwidth = 16\nheight = 16\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                 [temporal]\nreference = \"last-sent\"\n[hardware]\norganization = \"raster\"\n"
            }
            Self::RasterPairs => {
                "[frame]\nwidth = 25\nheight = 5\n[region]\nsize = 5\n[hardware]\n\
                 organization = \"raster\"\nstore = \"single-port\"\n"
            }
            Self::RasterBanks => {
                "[frame]\nwidth = 136\nheight = 124\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                 organization = \"raster\"\npipelining = \"deep\"\nforward = false\n"
            }
            Self::RasterExternal => {
                "[frame]\nwidth = 64\nheight = 8\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                 [hardware]\norganization = \"raster\"\npixels_per_clock = 4\npipelining = \"deep\"\n\
                 store = \"external\"\nforward = false\n"
            }
            Self::RasterMeans => {
                "[frame]\nwidth = 16\nheight = 15\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                 [render]\nirrelevant = \"mean\"\n[hardware]\norganization = \"raster\"\n"
            }
            Self::RasterMeansDeep => {
                "[frame]\nwidth = 31\nheight = 8\n[region]\nsize = 4\n[render]\npayload = \"raw\"\n\
                 irrelevant = \"mean\"\n[hardware]\norganization = \"raster\"\npixels_per_clock = 2\n\
                 pipelining = \"deep\"\n"
            }
            Self::RasterMeansOne => {
                "[frame]\nwidth = 18\nheight = 15\n[region]\nsize = 3\n[denoise]\nfilter = \"none\"\n\
                 [[spatial]]\nfeature = \"mad\"\nmin_score = 4\n[temporal]\nmin_count = 2\n[render]\n\
                 irrelevant = \"mean\"\n[hardware]\norganization = \"raster\"\n"
            }
            Self::RasterMeansSent => {
                "[frame]\nwidth = 16\nheight = 15\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                 [temporal]\nreference = \"last-sent\"\n[render]\nirrelevant = \"mean\"\n\
                 [hardware]\norganization = \"raster\"\n"
            }
            Self::SyncPipelined => {
                "[region]\nsize = 3\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 [hardware]\npipelining = \"deep\"\nsync = true\n"
            }
            Self::SyncSerial => {
                "[region]\nsize = 4\nneighborhood = \"shared\"\n[denoise]\nfilter = \"none\"\n\
                 [hardware]\norganization = \"serial\"\nfeed = \"raster\"\nsync = true\n"
            }
            Self::SyncRaster => {
                "[frame]\nwidth = 13\nheight = 11\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
                 [hardware]\norganization = \"raster\"\nsync = true\n"
            }
            Self::RasterMadVariance => {
                "[frame]\nwidth = 16\nheight = 15\npixel_bits = 16\n[region]\nsize = 4\n[denoise]\n\
                 filter = \"none\"\n[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 2\n\
                 [[spatial]]\nfeature = \"variance\"\n[hardware]\norganization = \"raster\"\n"
            }
        }
    }

    /// Returns the columns and rows of regions of a frame.
    fn grid(self) -> (u32, u32) {
        match self {
            Self::SerialSent => (4, 2),
            Self::SerialRaster => (3, 3),
            Self::SerialFold => (3, 1),
            Self::SerialDeepSent => (3, 2),
            Self::SerialBlock | Self::SerialMeansMany => (5, 1),
            Self::SerialMeans => (3, 1),
            Self::SerialMany => (13, 6),
            Self::SerialPaper
            | Self::SyncPipelined
            | Self::SyncSerial
            | Self::SerialEdge
            | Self::SerialCorner
            | Self::SerialMad
            | Self::SerialVariance
            | Self::SerialDeep
            | Self::SerialMeansRaster
            | Self::SerialConstant => (2, 1),
            _ => (1, 1),
        }
    }

    /// Returns true if the frame is that of the configuration, and not a grid of whole regions.
    fn has_frame(self) -> bool {
        matches!(
            self,
            Self::RasterPaper
                | Self::RasterSent
                | Self::RasterMadVariance
                | Self::RasterLost
                | Self::RasterPairs
                | Self::RasterBanks
                | Self::RasterExternal
                | Self::RasterMeans
                | Self::RasterMeansDeep
                | Self::RasterMeansOne
                | Self::RasterMeansSent
                | Self::SyncRaster
        )
    }

    pub(crate) fn design(self) -> Design {
        let config = DesignConfig::from_toml(self.toml()).unwrap();
        if self.has_frame() { config.validate().unwrap() } else { design(&config, self.grid()) }
    }

    /// Returns the level at which a fault of a module is searched.
    pub(crate) fn level(self, module: &str) -> CosimLevel {
        if self.has_frame() {
            return CosimLevel::Full;
        }
        match (self.grid(), module) {
            ((1, 1), "rcm") => CosimLevel::Rcm { columns: 3, rows: 2 },
            ((1, 1), _) => CosimLevel::Rpu,
            ((columns, rows), _) => CosimLevel::Rcm { columns, rows },
        }
    }

    /// Returns the simulator: the compiled one if a frame takes long.
    pub(crate) fn simulator(self) -> Simulator {
        match self {
            Self::SerialMany
            | Self::SerialSent
            | Self::SerialBlock
            | Self::SerialDeepSent
            | Self::SerialMeans
            | Self::SerialMeansMany
            | Self::RasterBanks => Simulator::Verilator,
            _ => Simulator::Iverilog,
        }
    }
}
