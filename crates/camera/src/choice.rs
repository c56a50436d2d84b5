// SPDX-License-Identifier: MIT OR Apache-2.0
//! The types of keys whose value is one of a few names.

/// Returns the quoted names as a list in words: `"a", "b" or "c"`.
pub(crate) fn quoted_list(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// Defines the type of a key whose value is one of a few names.
#[macro_export]
macro_rules! choice {
    ($(#[$outer:meta])* $name:ident { $($(#[$inner:meta])* $variant:ident = $text:literal),+ $(,)? }) => {
        $(#[$outer])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, ::serde::Serialize, ::serde::Deserialize,
        )]
        pub enum $name { $($(#[$inner])* #[serde(rename = $text)] $variant),+ }

        impl $name {
            /// Every value, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name of every value in a configuration, in the order of `ALL`.
            pub const NAMES: &'static [&'static str] = &[$($text),+];

            /// Returns the name of the value in a configuration.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),+ }
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
    /// The pixels that a window sees beyond the border of its region.
    Neighborhood {
        /// The region's own border pixel, repeated.
        Isolated = "isolated",
        /// The real neighbors. Pixels are repeated only at the border of the frame.
        Shared = "shared",
    }
}
choice! {
    /// The filter in front of every score.
    #[derive(Default)]
    DenoiseFilter {
        /// No filter.
        None = "none",
        /// The median: the fifth of the nine sorted values of a 3x3 window.
        #[default]
        Median3x3 = "median3x3",
        /// The median where the pixel is the largest or the smallest of its 3x3 window, elsewhere
        /// the pixel itself.
        Switching3x3 = "switching3x3",
        /// The weighted mean of a 3x3 window, with the weights 1, 2, 1 in both directions.
        Binomial3x3 = "binomial3x3",
    }
}

impl DenoiseFilter {
    /// Returns true if the filter uses the 3x3 window of raw pixels around each pixel.
    #[must_use]
    pub fn has_window(self) -> bool {
        match self {
            Self::None => false,
            Self::Median3x3 | Self::Switching3x3 | Self::Binomial3x3 => true,
        }
    }
}

choice! {
    /// The rule by which the votes of several features become SRS.
    #[derive(Default)]
    VoteCombination {
        /// One vote is enough.
        #[default]
        Any = "any",
        /// Every feature must vote.
        All = "all",
    }
}
choice! {
    /// The reference of the temporal score: the pixels that a frame is compared with.
    ReferencePolicy {
        /// The previous frame.
        Previous = "previous",
        /// The region as it was when it was last active.
        LastSent = "last-sent",
    }
}
choice! {
    /// The pixels that the screen shows where SRS is 0.
    #[derive(Default)]
    IrrelevantRendering {
        /// Black: every pixel is 0.
        #[default]
        Zero = "zero",
        /// The previous rendered pixels.
        Hold = "hold",
        /// The means of the blocks of the region that were sent last.
        Mean = "mean",
    }
}
choice! {
    /// The pixels that an active region forwards.
    #[derive(Default)]
    Payload {
        /// The denoised pixels, which the scores are made of.
        #[default]
        Denoised = "denoised",
        /// The pixels of the input frame.
        Raw = "raw",
    }
}
