// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of `[hardware]` whose value is one of a few names.

use foveate_camera::choice;

choice! {
    /// The structure of the array.
    #[derive(Default)]
    Organization {
        /// One RPU per region, one pixel per clock.
        #[default]
        Pipelined = "pipelined",
        /// Small lanes under one sequencer.
        Serial = "serial",
        /// One core that takes the frame row by row, K pixels at every clock.
        Raster = "raster",
    }
}
choice! {
    /// How pixels enter the serial organization.
    #[derive(Default)]
    Feed {
        /// One pixel per lane at a time: every lane has its own stream.
        #[default]
        Parallel = "parallel",
        /// One pixel at a time: the frame, row by row.
        Raster = "raster",
    }
}
choice! {
    /// Of what the memory of a lane of the serial organization is built.
    MemoryKind {
        /// Distributed memory: data in the clock of its address.
        Distributed = "distributed",
        /// Block memory: data a clock after its address.
        Block = "block",
    }
}
choice! {
    /// How finely the arithmetic of the pipelined and of the raster organization is cut by registers.
    #[derive(Default)]
    Pipelining {
        /// As few registers as the organization needs.
        #[default]
        Plain = "plain",
        /// More registers, for faster clocks.
        Deep = "deep",
    }
}
choice! {
    /// Where the frame store of the raster organization is, and of what it is built.
    #[derive(Default)]
    Store {
        /// Block RAM.
        #[default]
        Block = "block",
        /// Ultra RAM.
        Ultra = "ultra",
        /// RAM of one port.
        SinglePort = "single-port",
        /// Memory outside of the core, by two streams of words.
        External = "external",
    }
}
choice! {
    /// How a core is connected to what is around it.
    #[derive(Default)]
    Bus {
        /// By ports of its own.
        #[default]
        Ports = "ports",
        /// By AXI4-Stream video, packets on AXI4-Stream, and registers on AXI4-Lite.
        Axi = "axi",
    }
}
choice! {
    /// Where the thresholds of a core come from.
    Thresholds {
        /// Input ports.
        Runtime = "runtime",
        /// Constants of the design.
        Constant = "constant",
    }
}

impl Bus {
    /// The key where it is not the default.
    pub(crate) fn if_any(self) -> Option<Self> {
        match self {
            Self::Ports => None,
            Self::Axi => Some(self),
        }
    }
}

impl Pipelining {
    /// The key where it is not the default.
    pub(crate) fn if_deep(self) -> Option<Self> {
        match self {
            Self::Plain => None,
            Self::Deep => Some(self),
        }
    }
}
