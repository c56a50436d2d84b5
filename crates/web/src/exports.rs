// SPDX-License-Identifier: MIT OR Apache-2.0
//! What WebAssembly exports: plain functions, called by `web/engine.js` alone.
//!
//! Bytes come through one buffer: [`foveate_input`] makes it as long as asked and says where it is. A call answers with a
//! number, 0 or more, or -1 where it refuses; then [`foveate_pointer`] and [`foveate_length`] say where the answer or the message
//! lies, until the next call. No call reads or writes through a pointer, so nothing here is unsafe but the names.
#![allow(
    unsafe_code,
    reason = "an export keeps its name, and the compiler cannot know that it is the only one"
)]

use std::cell::RefCell;

use foveate_frame::Plane;

use crate::limits::{MAX_NETWORK_FILE, MAX_PIXELS};
use crate::{Desk, LiveCamera, NetworkDesk, Sent, WebError};

/// The most bytes that can be put in: a network, which is more than a frame in colour.
const MAX_INPUT: usize = MAX_NETWORK_FILE;
const _: () = assert!(MAX_INPUT >= 4 * MAX_PIXELS as usize);

/// A page's desk and what lies between it and the page.
#[derive(Debug, Default)]
struct Counter {
    desk: Desk,
    network: NetworkDesk,
    input: Vec<u8>,
    answer: Vec<u8>,
    /// Where the answer lies, and how long it is.
    place: (usize, usize),
}

thread_local! {
    static COUNTER: RefCell<Counter> = RefCell::default();
}

impl Counter {
    /// Answers with text.
    fn say(&mut self, text: String) {
        self.answer = text.into_bytes();
        self.place = place(&self.answer);
    }

    /// The number of a call that went well, or -1 and the message.
    fn told(&mut self, result: Result<i32, WebError>) -> i32 {
        result.unwrap_or_else(|error| {
            self.say(error.to_string());
            -1
        })
    }

    /// Shows a frame to a camera.
    fn step(
        &mut self,
        handle: u32,
        time_us: f64,
        step: impl FnOnce(&mut LiveCamera, &[u8], Option<u64>) -> Result<Sent, WebError>,
    ) -> i32 {
        let Self { desk, input, .. } = self;
        let time_us = microseconds(time_us);
        let sent = desk.camera(handle).and_then(|camera| step(camera, input, time_us));
        let sent = sent.map(|sent| {
            self.say(serde_json::json!(sent).to_string());
            0
        });
        self.told(sent)
    }

    /// Answers with what a camera holds.
    fn show<T>(
        &mut self,
        handle: u32,
        seen: impl FnOnce(&LiveCamera) -> Result<&[T], WebError>,
    ) -> i32 {
        let found = self.desk.camera(handle).and_then(|camera| Ok(place(seen(camera)?)));
        let found = found.map(|place| {
            self.place = place;
            0
        });
        self.told(found)
    }

    /// Answers with pixels of a camera.
    fn plane(&mut self, handle: u32, of: impl FnOnce(&LiveCamera) -> Plane<'_>) -> i32 {
        let found = self.desk.camera(handle).map(|camera| match of(camera) {
            Plane::Bytes(pixels) => place(pixels),
            Plane::Words(pixels) => place(pixels),
        });
        let found = found.map(|place| {
            self.place = place;
            0
        });
        self.told(found)
    }
}

/// A time as JavaScript has it; none where it is negative or no number.
fn microseconds(time_us: f64) -> Option<u64> {
    /// All whole numbers up to here are numbers of JavaScript.
    const MOST: f64 = 9_007_199_254_740_992.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is in range")]
    (0.0..=MOST).contains(&time_us).then_some(time_us as u64)
}

/// Where values lie, and how many bytes they take.
fn place<T>(values: &[T]) -> (usize, usize) {
    (values.as_ptr().addr(), size_of_val(values))
}

fn at_the_counter<R>(call: impl FnOnce(&mut Counter) -> R) -> R {
    COUNTER.with_borrow_mut(call)
}

/// Makes the buffer for input `length` bytes long, and says where it is; 0 where that is more than the largest network.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_input(length: usize) -> usize {
    at_the_counter(|counter| {
        if length > MAX_INPUT {
            return 0;
        }
        counter.input.resize(length, 0);
        counter.input.as_ptr().addr()
    })
}

/// Where the last answer lies.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_pointer() -> usize {
    at_the_counter(|counter| counter.place.0)
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_length() -> usize {
    at_the_counter(|counter| counter.place.1)
}

/// Answers with what can be asked, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_describe() -> i32 {
    at_the_counter(|counter| {
        let told = counter.desk.describe().map(|told| {
            counter.say(told.to_string());
            0
        });
        counter.told(told)
    })
}

/// Makes a camera of the TOML that was put in; answers with its number, and what it is as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_configure(width: u32, height: u32) -> i32 {
    at_the_counter(|counter| {
        let made =
            counter.desk.configure(&counter.input, (width, height)).map(|(number, facts)| {
                counter.say(facts.to_string());
                // There are few.
                number.cast_signed()
            });
        counter.told(made)
    })
}

