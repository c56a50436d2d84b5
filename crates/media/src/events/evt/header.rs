// SPDX-License-Identifier: MIT OR Apache-2.0
//! The header of a file ([`EvtHeader`]): lines of text that begin with `%`, one of which states
//! the version of EVT ([`EvtVersion`]).

use crate::events::frame_size::check_frame_size;
use crate::events::{EventFileError, EventFormat};
use std::fmt;
use std::io::{BufRead, Read as _};

/// The first byte of every line, and so of a file.
pub(crate) const HEADER_START: u8 = b'%';
/// The largest header in bytes.
const MAX_HEADER_BYTES: u64 = 1 << 16;

/// The facts of a header that a reader needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct EvtHeader {
    pub(crate) version: EvtVersion,
    /// The width and height of the sensor in pixels, if the header has them.
    pub(crate) size: Option<(u32, u32)>,
    /// The length of the header in bytes.
    pub(crate) bytes: u64,
}

/// Returns the text of a header. The lines are those that cameras write, as far as they concern the
/// events.
pub(crate) fn header_text(version: EvtVersion, (width, height): (u32, u32)) -> String {
    let name = match version {
        EvtVersion::Evt2 => "EVT2",
        EvtVersion::Evt3 => "EVT3",
    };
    format!(
        "% evt {}\n% format {name};height={height};width={width}\n% geometry {width}x{height}\n% end\n",
        version.number()
    )
}

impl EvtHeader {
    pub(crate) fn read(input: &mut impl BufRead) -> Result<Self, EventFileError> {
        let (mut version, mut size, mut bytes) = (None, None, 0);
        while input.fill_buf()?.first() == Some(&HEADER_START) {
            let mut line = Vec::new();
            let left = MAX_HEADER_BYTES.saturating_sub(bytes);
            input.by_ref().take(left).read_until(b'\n', &mut line)?;
            bytes += line.len() as u64;
            if line.last() != Some(&b'\n') {
                let problem = "the header has no end; its last line is `% end`".to_owned();
                return Err(EventFileError::Header { problem });
            }
            let line = String::from_utf8_lossy(&line[1..]).trim().to_owned();
            let (key, value) = line.split_once(' ').unwrap_or((&line, ""));
            match key {
                "end" => break,
                "evt" => version = Some(same_version(version, version_of_number(value)?)?),
                "format" => {
                    let found = FormatLine::parse(value)?;
                    version = Some(same_version(version, found.version)?);
                    size = size.or(found.size);
                }
                "geometry" => size = size_of(value.split('x')).or(size),
                _ => {}
            }
        }
        let version = version.ok_or_else(|| EventFileError::Header {
            problem: "there is no header with a line `% evt 2.0` or `% evt 3.0`".to_owned(),
        })?;
        size.map_or(Ok(()), |size| check_frame_size(version.format(), size))?;
        Ok(Self { version, size, bytes })
    }
}

/// The content of a line `% format`.
struct FormatLine {
    version: EvtVersion,
    size: Option<(u32, u32)>,
}

impl FormatLine {
    fn parse(text: &str) -> Result<Self, EventFileError> {
        let mut parts = text.split(';').map(str::trim);
        let version = match parts.next() {
            Some("EVT2") => EvtVersion::Evt2,
            Some("EVT3") => EvtVersion::Evt3,
            other => return Err(unknown_version(other.unwrap_or_default())),
        };
        let fields: Vec<(&str, &str)> = parts.filter_map(|part| part.split_once('=')).collect();
        let field = |name| fields.iter().find(|(key, _)| *key == name).map(|(_, value)| *value);
        if let Some(order) = field("endianness").filter(|order| *order != "little") {
            let problem = format!("the byte order is `{order}`, and only `little` can be read");
            return Err(EventFileError::Header { problem });
        }
        let size = field("width").zip(field("height")).map(|(width, height)| [width, height]);
        Ok(Self { version, size: size.and_then(|size| size_of(size.into_iter())) })
    }
}

