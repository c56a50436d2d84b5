// SPDX-License-Identifier: MIT OR Apache-2.0
//! The edges at which a window steps: it takes pixels, and gives centers.

use foveate_camera::Neighborhood;

/// A window over a region, between two of its pixels.
#[derive(Clone, Debug)]
pub(super) enum Window {
    Isolated(IsolatedWindow),
    Shared(SharedWindow),
}

/// A window that sees no pixel of another region. It gives a center N + 1 advances after it has
/// taken its pixel, and flushes after the last pixel of a frame.
#[derive(Clone, Debug)]
pub(super) struct IsolatedWindow {
    /// The advances from a pixel to its center, N + 1.
    behind: u64,
    /// The pixels of a frame, n.
    pixels: u64,
    /// The number of pixels of the frame that were taken, 0..n.
    taken: u64,
    /// The number of centers of the frame before that were not given yet.
    owed: u64,
    /// The edge of the last pixel.
    last: u64,
}

/// A window over a square of pixels. It gives a center when it takes the pixel one row below and
/// one column to the right.
#[derive(Clone, Debug)]
pub(super) struct SharedWindow {
    side: u64,
    /// The number of pixels of the frame that were taken.
    taken: u64,
}

impl Window {
    /// Makes a window over squares of `side` pixels.
    pub(super) fn new(neighborhood: Neighborhood, side: u32) -> Self {
        let side = u64::from(side);
        match neighborhood {
            Neighborhood::Isolated => Self::Isolated(IsolatedWindow {
                behind: side + 1,
                pixels: side * side,
                taken: 0,
                owed: 0,
                last: 0,
            }),
            Neighborhood::Shared => Self::Shared(SharedWindow { side, taken: 0 }),
        }
    }

    /// Takes a pixel at an edge, and appends the edges of the steps up to then.
    pub(super) fn take(&mut self, edge: u64, steps: &mut Vec<u64>) {
        match self {
            Self::Isolated(window) => window.take(edge, steps),
            Self::Shared(window) => steps.extend(window.take().then_some(edge)),
        }
    }

    /// Appends the edges of the steps that come if no pixel follows.
    pub(super) fn flush(&mut self, steps: &mut Vec<u64>) {
        match self {
            Self::Isolated(window) if window.taken == 0 => window.flush(window.owed, steps),
            Self::Isolated(_) | Self::Shared(_) => {}
        }
    }

    pub(super) fn reset(&mut self) {
        match self {
            Self::Isolated(window) => (window.taken, window.owed) = (0, 0),
            Self::Shared(window) => window.taken = 0,
        }
    }
}

impl IsolatedWindow {
    fn take(&mut self, edge: u64, steps: &mut Vec<u64>) {
        if self.taken == 0 {
            // The window has flushed at every edge since the last pixel.
            self.flush(self.owed.min(edge.saturating_sub(self.last + 1)), steps);
        }
        if self.owed > 0 {
            self.owed -= 1;
            steps.push(edge);
        } else if self.taken >= self.behind {
            steps.push(edge);
        }
        self.taken += 1;
        self.last = edge;
        if self.taken == self.pixels {
            (self.taken, self.owed) = (0, self.behind);
        }
    }

    /// Appends the edges of the next flush advances.
    fn flush(&mut self, advances: u64, steps: &mut Vec<u64>) {
        steps.extend(self.last + 1..=self.last + advances);
        self.owed -= advances;
    }
}

impl SharedWindow {
    /// Takes a pixel, and returns true if the window steps.
    fn take(&mut self) -> bool {
        let (x, y) = (self.taken % self.side, self.taken / self.side);
        self.taken = (self.taken + 1) % (self.side * self.side);
        x >= 2 && y >= 2
    }
}
