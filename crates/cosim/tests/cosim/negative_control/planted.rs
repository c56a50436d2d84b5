// SPDX-License-Identifier: MIT OR Apache-2.0
//! The designs in which faults are planted; between them they use every module.

use crate::common::design;
use foveate_cosim::{Level, Simulator};
use foveate_design::{Config, Design};

/// A design to plant faults in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Planted {
    /// Median, edges, previous frame.
    Paper,
    /// Edges and corners, no filter, so that the counter of positions is the window's.
    Corner,
    /// Mean absolute deviation and variance, nothing with a window.
    Moments,
    /// Variance alone, whose result register is a port.
    Variance,
    /// Regions that do not fit into one bank of the frame store, nor fill two.
    Banked,
    /// Mean absolute deviation against the pixels last sent: two candidates for the count.
    MadSent,
    /// Edges against the pixels last sent, raw pixels forwarded.
    Sent,
    /// Median and edges that see across the border.
    Shared,
    /// The paper's design with its thresholds built in.
    Constant,
    /// Deep: median, edges and corners, raw pixels forwarded.
    Deep,
    /// Deep: edges against the pixels last sent.
    DeepSent,
    /// Deep: both moments, against the pixels last sent.
    DeepMoments,
    /// Means of four blocks, of pixels behind a window.
    Means,
    /// Means of raw pixels in blocks of 3x3, deep.
    MeansDeep,
    /// One mean per region, thresholds built in.
    MeansOne,
    /// Means of blocks of one pixel.
    MeansPixel,
    /// Means of blocks of 3x3 with a second pass.
    MeansSecond,
    /// Serial: means of four blocks of raw pixels, two slots per lane.
    SerialMeans,
    /// Serial: means of blocks of 3x3, raster feed, deep.
    SerialMeansRaster,
    /// Serial: means of blocks of one pixel, more than distributed memory takes, deep.
    SerialMeansMany,
    /// Serial: the paper's scores in small regions.
    SerialPaper,
    /// Serial: edges alone, no filter.
    SerialEdge,
    /// Serial: edges and corners, both of which must vote.
    SerialCorner,
    /// Serial: mean absolute deviation alone.
    SerialMad,
    /// Serial: mean absolute deviation, with a mean of more bits than the sum of a region has, and variance.
    SerialVariance,
    /// Serial: everything that a raster across borders, folds and the pixels last sent need.
    SerialSent,
    /// Serial: a raster into isolated regions.
    SerialRaster,
    /// Serial: two slots, one of which is empty in the last lane.
    SerialFold,
    /// Serial: block memory.
    SerialBlock,
    /// Serial: more than one group of lanes.
    SerialMany,
    /// Serial and deep: mean absolute deviation and edges, a raster, block memory.
    SerialDeep,
    /// Serial and deep: everything across borders, the pixels last sent, pixels on every lane.
    SerialDeepSent,
    /// Serial: median, edges and corners, thresholds built in.
    SerialConstant,
    /// Raster: the paper's scores, in a frame that the core completes on the right and below.
    RasterPaper,
    /// Raster: words of two pixels, edges and corners, raw pixels that leave, the pixels last sent, and few
    /// rows of regions, so that frames wait; more registers.
    RasterSent,
    /// Raster: both moments, with a second pass, and no window.
    RasterMoments,
    /// Raster: the pixels last sent, of regions that may be lost.
    RasterLost,
    /// Raster: a frame of an odd number of words, in a memory of one port.
    RasterPairs,
    /// Raster: more words than a bank of the store holds, and more registers.
    RasterBanks,
    /// Raster: the store outside, and no pixels that leave.
    RasterOutside,
    /// Raster: means of four blocks, of regions that may be lost.
    RasterMeans,
    /// Raster: means of raw pixels, blocks as wide as a word, few rows of regions, and more registers.
    RasterMeansDeep,
    /// Raster: one mean of 3x3 pixels, with a second pass.
    RasterMeansOne,
    /// Raster: means of four blocks beside regions that keep the pixels last sent.
    RasterMeansSent,
    /// Frames found again: an array of RPUs, deep, with a second pass.
    SyncPipelined,
    /// Frames found again: a serial array that takes the frame row by row.
    SyncSerial,
    /// Frames found again: a raster core of a ragged frame.
    SyncRaster,
}

impl Planted {
    fn toml(self) -> &'static str {
        match self {
            Self::Paper => "",
            Self::Corner => {
                "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                 [[spatial]]\nfeature = \"corner\"\n[decision]\ncombine = \"all\"\n"
            }
            Self::Moments => {
                "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                 mean_fraction_bits = 2\n[[spatial]]\nfeature = \"variance\"\n"
            }
            Self::Variance => "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"variance\"\n",
            Self::MadSent => {
                "[region]\nsize = 5\n[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 1\n\
                 [temporal]\nreference = \"last-sent\"\n"
            }
            Self::Sent => "[temporal]\nreference = \"last-sent\"\n[render]\npayload = \"raw\"\n",
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
            Self::DeepMoments => {
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
            Self::RasterOutside => {
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
            Self::RasterMoments => {
                "[frame]\nwidth = 16\nheight = 15\npixel_bits = 16\n[region]\nsize = 4\n[denoise]\n\
                 filter = \"none\"\n[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 2\n\
                 [[spatial]]\nfeature = \"variance\"\n[hardware]\norganization = \"raster\"\n"
            }
        }
    }

    /// Regions of a frame, side by side and one below the other.
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

    /// Whether the frame is that of its configuration, ragged, and not a grid.
    fn has_frame(self) -> bool {
        matches!(
            self,
            Self::RasterPaper
                | Self::RasterSent
                | Self::RasterMoments
                | Self::RasterLost
                | Self::RasterPairs
                | Self::RasterBanks
                | Self::RasterOutside
                | Self::RasterMeans
                | Self::RasterMeansDeep
                | Self::RasterMeansOne
                | Self::RasterMeansSent
                | Self::SyncRaster
        )
    }

    pub(crate) fn design(self) -> Design {
        let config = Config::from_toml(self.toml()).unwrap();
        if self.has_frame() { config.validate().unwrap() } else { design(&config, self.grid()) }
    }

    /// Where a fault of a module is looked for.
    pub(crate) fn level(self, module: &str) -> Level {
        if self.has_frame() {
            return Level::Full;
        }
        match (self.grid(), module) {
            ((1, 1), "rcm") => Level::Rcm { columns: 3, rows: 2 },
            ((1, 1), _) => Level::Rpu,
            ((columns, rows), _) => Level::Rcm { columns, rows },
        }
    }

    /// Compiled where a frame takes long.
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
