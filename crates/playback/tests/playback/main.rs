// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the playback of clips.

mod clips;
mod monitor;
mod parallel;
mod player;
mod support;