/// Shows a camera the 8-bit grey that was put in, of that time in microseconds since the first frame; below 0, frames are 30 a second.
/// Answers with what it sends, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_step_grey(handle: u32, time_us: f64) -> i32 {
    at_the_counter(|counter| counter.step(handle, time_us, LiveCamera::step_grey))
}

/// The same with colours, four bytes per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_step_rgba(handle: u32, time_us: f64) -> i32 {
    at_the_counter(|counter| counter.step(handle, time_us, LiveCamera::step_rgba))
}

/// Answers with what the camera saw: a byte per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_seen(handle: u32) -> i32 {
    at_the_counter(|counter| counter.show(handle, |camera| Ok(camera.input())))
}

/// Answers with what the receiver sees: a byte per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_screen(handle: u32) -> i32 {
    at_the_counter(|counter| counter.show(handle, |camera| Ok(camera.screen())))
}

/// Answers with what the camera saw as it has it: pixels of P bits, a byte each up to 8 bits, else two, the lower first.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_pixels(handle: u32) -> i32 {
    at_the_counter(|counter| counter.plane(handle, LiveCamera::pixels))
}

/// Answers with what the receiver sees, in the same way.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_rendered(handle: u32) -> i32 {
    at_the_counter(|counter| counter.plane(handle, |camera| camera.engine().rendered()))
}

/// Answers with a byte per region: what was decided.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_regions(handle: u32) -> i32 {
    at_the_counter(|counter| counter.show(handle, |camera| Ok(camera.regions())))
}

/// Answers with the scores of a feature: eight bytes per region.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_scores(handle: u32, feature: u32) -> i32 {
    at_the_counter(|counter| counter.show(handle, |camera| camera.scores(feature)))
}

/// Answers with the hash of the last frame's results, as 16 hexadecimal digits.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_hash(handle: u32) -> i32 {
    at_the_counter(|counter| {
        let hash = counter.desk.camera(handle).map(|camera| camera.engine().digest());
        let hash = hash.map(|hash| {
            counter.say(format!("{hash:016x}"));
            0
        });
        counter.told(hash)
    })
}

/// Begins or ends a recording: 0 ends it, 1 begins it with all regions, 2 with those that send something alone.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_record(handle: u32, how: u32) -> i32 {
    at_the_counter(|counter| {
        let done = counter.desk.camera(handle).map(|camera| {
            camera.record(how > 0, how > 1);
            0
        });
        counter.told(done)
    })
}

/// Answers with what was recorded: `events.csv`.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_events(handle: u32) -> i32 {
    at_the_counter(|counter| counter.show(handle, LiveCamera::events))
}

/// Answers with why a region of the last frame, whose name was put in, was sent or not: `{"json": .., "text": ..}`.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_explain(handle: u32, x: u32, y: u32) -> i32 {
    at_the_counter(|counter| {
        let Counter { desk, input, .. } = &mut *counter;
        let name = String::from_utf8_lossy(input);
        let told = desk.camera(handle).and_then(|camera| camera.explain((x, y), &name));
        let told = told.map(|told| {
            counter.say(serde_json::json!({ "text": told.to_string(), "json": told }).to_string());
            0
        });
        counter.told(told)
    })
}

/// Makes a camera forget every frame.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_reset(handle: u32) -> i32 {
    at_the_counter(|counter| {
        let done = counter.desk.camera(handle).map(|camera| {
            camera.reset();
            0
        });
        counter.told(done)
    })
}

/// Ends a camera.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_free(handle: u32) -> i32 {
    at_the_counter(|counter| {
        let done = counter.desk.free(handle).map(|()| 0);
        counter.told(done)
    })
}

/// Answers with a frame of the scene whose name was put in: a byte per pixel.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_scene(width: u32, height: u32, region_size: u32, number: u32) -> i32 {
    at_the_counter(|counter| {
        let Counter { desk, input, .. } = &mut *counter;
        let frame = desk.scene(input, (width, height), region_size, number).map(place);
        let frame = frame.map(|place| {
            counter.place = place;
            0
        });
        counter.told(frame)
    })
}

/// Takes over what was put in as the file of a network.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_network_file() -> i32 {
    at_the_counter(|counter| {
        let taken = counter.network.take(std::mem::take(&mut counter.input)).map(|()| 0);
        counter.told(taken)
    })
}

/// Makes the network of the file for frames of that size and depth, as wished by the JSON that was put in; answers with what it is, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_network_open(width: u32, height: u32, bits: u32) -> i32 {
    at_the_counter(|counter| {
        let Counter { network, input, .. } = &mut *counter;
        let told = network.open(input, (width, height), bits).map(|told| {
            counter.say(told.to_string());
            0
        });
        counter.told(told)
    })
}

/// Shows the network the frame that was put in and, behind it, what the receiver sees, both as [`foveate_pixels`] has them; answers with what
/// it says of them, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn foveate_network_look() -> i32 {
    at_the_counter(|counter| {
        let looked = counter.network.look(&counter.input).map(|looked| {
            counter.say(serde_json::json!(looked).to_string());
            0
        });
        counter.told(looked)
    })
}
