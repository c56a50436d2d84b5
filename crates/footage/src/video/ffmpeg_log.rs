// SPDX-License-Identifier: MIT OR Apache-2.0
//! The messages of ffmpeg during decoding: frames announced by `showinfo`, and faults.

use super::pixel_formats::{SampleFormat, sample_format};
use crate::MAX_SIDE;
use crate::samples::SampleLayout;

/// The largest number of characters of a fault that is kept.
const MAX_FAULT_LENGTH: usize = 200;

/// A frame that ffmpeg announced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AnnouncedFrame {
    /// The time in units of the time base.
    pub(super) pts: Option<i64>,
    pub(super) layout: SampleLayout,
}

/// The content of a line.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum LogEntry {
    Frame(AnnouncedFrame),
    /// A frame that cannot be taken from the pipe, with the reason.
    UntakableFrame(String),
}

/// The messages so far.
#[derive(Debug)]
pub(super) struct FfmpegLog {
    /// The number of seconds per unit of time, as a fraction.
    pub(super) time_base: (u32, u32),
    faults: u64,
    first_fault: Option<String>,
    /// The reason why a frame that ffmpeg announced cannot be taken.
    refusal: Option<String>,
}

impl Default for FfmpegLog {
    fn default() -> Self {
        Self { time_base: (1, 1_000_000), faults: 0, first_fault: None, refusal: None }
    }
}

impl FfmpegLog {
    pub(super) fn read_line(&mut self, line: &str) -> Option<LogEntry> {
        if line.starts_with("[Parsed_showinfo_") {
            if let Some((_, base)) = line.split_once("] config in time_base: ") {
                self.time_base = parse_fraction(base).unwrap_or(self.time_base);
            }
            return parse_frame(line);
        }
        let said = fault_text(line)?;
        self.faults += 1;
        if self.first_fault.is_none() {
            let plain: String = said.replace(char::is_control, " ");
            self.first_fault = Some(plain.trim().chars().take(MAX_FAULT_LENGTH).collect());
        }
        None
    }

    /// Records the reason why a frame cannot be taken.
    pub(super) fn refuse(&mut self, problem: String) {
        self.refusal = Some(problem);
    }

    /// Returns the faults in one line, if there were any.
    pub(super) fn problem(&self) -> Option<String> {
        if self.refusal.is_some() {
            return self.refusal.clone();
        }
        let first = self.first_fault.as_ref()?;
        Some(match self.faults {
            1 => format!("ffmpeg reports: {first}"),
            more => format!("ffmpeg reports {more} faults, the first: {first}"),
        })
    }
}

/// Returns the text of a fault: `[h264 @ 0x1] [error] ...`, `[error] ...`, or a warning of damage.
fn fault_text(line: &str) -> Option<&str> {
    let component =
        |line: &&str| line.split_once("] ").is_some_and(|(name, _)| name.contains(" @ 0x"));
    let said = match Some(line).filter(component) {
        // The muxer of raw frames complains about missing times, which are not a fault of the
        // video.
        Some(line) if line.starts_with("[rawvideo @ ") => return None,
        Some(line) => line.split_once("] ")?.1,
        None => line,
    };
    let faults = ["[error] ", "[fatal] ", "[panic] "];
    faults.iter().find_map(|level| said.strip_prefix(level)).or_else(|| {
        said.strip_prefix("[warning] ").filter(|said| said.to_lowercase().contains("corrupt"))
    })
}

/// Parses `1/12800, frame_rate: ...`.
fn parse_fraction(text: &str) -> Option<(u32, u32)> {
    let (numerator, rest) = text.split_once('/')?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    Some((numerator.parse().ok()?, digits.parse().ok().filter(|&d| d > 0)?))
}

