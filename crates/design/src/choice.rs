// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration whose value is one of a few names.

use serde::{Deserialize, Serialize};

/// `"a", "b" or "c"`.
fn listed(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// A key whose value is one of a few names.
macro_rules! choice {
    ($(#[$outer:meta])* $name:ident { $($(#[$inner:meta])* $variant:ident = $text:literal),+ $(,)? }) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum $name { $($(#[$inner])* #[serde(rename = $text)] $variant),+ }

        impl $name {
            /// Every value, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The value as it is written in a configuration.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),+ }
            }

            /// Every value as a message lists them.
            pub(crate) fn one_of() -> String {
                listed(&[$($text),+])
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }
    };
}

choice! {
    /// What a window sees beyond the border of its region.
    Neighborhood {
        /// The region's own border pixel, repeated.
        Isolated = "isolated",
        /// The real neighbors; only the frame's border repeats.
        Shared = "shared",
    }
}
choice! {
    /// The filter in front of every score.
    #[derive(Default)]
    Filter {
        /// No filter.
        None = "none",
        /// The fifth of the nine sorted values of a 3x3 window.
        #[default]
        Median3x3 = "median3x3",
    }
}
choice! {
    /// A spatial feature.
    #[derive(Default)]
    FeatureKind {
        /// 3x3 Sobel: pixels with |Gx| + |Gy| > level.
        #[default]
        Edge = "edge",
        /// FAST 5/8: pixels with 5 contiguous neighbors all brighter or all darker by > level.
        Corner = "corner",
        /// Mean absolute deviation from the region's mean.
        Mad = "mad",
        /// Variance of the region.
        Variance = "variance",
    }
}
choice! {
    /// How the votes of several features become SRS.
    #[derive(Default)]
    Combine {
        /// One vote is enough.
        #[default]
        Any = "any",
        /// Every feature must vote.
        All = "all",
    }
}
choice! {
    /// What the temporal score compares a frame with.
    Reference {
        /// The previous frame.
        Previous = "previous",
        /// The region as it was when it was last active.
        LastSent = "last-sent",
    }
}
choice! {
    /// What is shown where SRS is 0.
    #[derive(Default)]
    Irrelevant {
        /// Zero.
        #[default]
        Zero = "zero",
        /// The previous rendered pixels.
        Hold = "hold",
    }
}
choice! {
    /// Which pixels an active region forwards.
    #[derive(Default)]
    Payload {
        /// The pixels that were scored.
        #[default]
        Denoised = "denoised",
        /// The pixels as they came in.
        Raw = "raw",
    }
}
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
    /// Where the thresholds of a core come from.
    Thresholds {
        /// Input ports.
        Runtime = "runtime",
        /// Constants of the design.
        Constant = "constant",
    }
}
