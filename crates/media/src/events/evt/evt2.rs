// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of EVT 2.0, which have 32 bits: the type in the highest four, and for an event the low
//! six bits of its time, x and y with 11 bits each.

use super::time_base::{TimeBaseDecoder, TimeBaseEncoder};
use crate::events::PixelEvent;

/// An event of a pixel that became darker.
const DARKER: u32 = 0x0;
/// An event of a pixel that became brighter.
const BRIGHTER: u32 = 0x1;
/// The high part of times.
const TIME_HIGH: u32 = 0x8;
/// The bits of the high part, and those of the low part.
const HIGH_BITS: u32 = 28;
const LOW_BITS: u32 = 6;
/// The bits of a coordinate.
const SIDE_BITS: u32 = 11;

/// Makes words of events.
#[derive(Clone, Debug)]
pub(crate) struct Evt2Encoder {
    base: TimeBaseEncoder,
}

impl Evt2Encoder {
    pub(crate) fn new() -> Self {
        Self { base: TimeBaseEncoder::new(HIGH_BITS) }
    }

    /// Appends the words of an event, which is not earlier than the last one.
    pub(crate) fn push(&mut self, event: PixelEvent, words: &mut Vec<u8>) {
        let PixelEvent { x, y, time_us, is_brighter } = event;
        let mut append = |kind: u32, content: u64| {
            let content = u32::try_from(content).expect("it has 28 bits");
            words.extend((kind << HIGH_BITS | content).to_le_bytes());
        };
        self.base.advance(time_us >> LOW_BITS, false, |high| append(TIME_HIGH, high));
        let low = time_us & ((1 << LOW_BITS) - 1);
        let place = u64::from(x) << SIDE_BITS | u64::from(y);
        append(if is_brighter { BRIGHTER } else { DARKER }, low << (2 * SIDE_BITS) | place);
    }
}

/// Makes events of words.
#[derive(Clone, Debug)]
pub(crate) struct Evt2Decoder {
    base: TimeBaseDecoder,
}

impl Evt2Decoder {
    pub(crate) fn new() -> Self {
        Self { base: TimeBaseDecoder::new(HIGH_BITS) }
    }

    /// Takes a word. Returns its event; `None` for other words, and for events before the first
    /// time. Triggers and words of a vendor have no event.
    pub(crate) fn take(&mut self, word: u32) -> Option<PixelEvent> {
        let kind = word >> HIGH_BITS;
        if kind == TIME_HIGH {
            self.base.take(u64::from(word & ((1 << HIGH_BITS) - 1)));
            return None;
        }
        let is_event = kind == BRIGHTER || kind == DARKER;
        let high = self.base.high().filter(|_| is_event)?;
        let bits = |at: u32, count: u32| word >> at & ((1 << count) - 1);
        let side = |at: u32| u16::try_from(bits(at, SIDE_BITS)).expect("it has 11 bits");
        Some(PixelEvent {
            x: side(SIDE_BITS),
            y: side(0),
            time_us: high << LOW_BITS | u64::from(bits(2 * SIDE_BITS, LOW_BITS)),
            is_brighter: kind == BRIGHTER,
        })
    }
}