/// Parses `... n:   1 pts:    512 pts_time:0.04 ... fmt:gray sar:1/1 s:320x240 ...`.
fn parse_frame(line: &str) -> Option<LogEntry> {
    let value =
        |key: &str| line.split_once(key).and_then(|(_, rest)| rest.split_whitespace().next());
    let (pts, format) = (value(" pts:")?, value(" fmt:")?);
    let Some(samples) = sample_format(format) else {
        return Some(LogEntry::UntakableFrame(format!(
            "ffmpeg gives frames in the pixel format `{format}`, which is not supported; convert \
             it first, for example with `ffmpeg -i FILE -pix_fmt yuv420p -c:v ffv1 OUT.mkv`"
        )));
    };
    let size = || {
        let (width, height) = value(" s:")?.split_once('x')?;
        let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
        Some((side(width)?, side(height)?))
    };
    let Some((width, height)) = size() else {
        let size = value(" s:").unwrap_or("none");
        let problem = format!("a frame of {size} pixels is announced; sides are 1..={MAX_SIDE}");
        return Some(LogEntry::UntakableFrame(problem));
    };
    let pts = pts.parse().ok();
    let SampleFormat { depth, colour, big_endian } = samples;
    Some(LogEntry::Frame(AnnouncedFrame {
        pts,
        layout: SampleLayout {
            width,
            height,
            depth,
            is_colour: colour,
            is_big_endian: big_endian,
            is_expanded: false,
        },
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: &str =
        "[Parsed_showinfo_1 @ 0x5a] [info] config in time_base: 1/12800, frame_rate: 25/1";
    const FRAME: &str = "[Parsed_showinfo_1 @ 0x5a] [info] n:  42 pts:  21504 pts_time:1.68    \
                         pos:    12014 fmt:gray sar:1/1 s:320x240 i:P iskey:0 type:P ";

    #[test]
    fn frames_are_announced_with_time_size_and_format() {
        let mut log = FfmpegLog::default();
        assert_eq!(log.read_line(CONFIG), None);
        assert_eq!(log.time_base, (1, 12_800));
        let layout = SampleLayout::luma(320, 240, 8);
        let shown = AnnouncedFrame { pts: Some(21_504), layout };
        assert_eq!(log.read_line(FRAME), Some(LogEntry::Frame(shown)));
        let without = FRAME.replace("pts:  21504", "pts:NOPTS");
        assert_eq!(
            log.read_line(&without),
            Some(LogEntry::Frame(AnnouncedFrame { pts: None, ..shown }))
        );
        assert_eq!(log.read_line("[Parsed_showinfo_1 @ 0x5a] [info] color_range:tv"), None);
        assert_eq!(log.read_line("[info]   title : [error] s:1x1 fmt:gray pts:1"), None);
        assert_eq!(log.problem(), None);
    }

    #[test]
    fn a_frame_that_cannot_be_taken_is_no_silence() {
        let mut log = FfmpegLog::default();
        let deep = FRAME.replace("fmt:gray", "fmt:gray10be");
        let layout = SampleLayout { is_big_endian: true, ..SampleLayout::luma(320, 240, 10) };
        assert_eq!(
            log.read_line(&deep),
            Some(LogEntry::Frame(AnnouncedFrame { pts: Some(21_504), layout }))
        );
        for (from, to, part) in [
            ("fmt:gray", "fmt:grayf32le", "`grayf32le`"),
            ("s:320x240", "s:320x999999999", "320x999999999"),
            ("s:320x240", "s:", "sides are"),
        ] {
            let Some(LogEntry::UntakableFrame(problem)) = log.read_line(&FRAME.replace(from, to))
            else {
                panic!("{to} is passed over")
            };
            assert!(problem.contains(part), "{problem}");
        }
    }

    #[test]
    fn faults_are_counted_and_the_first_is_kept() {
        let mut log = FfmpegLog::default();
        log.read_line("[warning] deprecated pixel format used");
        log.read_line(
            "[rawvideo @ 0x1] [error] Application provided invalid, non monotonically ...",
        );
        log.read_line("[info]   title : [error] s:1x1 fmt:gray pts:1");
        assert_eq!(log.problem(), None);
        log.read_line("[avi @ 0x1] [warning] Packet corrupt (stream = 0, dts = 60).");
        assert_eq!(
            log.problem().unwrap(),
            "ffmpeg reports: Packet corrupt (stream = 0, dts = 60)."
        );
        log.read_line("[error] second");
        assert!(log.problem().unwrap().starts_with("ffmpeg reports 2 faults, the first: Packet"));
    }
}
