// SPDX-License-Identifier: MIT OR Apache-2.0
//! A source whose reading is counted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use foveate_media::{ClipPlayer, FootageError, FrameSource, SourceFrame, SourceKind};
use foveate_pixels::ByteFrame;

pub(crate) const SIDE: u32 = 16;

/// The number of frames that were read, and of those that came back.
#[derive(Clone, Default)]
pub(crate) struct ReadCounts {
    pub(crate) read: Arc<AtomicU64>,
    pub(crate) recycled: Arc<AtomicU64>,
}

impl ReadCounts {
    pub(crate) fn read(&self) -> u64 {
        self.read.load(Ordering::Relaxed)
    }
}

/// A source of frames of which each has the value of its number.
pub(crate) struct CountedSource {
    pub(crate) inputs: [String; 1],
    pub(crate) frames: u64,
    pub(crate) kind: SourceKind,
    pub(crate) problem: Option<String>,
    /// The number of the frame at which the source panics.
    pub(crate) panic_at: Option<u64>,
    pub(crate) counts: ReadCounts,
}

impl CountedSource {
    pub(crate) fn new(frames: u64) -> Self {
        let (inputs, counts) = (["counted".to_owned()], ReadCounts::default());
        let kind = SourceKind::Clip;
        Self { inputs, frames, kind, problem: None, panic_at: None, counts }
    }

    pub(crate) fn player(self) -> ClipPlayer {
        let source: Box<dyn FrameSource> = Box::new(self);
        source.into()
    }
}

impl FrameSource for CountedSource {
    fn size(&self) -> (u32, u32) {
        (SIDE, SIDE)
    }

    fn inputs(&self) -> &[String] {
        &self.inputs
    }

    fn frames(&self) -> Option<u64> {
        Some(self.frames)
    }

    fn next_frame(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let number = self.counts.read();
        assert_ne!(Some(number), self.panic_at, "the source has a fault");
        if number == self.frames {
            return Ok(None);
        }
        self.counts.read.fetch_add(1, Ordering::Relaxed);
        let bytes = vec![u8::try_from(number % 256).unwrap(); (SIDE * SIDE) as usize];
        let frame = ByteFrame::from_bytes(SIDE, SIDE, 8, bytes)?;
        Ok(Some(SourceFrame { name: number.to_string(), time_us: number, label: None, frame }))
    }

    fn recycle(&mut self, _: SourceFrame) {
        self.counts.recycled.fetch_add(1, Ordering::Relaxed);
    }

    fn kind(&self) -> SourceKind {
        self.kind
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }
}
