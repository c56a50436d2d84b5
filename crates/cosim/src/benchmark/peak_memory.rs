// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of a level that runs in this process, as far as Linux reports it.
//!
//! The kernel records the largest resident size of a process, and can reset it. The memory of a
//! level is the amount by which this size exceeds the size before the level is made. Memory that
//! was freed before and is used again is not counted, so the figure is a lower bound.

use std::fs;

/// The resident size of this process before a level is made, in kilobytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct InitialResidentSize(Option<u64>);

impl InitialResidentSize {
    pub(super) fn measure() -> Self {
        // A system that cannot reset the peak gives no figure.
        let is_forgotten = fs::write("/proc/self/clear_refs", "5").is_ok();
        Self(if is_forgotten { status_kilobytes("VmRSS:") } else { None })
    }

    /// Returns the largest number of bytes that were taken since then.
    pub(super) fn peak_bytes(self) -> Option<u64> {
        let before = self.0?;
        Some(status_kilobytes("VmHWM:")?.saturating_sub(before).saturating_mul(1024))
    }
}

fn status_kilobytes(name: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_is_touched_is_seen() {
        let before = InitialResidentSize::measure();
        let touched = vec![1u8; 64 << 20];
        assert_eq!(touched.iter().map(|&byte| usize::from(byte)).sum::<usize>(), 64 << 20);
        let Some(peak) = before.peak_bytes() else { return };
        assert!(peak >= 60 << 20, "{peak}");
    }
}
