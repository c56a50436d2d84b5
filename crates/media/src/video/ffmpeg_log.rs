// SPDX-License-Identifier: MIT OR Apache-2.0
//! The messages of ffmpeg during decoding: frames announced by `showinfo`, and faults.
//!
//! Not every error of ffmpeg is damage of a frame that is read, so these do not count:
//!
//! * what decoders say before decoding begins. ffmpeg then tries all streams, also sound, and
//!   decodes the chosen one again afterwards;
//! * what concerns neither samples nor references, such as EXIF data in an APP segment
//!   ([`ASIDES`]);
//! * missing references before the first frame, if the stream was cut without being encoded anew.
//!   It then begins with frames that are not shown ([`REFERENCES`]). Elsewhere they are a sign of
//!   loss.

use super::pixel_formats::{SampleFormat, sample_format};
use crate::MAX_SIDE;
use crate::samples::SampleLayout;

/// The largest number of characters of a fault that is kept.
const MAX_FAULT_LENGTH: usize = 200;

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

/// Parts of messages about data that are no samples.
const ASIDES: [&str; 4] = [
    "EXIF data",
    "decode_app parser",
    "APP fields",
    // The next recording begins in a file of joined ones.
    "Found unknown-length element with ID 0x18538067",
];
/// Parts of messages about references that are not there.
const REFERENCES: [&str; 3] = [
    "mmco: unref short failure",
    "number of reference frames (",
    "Missing reference picture, default is",
];

/// The messages so far.
#[derive(Debug)]
pub(super) struct FfmpegLog {
    /// The number of seconds per unit of time, as a fraction.
    pub(super) time_base: (u32, u32),
    /// The name of the container, by which ffmpeg calls its reader. It is empty for a medium that
    /// was not probed.
    container: String,
    stage: DecodingStage,
    faults: u64,
    first_fault: Option<String>,
    missing_reference: Option<String>,
    /// The reason why a frame that ffmpeg announced cannot be taken.
    refusal: Option<String>,
}

/// The progress of ffmpeg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum DecodingStage {
    /// It looks at all streams.
    Probing,
    /// It decodes the chosen stream, and has announced no frame.
    Begun,
    FrameAnnounced,
}

impl FfmpegLog {
    pub(super) fn new(container: String) -> Self {
        Self {
            time_base: (1, 1_000_000),
            container,
            stage: DecodingStage::Probing,
            faults: 0,
            first_fault: None,
            missing_reference: None,
            refusal: None,
        }
    }

    pub(super) fn read_line(&mut self, line: &str) -> Option<LogEntry> {
        if line.starts_with("[Parsed_showinfo_") {
            if let Some((_, base)) = line.split_once("] config in time_base: ") {
                self.time_base = parse_fraction(base).unwrap_or(self.time_base);
            }
            let frame = parse_frame(line);
            let stage =
                if frame.is_some() { DecodingStage::FrameAnnounced } else { DecodingStage::Begun };
            self.stage = self.stage.max(stage);
            return frame;
        }
        let line = LogLine::parse(line);
        if line.text == "[info] Stream mapping:" {
            self.stage = self.stage.max(DecodingStage::Begun);
        }
        let said = self.fault_text(&line)?;
        let plain = said.replace(char::is_control, " ");
        let plain = plain.trim().chars().take(MAX_FAULT_LENGTH).collect();
        let is_missing = REFERENCES.iter().any(|part| said.contains(part));
        if self.stage < DecodingStage::FrameAnnounced && is_missing {
            self.missing_reference.get_or_insert(plain);
            return None;
        }
        self.faults += 1;
        self.first_fault.get_or_insert(plain);
        None
    }

