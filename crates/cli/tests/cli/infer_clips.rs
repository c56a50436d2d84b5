// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `infer` over several clips, end to end: the output, and the inputs that cannot be
//! combined.

use std::fs;

use crate::common::{run_in, run_successfully};
use serde_json::Value;

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");

/// Returns a stream of grey frames of which a part moves.
fn stream(width: usize, height: usize, frames: usize) -> Vec<u8> {
    let mut file = format!("YUV4MPEG2 W{width} H{height} F30:1 Cmono\n").into_bytes();
    for frame in 0..frames {
        file.extend_from_slice(b"FRAME\n");
        let pixel = |at: usize| if (at % width).abs_diff(8 * frame) < 8 { 250 } else { 10 };
        file.extend((0..width * height).map(pixel).map(|value: u8| value));
    }
    file
}

#[test]
fn each_clip_and_all_clips_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.y4m"), stream(64, 48, 4)).unwrap();
    let mut cut = stream(64, 48, 6);
    cut.truncate(cut.len() - 100);
    fs::write(dir.path().join("b.y4m"), cut).unwrap();
    let args = ["infer", DENOISER, "a.y4m", "b.y4m", "-o", "out", "--force"];
    // The last frame of `b` is incomplete.
    let outcome = run_in(dir.path(), &args);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("`out` is not complete: `b`: "), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("  a: 4 frames, regions active "), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("  b: 5 frames, regions active "), "{}", outcome.stdout);
    assert!(outcome.stdout.contains(", NOT COMPLETE: "), "{}", outcome.stdout);
    let frames = fs::read_to_string(dir.path().join("out/frames.csv")).unwrap();
    assert_eq!(frames.lines().filter(|line| line.contains(",a,")).count(), 4, "{frames}");
    assert_eq!(frames.lines().filter(|line| line.contains(",b,false,")).count(), 1, "{frames}");
    let found: Value =
        serde_json::from_slice(&fs::read(dir.path().join("out/inference.json")).unwrap()).unwrap();
    assert_eq!(found["configuration"]["frame"]["width"], 64);
    assert_eq!(found["design"].as_str().unwrap().len(), 16, "{}", found["design"]);
    assert_eq!((&found["clips"][1]["name"], &found["complete"]), (&"b".into(), &false.into()));
    let tuned = run_successfully(
        dir.path(),
        &[
            "infer",
            DENOISER,
            "a.y4m",
            "scene:street",
            "-o",
            "out",
            "--force",
            "--tune",
            "variation=30%",
        ]
        .into_iter()
        .chain(["--max-frames", "4", "--set", "frame={width=64,height=48}"])
        .collect::<Vec<_>>(),
    );
    assert!(tuned.contains("tuned      on 3 counted frames of a, in "), "{tuned}");
    assert!(tuned.contains(" on street"), "{tuned}");
}
