// SPDX-License-Identifier: MIT OR Apache-2.0
//! Raw video, in which frames follow one another without headers. The user gives their size and
//! pixel format. The stream comes from a file or a pipe.

use std::io::BufRead;

use foveate_pixels::ByteFrame;

use crate::bayer::{BayerPattern, MIN_MOSAIC_SIDE};
use crate::raw_layout::RawLayout;
use crate::stream::{StreamFeed, StreamFormat, is_at_end, read_whole, skip_whole};
use crate::{FootageError, InputOptions, LumaRange};

/// The frames of raw video.
pub(crate) struct RawVideo {
    layout: RawLayout,
    luma: LumaRange,
    bayer: Option<BayerPattern>,
    bits: u32,
}

/// Opens raw video. `length` is the number of its bytes, if it is known.
///
/// # Errors
/// Fails if the options ask for a mosaic, but the pixels have colours.
pub(crate) fn open_raw(
    name: String,
    length: Option<u64>,
    input: Box<dyn BufRead + Send>,
    layout: RawLayout,
    bits: u32,
    options: &InputOptions,
) -> Result<StreamFeed<RawVideo>, FootageError> {
    let &InputOptions { frame_rate, luma, bayer, ref interrupt, .. } = options;
    if bayer.is_some() {
        check_mosaic(layout)
            .map_err(|problem| FootageError::Option { option: "--bayer", problem })?;
    }
    let format = RawVideo { layout, luma, bayer, bits };
    let feed = StreamFeed::new(name, input, format, frame_rate, interrupt.clone());
    Ok(match length {
        Some(length) => feed.with_total(length / layout.frame_bytes()),
        None => feed,
    })
}

/// Returns a text that says why frames of a layout cannot be mosaics.
fn check_mosaic(layout: RawLayout) -> Result<(), String> {
    if !layout.is_grey() {
        return Err(
            "the pixels of a mosaic are grey; give a format of --raw such as gray or gray12le"
                .to_owned(),
        );
    }
    if !layout.has_sides(MIN_MOSAIC_SIDE) {
        return Err(format!(
            "frames of a mosaic have at least {MIN_MOSAIC_SIDE}x{MIN_MOSAIC_SIDE} pixels; check the size that --raw gives"
        ));
    }
    Ok(())
}

impl StreamFormat for RawVideo {
    fn read_frame(
        &mut self,
        input: &mut dyn BufRead,
        memory: Vec<u8>,
    ) -> Result<Option<ByteFrame>, String> {
        if is_at_end(input)? {
            return Ok(None);
        }
        let mut bytes = memory;
        bytes.resize(self.layout.first_bytes(), 0);
        let read = read_whole(input, &mut bytes)
            .and_then(|()| skip_whole(input, self.layout.other_bytes()));
        read.map_err(|problem| {
            format!(
                "{problem} of {} bytes; check the size and the pixel format that --raw gives",
                self.layout.frame_bytes()
            )
        })?;
        let samples = self.layout.samples(self.luma == LumaRange::Full);
        let bytes = self.layout.sorted(bytes);
        let frame = match self.bayer {
            None => samples.byte_frame(bytes, self.bits),
            Some(pattern) => samples.frame_of_mosaic(&bytes, pattern, self.bits),
        };
        frame.map(Some).map_err(|error| error.to_string())
    }

    fn luma(&self) -> Option<LumaRange> {
        self.layout.has_video_luma().then_some(self.luma)
    }

    fn takes_timestamps(&self) -> bool {
        true
    }

    fn reads_mosaics(&self) -> bool {
        true
    }

    fn no_frame_error(&self, name: String, problem: String) -> FootageError {
        FootageError::Raw { name, problem }
    }
}
