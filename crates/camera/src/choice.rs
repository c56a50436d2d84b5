// SPDX-License-Identifier: MIT OR Apache-2.0
//! The keys of a configuration whose value is one of a few names.

/// `"a", "b" or "c"`.
pub(crate) fn listed(names: &[&str]) -> String {
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

            /// Every value as it is written in a configuration, in that order.
            pub const NAMES: &'static [&'static str] = &[$($text),+];

            /// The value as it is written in a configuration.
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
        /// The means of its blocks, as they were last sent.
        Mean = "mean",
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
