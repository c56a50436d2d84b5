// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exports of WebAssembly: plain functions, which only `web/engine.js` calls.
//!
//! Input comes through one buffer: [`foveate_input`] gives it the requested length and returns its
//! address. A call returns a number of 0 or more, or -1 if it refuses. [`foveate_pointer`] and
//! [`foveate_length`] then give the address and length of the answer or the message, which stay
//! valid until the next call. No call reads or writes through a pointer, so that only the exported
//! names need `unsafe`.
#![allow(
    unsafe_code,
    reason = "an export keeps its name, and the compiler cannot know that it is the only one"
)]

use std::cell::RefCell;

use foveate_pixels::FramePixels;

use super::limits::{MAX_NETWORK_FILE, MAX_PIXELS};
use crate::{FrameSummary, LiveCamera, PageCameras, PageNetwork, WebError};

/// The largest input in bytes: the file of a network, which is larger than a frame in colour.
const MAX_INPUT: usize = MAX_NETWORK_FILE;
const _: () = assert!(MAX_INPUT >= 4 * MAX_PIXELS as usize);

/// The state of a page, and the buffers between it and the page.
#[derive(Debug, Default)]
struct PageState {
    desk: PageCameras,
    network: PageNetwork,
    input: Vec<u8>,
    answer: Vec<u8>,
    /// The address of the answer, and its length in bytes.
    answer_place: (usize, usize),
}

thread_local! {
    static PAGE_STATE: RefCell<PageState> = RefCell::default();
}

impl PageState {
    fn set_answer(&mut self, text: String) {
        self.answer = text.into_bytes();
        self.answer_place = address_and_length(&self.answer);
    }

    /// Returns the number of a successful call, or makes the error message the answer and returns
    /// -1.
    fn answer_number(&mut self, result: Result<i32, WebError>) -> i32 {
        result.unwrap_or_else(|error| {
            self.set_answer(error.to_string());
            -1
        })
    }

    /// Shows a frame to a camera, and makes the result the answer.
    fn step(
        &mut self,
        handle: u32,
        time_us: f64,
        step: impl FnOnce(&mut LiveCamera, &[u8], Option<u64>) -> Result<FrameSummary, WebError>,
    ) -> i32 {
        let Self { desk, input, .. } = self;
        let time_us = microseconds(time_us);
        let sent = desk.camera(handle).and_then(|camera| step(camera, input, time_us));
        let sent = sent.map(|sent| {
            self.set_answer(serde_json::json!(sent).to_string());
            0
        });
        self.answer_number(sent)
    }

    /// Makes values that a camera holds the answer.
    fn answer_values<T>(
        &mut self,
        handle: u32,
        seen: impl FnOnce(&LiveCamera) -> Result<&[T], WebError>,
    ) -> i32 {
        let found =
            self.desk.camera(handle).and_then(|camera| Ok(address_and_length(seen(camera)?)));
        let found = found.map(|place| {
            self.answer_place = place;
            0
        });
        self.answer_number(found)
    }

    fn answer_pixels(
        &mut self,
        handle: u32,
        of: impl FnOnce(&LiveCamera) -> FramePixels<'_>,
    ) -> i32 {
        let found = self.desk.camera(handle).map(|camera| match of(camera) {
            FramePixels::Bytes(pixels) => address_and_length(pixels),
            FramePixels::Words(pixels) => address_and_length(pixels),
        });
        let found = found.map(|place| {
            self.answer_place = place;
            0
        });
        self.answer_number(found)
    }
}

/// Converts a time from JavaScript; `None` if it is negative or not a number.
fn microseconds(time_us: f64) -> Option<u64> {
    /// JavaScript represents all whole numbers up to this one exactly.
    const MOST: f64 = 9_007_199_254_740_992.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in range")]
    (0.0..=MOST).contains(&time_us).then_some(time_us as u64)
}

/// Returns the address of values, and their length in bytes.
fn address_and_length<T>(values: &[T]) -> (usize, usize) {
    (values.as_ptr().addr(), size_of_val(values))
}

fn with_page_state<R>(call: impl FnOnce(&mut PageState) -> R) -> R {
    PAGE_STATE.with_borrow_mut(call)
}

/// Gives the input buffer a length of `length` bytes, and returns its address; 0 if that is more
/// than the largest network.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_input(length: usize) -> usize {
    with_page_state(|counter| {
        if length > MAX_INPUT {
            return 0;
        }
        counter.input.resize(length, 0);
        counter.input.as_ptr().addr()
    })
}

/// Returns the address of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_pointer() -> usize {
    with_page_state(|counter| counter.answer_place.0)
}

/// Returns the length of the last answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_length() -> usize {
    with_page_state(|counter| counter.answer_place.1)
}

/// Answers with the description of what a page can ask for, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_describe() -> i32 {
    with_page_state(|counter| {
        let told = counter.desk.description().map(|told| {
            counter.set_answer(told.to_string());
            0
        });
        counter.answer_number(told)
    })
}

/// Makes a camera from the TOML in the input buffer. Returns its number, and answers with the facts
/// about it, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_configure(width: u32, height: u32) -> i32 {
    with_page_state(|counter| {
        let made =
            counter.desk.configure(&counter.input, (width, height)).map(|(number, facts)| {
                counter.set_answer(facts.to_string());
                // There are at most [`crate::MAX_CAMERAS`] cameras, so that the number fits.
                number.cast_signed()
            });
        counter.answer_number(made)
    })
}

/// Sets the classes of the regions of a camera with zones, from the next frame on. The input buffer
/// has the number of a class per region. Answers with the facts about the camera, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_classes(handle: u32) -> i32 {
    with_page_state(|counter| {
        let PageState { desk, input, .. } = &mut *counter;
        let facts = desk.set_classes(handle, input).map(|facts| {
            counter.set_answer(facts.to_string());
            0
        });
        counter.answer_number(facts)
    })
}

