// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `FrameSync` alone: the table of `docs/sync.md`, and designs without it.

use foveate_design::{Design, DesignConfig};
use foveate_model::FrameSync;

fn design(more: &[&str]) -> Design {
    let toml = "frame = { width = 4, height = 2 }\nregion.size = 2\ntemporal.min_count = 1\n\
                spatial = [{ feature = 'edge', min_score = 1 }]\n";
    DesignConfig::from_toml_with(toml, more).unwrap().validate().unwrap()
}

/// Applies beats to frames of four: `A` is a marked beat, `a` one without a mark, `.` no beat, `-`
/// a beat while the array is closed, and `R` a reset. Returns for each edge: the beat is passed on
/// (`p`), an error after the edge (`!`), filling after the edge (`f`).
fn trace(text: &str) -> String {
    let mut sync = FrameSync::new(&design(&["hardware.sync=true"]));
    let mut all = Vec::new();
    for letter in text.chars() {
        let passed = match letter {
            'R' => {
                sync.reset();
                false
            }
            '.' => sync.step(false, true, true),
            '-' => sync.step(true, true, false),
            letter => sync.step(true, letter == 'A', true),
        };
        let signs = [(passed, 'p'), (sync.is_error(), '!'), (sync.is_filling(), 'f')];
        let shown: String = signs.iter().filter(|(is, _)| *is).map(|(_, sign)| *sign).collect();
        all.push(if shown.is_empty() { "0".to_owned() } else { shown });
    }
    all.join(" ")
}

#[test]
fn every_state_is_left_as_the_page_says() {
    for (stream, expected) in [
        // In state SEEK beats are dropped without an error. Gaps and a closed array change nothing.
        ("aa.-Aa-a.a", "0 0 0 0 p p 0 p 0 p"),
        // In state START the next frame begins at once, or there is an error and the state is SEEK.
        ("AaaaAaaa", "p p p p p p p p"),
        ("Aaaa.-aaA", "p p p p 0 0 ! 0 p"),
        // In state INSIDE a mark leads to FILL, which takes a beat at every open edge, marked or
        // not, until the frame is complete. Then the state is SEEK.
        ("AaAAaa", "p p !f pf p 0"),
        ("AA.-aAA", "p !f pf f pf p p"),
        // Resets come in every state.
        ("aRa", "0 0 0"),
        ("AaaaRa", "p p p p 0 0"),
        ("AaRaA", "p p 0 0 p"),
        ("AaARaA", "p p !f 0 0 p"),
        ("AAR", "p !f 0"),
    ] {
        assert_eq!(trace(stream), expected, "{stream}");
    }
}

#[test]
fn without_it_every_beat_is_passed_on() {
    let mut sync = FrameSync::new(&design(&[]));
    for (valid, sof, open) in
        [(true, false, true), (true, true, true), (true, true, true), (true, false, true)]
    {
        assert!(sync.step(valid, sof, open));
    }
    assert!(!sync.step(false, true, true) && !sync.step(true, true, false));
    assert!(!sync.is_error() && !sync.is_filling());
}
