// SPDX-License-Identifier: MIT OR Apache-2.0
//! The types of keys of `[hardware]` whose value is one of a few names.

use foveate_camera::choice;

choice! {
    /// The structure of the hardware.
    #[derive(Default)]
    Organization {
        /// One RPU per region, each with one pixel per clock.
        #[default]
        Pipelined = "pipelined",
        /// Small lanes under one sequencer. Regions can share a lane.
        Serial = "serial",
        /// One core that takes the frame row by row, K pixels at every clock.
        Raster = "raster",
    }
}
choice! {
    /// The order in which pixels enter the serial organization.
    #[derive(Default)]
    PixelFeed {
        /// One pixel per lane at a time. Every lane has its own stream.
        #[default]
        Parallel = "parallel",
        /// One pixel at a time: the frame in row-major order.
        Raster = "raster",
    }
}
choice! {
    /// The kind of memory of a lane of the serial organization.
    LaneMemoryKind {
        /// Distributed memory, with data in the clock of the address.
        Distributed = "distributed",
        /// Block memory, with data one clock after the address.
        Block = "block",
    }
}
choice! {
    /// The number of registers in the arithmetic of an organization.
    #[derive(Default)]
    Pipelining {
        /// The fewest registers that the organization needs.
        #[default]
        Plain = "plain",
        /// More registers, for a faster clock.
        Deep = "deep",
    }
}
choice! {
    /// The memory that the frame store of the raster organization is built of.
    #[derive(Default)]
    FrameStoreKind {
        /// Block RAM with two ports, inside the core.
        #[default]
        Block = "block",
        /// UltraRAM with two ports, inside the core.
        Ultra = "ultra",
        /// RAM with one port, inside the core.
        SinglePort = "single-port",
        /// Memory outside of the core, which the core reads and writes by two streams of words.
        External = "external",
    }
}
choice! {
    /// The interface by which a core is connected.
    #[derive(Default)]
    InterfaceKind {
        /// Plain ports.
        #[default]
        Ports = "ports",
        /// AXI4-Stream video in, packets on AXI4-Stream out, and registers on AXI4-Lite.
        Axi = "axi",
    }
}
choice! {
    /// The source of the thresholds of a core.
    #[derive(Default)]
    ThresholdSource {
        /// Input ports.
        #[default]
        Runtime = "runtime",
        /// Constants in the core.
        Constant = "constant",
    }
}
