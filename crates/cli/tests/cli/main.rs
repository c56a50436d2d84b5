// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the command line, end to end: every command as its users call it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod area;
mod bench;
mod build;
mod bus;
mod check_clip;
mod common;
mod core;
mod crate_map;
mod dataset;
mod decode;
mod design;
mod disturbances;
mod endless;
mod explore;
mod footage;
mod force;
mod full_disk;
mod hardware;
mod help;
mod infer;
mod infer_alone;
mod infer_clips;
mod infer_files;
mod infer_noise;
mod inputs;
mod link;
mod live;
#[cfg(unix)]
mod occupied;
mod outputs;
mod own_files;
mod prefix;
mod progress;
mod secrets;
mod serial;
mod served;
mod signals;
mod silicon;
mod silicon_explore;
mod silicon_fit;
mod simulation;
mod stress;
mod studies;
mod synth;
mod terminal;
mod threads;
mod units;
mod user_texts;
mod view;
mod waiting;
mod zones;