    /// Returns the text of a line that tells of a fault in what is read.
    fn fault_text<'a>(&self, line: &LogLine<'a>) -> Option<&'a str> {
        let faults = ["[error] ", "[fatal] ", "[panic] "];
        let of_corruption = |text: &&str| text.to_lowercase().contains("corrupt");
        let said = faults
            .iter()
            .find_map(|level| line.text.strip_prefix(level))
            .or_else(|| line.text.strip_prefix("[warning] ").filter(of_corruption))?;
        // The muxer of raw frames complains about missing times, which are not a fault of the
        // video.
        let is_other = line.component == "rawvideo"
            || self.stage == DecodingStage::Probing && self.is_of_other_stream(line, said);
        // The program itself names files, whose names may be anything.
        let is_aside = !line.component.is_empty() && ASIDES.iter().any(|part| said.contains(part));
        (!is_other && !is_aside).then_some(said)
    }

    /// Returns true for what a decoder says, and for a packet of any stream, while all streams are
    /// looked at.
    fn is_of_other_stream(&self, line: &LogLine<'_>, said: &str) -> bool {
        let is_of_decoder = !["", self.container.as_str()].contains(&line.component);
        !self.container.is_empty() && (is_of_decoder || said.starts_with("Packet corrupt"))
    }

    /// Returns the fault that a reference was missing before the first frame. In a stream that was
    /// cut, it belongs to frames that are not shown.
    pub(super) fn missing_reference(&self) -> Option<String> {
        self.missing_reference.as_ref().map(|said| format!("ffmpeg reports: {said}"))
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

/// A line of the form `[h264 @ 0x1] [error] text`, in which the program itself names no component.
/// Newer versions name a component in a component.
#[derive(Clone, Copy, Debug, Default)]
struct LogLine<'a> {
    /// The name of the last component.
    component: &'a str,
    /// The level and the text.
    text: &'a str,
}

impl<'a> LogLine<'a> {
    fn parse(line: &'a str) -> Self {
        let mut parsed = Self { component: "", text: line };
        while let Some((name, text)) = parsed.text.split_once("] ")
            && let Some((name, _)) = name.split_once(" @ 0x")
            && let Some(component) = name.strip_prefix('[')
        {
            parsed = Self { component, text };
        }
        parsed
    }
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
        let mut log = FfmpegLog::new("avi".to_owned());
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
        let mut log = FfmpegLog::new("avi".to_owned());
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
        let mut log = FfmpegLog::new("avi".to_owned());
        log.read_line("[warning] deprecated pixel format used");
        log.read_line(
            "[rawvideo @ 0x1] [error] Application provided invalid, non monotonically ...",
        );
        log.read_line("[info]   title : [error] s:1x1 fmt:gray pts:1");
        assert_eq!(log.problem(), None);
        log.read_line(CONFIG);
        log.read_line("[avi @ 0x1] [warning] Packet corrupt (stream = 0, dts = 60).");
        assert_eq!(
            log.problem().unwrap(),
            "ffmpeg reports: Packet corrupt (stream = 0, dts = 60)."
        );
        log.read_line("[error] second");
        assert!(log.problem().unwrap().starts_with("ffmpeg reports 2 faults, the first: Packet"));
    }

    #[test]
    fn what_harms_no_frame_is_no_fault() {
        const MAPPING: &str = "[info] Stream mapping:";
        const SHORT: &str = "[h264 @ 0x1] [error] mmco: unref short failure";
        let log_of = |lines: &[&str]| {
            let mut log = FfmpegLog::new("avi".to_owned());
            lines.iter().for_each(|line| drop(log.read_line(line)));
            log.problem()
        };
        let sound = "[aac @ 0x1] [error] channel element 2.2 is not allocated";
        let exif = "[mjpeg @ 0x1] [error] mjpeg: invalid TIFF header in EXIF data";
        for harmless in [
            &[sound, "[avi @ 0x1] [warning] Packet corrupt (stream = 1, dts = 60)."][..],
            &[MAPPING, SHORT, CONFIG, FRAME],
            &[MAPPING, CONFIG, FRAME, exif],
            &[
                MAPPING,
                "[matroska,webm @ 0x1] [error] Found unknown-length element with ID 0x18538067 at pos. 9",
            ],
        ] {
            assert_eq!(log_of(harmless), None, "{harmless:?}");
        }
        for damage in [
            &[MAPPING, sound][..],
            &[CONFIG, sound],
            &["[avi @ 0x1] [error] the index is cut"],
            &["[fatal] no stream"],
            &[MAPPING, CONFIG, FRAME, SHORT],
            &[MAPPING, "[warning] EXIF data/a.ts: corrupt input packet in stream 0"],
            &[MAPPING, "[vist#0:0/h264 @ 0x1] [dec:h264 @ 0x2] [warning] corrupt decoded frame"],
        ] {
            assert!(log_of(damage).is_some(), "{damage:?}");
        }
        // A camera is not probed, so that no line can be told from that of its stream.
        let mut log = FfmpegLog::new(String::new());
        log.read_line(sound);
        assert!(log.problem().is_some());
    }
}