/// Refuses a header with two versions.
fn same_version(
    known: Option<EvtVersion>,
    found: EvtVersion,
) -> Result<EvtVersion, EventFileError> {
    match known {
        Some(known) if known != found => {
            let problem = format!("the header names {known} and {found}; it may be damaged");
            Err(EventFileError::Header { problem })
        }
        _ => Ok(found),
    }
}

fn version_of_number(text: &str) -> Result<EvtVersion, EventFileError> {
    match text.trim() {
        "2.0" => Ok(EvtVersion::Evt2),
        "3.0" => Ok(EvtVersion::Evt3),
        other => Err(unknown_version(other)),
    }
}

fn unknown_version(text: &str) -> EventFileError {
    let problem =
        format!("the header names the format `{text}`, and only EVT 2.0 and EVT 3.0 can be read");
    EventFileError::Header { problem }
}

/// Returns the width and the height; `None` if one of them is missing, 0 or no number.
fn size_of<'a>(sides: impl Iterator<Item = &'a str>) -> Option<(u32, u32)> {
    let sides: Vec<u32> = sides.map_while(|side| side.trim().parse().ok()).collect();
    match sides.as_slice() {
        &[width, height] if width > 0 && height > 0 => Some((width, height)),
        _ => None,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EvtVersion {
    Evt2,
    Evt3,
}

impl EvtVersion {
    /// Returns the format of a file with this version.
    pub(crate) fn format(self) -> EventFormat {
        match self {
            Self::Evt2 => EventFormat::Evt2,
            Self::Evt3 => EventFormat::Evt3,
        }
    }

    /// Returns the version in the words of a header: `2.0` or `3.0`.
    pub(crate) fn number(self) -> &'static str {
        match self {
            Self::Evt2 => "2.0",
            Self::Evt3 => "3.0",
        }
    }

    pub(crate) fn word_bytes(self) -> usize {
        match self {
            Self::Evt2 => 4,
            Self::Evt3 => 2,
        }
    }
}

impl fmt::Display for EvtVersion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.format().fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<EvtHeader, String> {
        EvtHeader::read(&mut text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_header_is_what_was_written() {
        for version in [EvtVersion::Evt2, EvtVersion::Evt3] {
            let text = header_text(version, (640, 480));
            let bytes = text.len() as u64;
            assert_eq!(read(&text), Ok(EvtHeader { version, size: Some((640, 480)), bytes }));
        }
    }

    #[test]
    fn headers_of_cameras_are_read() {
        let sdk = "% camera_integrator_name Prophesee\n% date 2023-03-29 16:37:46\n% evt 3.0\n\
                   % format EVT3;height=720;width=1280\n% geometry 1280x720\n% serial_number 5\n% end\nxx";
        let found = read(sdk).unwrap();
        assert_eq!((found.version, found.size), (EvtVersion::Evt3, Some((1280, 720))));
        assert_eq!(found.bytes, sdk.len() as u64 - 2);
        // Older headers have no end and no size.
        let old = "% Date 2019-11-18\n% evt 2.0\n\u{0}";
        assert_eq!(
            read(old).unwrap(),
            EvtHeader { version: EvtVersion::Evt2, size: None, bytes: 28 }
        );
    }

    #[test]
    fn other_headers_are_refused() {
        for (text, problem) in [
            ("", "no header"),
            ("x,y,t,p\n", "no header"),
            ("% evt 2.1\n% end\n", "`2.1`"),
            ("% format EVT21;height=1;width=1\n% end\n", "`EVT21`"),
            ("% format EVT3;endianness=big\n% end\n", "`big`"),
            ("% evt 3.0", "no end"),
            ("% evt 2.0\n% format EVT3;height=4;width=4\n% end\n", "EVT 2.0 and EVT 3.0"),
            ("% evt 3.0\n% geometry 4096x4\n% end\n", "2048x2048"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(problem), "{text}: {error}");
        }
        let endless = "%".repeat(1 << 20);
        assert!(read(&endless).unwrap_err().contains("no end"));
    }
}
