// SPDX-License-Identifier: MIT OR Apache-2.0
//! YUV4MPEG2, the stream of raw frames that ffmpeg and other programs write. The Y plane of every
//! frame is read, with 8 bits or more; the other planes are ignored. The stream comes from a file
//! or from standard input, without ffmpeg. Times follow from the rate in the header.

mod header;

use std::io::BufRead;

use foveate_pixels::ByteFrame;

use self::header::{Y4mHeader, read_line};
use crate::samples::SampleLayout;
use crate::stream::{StreamFeed, StreamFormat, is_at_end, read_whole, skip_whole};
use crate::{FootageError, InputOptions, LumaRange};

/// The first bytes of a stream.
pub(crate) const MAGIC: &[u8] = b"YUV4MPEG2";

/// The frames of a stream in YUV4MPEG2.
pub(crate) struct Y4mFormat {
    header: Y4mHeader,
    luma: LumaRange,
    bits: u32,
}

/// Reads the header of a stream. The rate of the options is used if it states no rate.
pub(crate) fn open_y4m(
    name: String,
    mut input: Box<dyn BufRead + Send>,
    bits: u32,
    options: &InputOptions,
) -> Result<StreamFeed<Y4mFormat>, FootageError> {
    let &InputOptions { frame_rate: rate, luma, ref interrupt, .. } = options;
    let header = read_line(&mut *input).and_then(|text| Y4mHeader::parse(&text));
    let header = header.map_err(|problem| match interrupt.is_set() {
        true => FootageError::Interrupted,
        false => FootageError::Y4m { name: name.clone(), problem },
    })?;
    let rate = header.rate.unwrap_or(rate);
    let format = Y4mFormat { header, luma, bits };
    Ok(StreamFeed::new(name, input, format, rate, interrupt.clone()))
}

impl StreamFormat for Y4mFormat {
    fn read_frame(
        &mut self,
        input: &mut dyn BufRead,
        memory: Vec<u8>,
    ) -> Result<Option<ByteFrame>, String> {
        if is_at_end(input)? {
            return Ok(None);
        }
        let start = read_line(input)?;
        if start != "FRAME" && !start.starts_with("FRAME ") {
            return Err("a frame does not start with FRAME".to_owned());
        }
        let Y4mHeader { width, height, depth, others, is_narrow, .. } = self.header;
        let is_expanded = self.luma == LumaRange::Full && is_narrow;
        let layout = SampleLayout { is_expanded, ..SampleLayout::luma(width, height, depth) };
        let mut bytes = memory;
        bytes.resize(layout.bytes(), 0);
        read_whole(input, &mut bytes)?;
        skip_whole(input, others * if depth > 8 { 2 } else { 1 })?;
        layout.byte_frame(bytes, self.bits).map(Some).map_err(|error| error.to_string())
    }

    fn luma(&self) -> Option<LumaRange> {
        Some(self.luma)
    }

    fn takes_timestamps(&self) -> bool {
        false
    }

    fn reads_mosaics(&self) -> bool {
        false
    }

    fn no_frame_error(&self, name: String, problem: String) -> FootageError {
        FootageError::Y4m { name, problem }
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;
    use crate::SourceFrame;
    use crate::source::feed::FrameFeed as _;

    fn read(bytes: &[u8], bits: u32) -> Result<(Vec<SourceFrame>, Option<String>), FootageError> {
        let input = Box::new(io::Cursor::new(bytes.to_vec()));
        let mut stream = open_y4m("-".to_owned(), input, bits, &InputOptions::default())?;
        let mut frames = Vec::new();
        while let Some(frame) = stream.next()? {
            frames.push(frame);
        }
        Ok((frames, stream.problem()))
    }

    #[test]
    fn the_y_plane_is_taken_from_every_kind_of_stream() {
        for (colour, others) in [
            ("", 4),
            (" C420jpeg", 4),
            (" C420paldv", 4),
            (" C422", 8),
            (" C444", 12),
            (" C444alpha", 18),
            (" C411", 4),
            (" C440", 6),
            (" Cmono", 0),
        ] {
            let mut bytes = format!("YUV4MPEG2 W3 H2 F25:2 Ip A1:1{colour} XNOTE=x\n").into_bytes();
            for frame in 0..3 {
                bytes.extend(b"FRAME Ip\n");
                bytes.extend((0..6).map(|pixel| 10 * frame + pixel));
                bytes.resize(bytes.len() + others, 99);
            }
            let (frames, problem) = read(&bytes, 8).unwrap();
            assert_eq!((frames.len(), problem), (3, None), "{colour}");
            assert_eq!(
                frames[2].frame.borrowed_pixels().to_words(),
                [20, 21, 22, 23, 24, 25],
                "{colour}"
            );
            assert_eq!(frames[2].time_us, 160_000);
        }
    }

    #[test]
    fn deep_samples_follow_the_rule_of_depth() {
        let mut bytes = b"YUV4MPEG2 W2 H1 Cmono10\nFRAME\n".to_vec();
        bytes.extend([0x55, 0x02, 0xFF, 0xFF]);
        assert_eq!(
            read(&bytes, 10).unwrap().0[0].frame.borrowed_pixels().to_words(),
            [0x255, 0x3FF]
        );
        assert_eq!(read(&bytes, 8).unwrap().0[0].frame.borrowed_pixels().to_words(), [0x95, 0xFF]);
    }

    #[test]
    fn a_stream_cut_anywhere_gives_its_whole_frames_and_says_so() {
        let mut bytes = b"YUV4MPEG2 W4 H4 C420 F30:1\n".to_vec();
        let start = bytes.len();
        for _ in 0..3 {
            bytes.extend(b"FRAME\n");
            bytes.resize(bytes.len() + 24, 7);
        }
        for length in 0..bytes.len() {
            let whole = length.saturating_sub(start) / 30;
            match read(&bytes[..length], 8) {
                Ok((frames, problem)) => {
                    assert_eq!(frames.len(), whole);
                    assert_eq!(problem.is_some(), !(length - start).is_multiple_of(30), "{length}");
                }
                Err(error) => assert!(whole == 0 && !error.to_string().contains('\n'), "{error}"),
            }
        }
    }

    #[test]
    fn headers_that_make_no_sense_are_refused() {
        for header in [
            "",
            "RIFF",
            "YUV4MPEG2\n",
            "YUV4MPEG2 W4\n",
            "YUV4MPEG2 W0 H4\n",
            "YUV4MPEG2 W99999 H4\n",
            "YUV4MPEG2 W4 H4 C999\n",
            "YUV4MPEG2 W4 H4 C420p99\n",
            "YUV4MPEG2 W4 H4 C420p7\n",
            "YUV4MPEG2 W4 H4\nNOFRAME\n",
        ] {
            assert!(read(header.as_bytes(), 8).is_err(), "{header}");
        }
    }
}