/// Shows a camera the frame of 8-bit grey in the input buffer. `time_us` is the time since the
/// first frame in microseconds; if it is negative, there are 30 frames per second. Answers with
/// what the camera sends, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_step_grey(handle: u32, time_us: f64) -> i32 {
    with_page_state(|counter| counter.step(handle, time_us, LiveCamera::step_grey))
}

/// Shows a camera the frame in the input buffer as [`foveate_step_grey`] does, but with four bytes
/// of colour per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_step_rgba(handle: u32, time_us: f64) -> i32 {
    with_page_state(|counter| counter.step(handle, time_us, LiveCamera::step_rgba))
}

/// Answers with the last frame that the camera has seen: a byte per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_seen(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_values(handle, |camera| Ok(camera.input())))
}

/// Answers with the receiver's screen: a byte per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_screen(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_values(handle, |camera| Ok(camera.screen())))
}

/// Answers with the last frame as the camera has it, in pixels of P bits. Pixels of up to 8 bits
/// have one byte each; deeper pixels have two, the lower first.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_pixels(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_pixels(handle, LiveCamera::pixels))
}

/// Answers with the receiver's screen, in pixels as [`mod@foveate_pixels`] has them.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_rendered(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_pixels(handle, |camera| camera.engine().rendered()))
}

/// Answers with the decisions: a byte per region.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_regions(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_values(handle, |camera| Ok(camera.regions())))
}

/// Answers with the displacements: three signed bytes per region, which are the columns to the
/// right and the rows down by which its content moved, and 1 if `flow` votes for it, else 0. The
/// answer is empty for a camera without `flow`, and before the first frame.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_displacements(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_values(handle, |camera| Ok(camera.displacements())))
}

/// Answers with the scores of a feature: eight bytes per region.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_scores(handle: u32, feature: u32) -> i32 {
    with_page_state(|counter| counter.answer_values(handle, |camera| camera.scores(feature)))
}

/// Answers with the hash of the last frame's results, as 16 hexadecimal digits.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_hash(handle: u32) -> i32 {
    with_page_state(|counter| {
        let hash = counter.desk.camera(handle).map(|camera| camera.engine().digest());
        let hash = hash.map(|hash| {
            counter.set_answer(format!("{hash:016x}"));
            0
        });
        counter.answer_number(hash)
    })
}

/// Begins or ends a recording: 0 ends it, 1 begins one of all regions, and 2 begins one of regions
/// that send something.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_record(handle: u32, how: u32) -> i32 {
    with_page_state(|counter| {
        let done = counter.desk.camera(handle).map(|camera| {
            camera.set_recording(how > 0, how > 1);
            0
        });
        counter.answer_number(done)
    })
}

/// Answers with the recording, as `events.csv`.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_events(handle: u32) -> i32 {
    with_page_state(|counter| counter.answer_values(handle, LiveCamera::recorded_events))
}

/// Answers with the reason why a region of the last frame was sent or not: `{"json": .., "text":
/// ..}`. The input buffer holds the name of the frame.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_explain(handle: u32, x: u32, y: u32) -> i32 {
    with_page_state(|counter| {
        let PageState { desk, input, .. } = &mut *counter;
        let name = String::from_utf8_lossy(input);
        let told = desk.camera(handle).and_then(|camera| camera.explain((x, y), &name));
        let told = told.map(|told| {
            counter.set_answer(
                serde_json::json!({ "text": told.to_string(), "json": told }).to_string(),
            );
            0
        });
        counter.answer_number(told)
    })
}

/// Makes a camera forget all frames.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_reset(handle: u32) -> i32 {
    with_page_state(|counter| {
        let done = counter.desk.camera(handle).map(|camera| {
            camera.reset();
            0
        });
        counter.answer_number(done)
    })
}

/// Ends a camera.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_free(handle: u32) -> i32 {
    with_page_state(|counter| {
        let done = counter.desk.remove(handle).map(|()| 0);
        counter.answer_number(done)
    })
}

/// Answers with a frame of the scene whose name is in the input buffer: a byte per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_scene(width: u32, height: u32, region_size: u32, number: u32) -> i32 {
    with_page_state(|counter| {
        let PageState { desk, input, .. } = &mut *counter;
        let frame =
            desk.scene_frame(input, (width, height), region_size, number).map(address_and_length);
        let frame = frame.map(|place| {
            counter.answer_place = place;
            0
        });
        counter.answer_number(frame)
    })
}

/// Takes the content of the input buffer as the file of a network.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_network_file() -> i32 {
    with_page_state(|counter| {
        let taken = counter.network.set_file(std::mem::take(&mut counter.input)).map(|()| 0);
        counter.answer_number(taken)
    })
}

/// Makes the network of the file for frames of this size and depth, with the settings in the input
/// buffer, which are JSON. Answers with the facts about it, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_network_open(width: u32, height: u32, bits: u32) -> i32 {
    with_page_state(|counter| {
        let PageState { network, input, .. } = &mut *counter;
        let told = network.open(input, (width, height), bits).map(|told| {
            counter.set_answer(told.to_string());
            0
        });
        counter.answer_number(told)
    })
}

/// Runs the network on two frames in the input buffer: the whole frame and, behind it, the
/// receiver's screen, both in pixels as [`mod@foveate_pixels`] has them. Answers with a comparison of
/// its outputs, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_network_look() -> i32 {
    with_page_state(|counter| {
        let looked = counter.network.compare(&counter.input).map(|looked| {
            counter.set_answer(serde_json::json!(looked).to_string());
            0
        });
        counter.answer_number(looked)
    })
}
