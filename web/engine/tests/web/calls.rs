// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that any calls of a page, in any order and with any numbers, give an answer or a message,
//! and never a panic.

use foveate_web::exports::{
    foveate_classes, foveate_configure, foveate_describe, foveate_displacements, foveate_events,
    foveate_explain, foveate_free, foveate_hash, foveate_input, foveate_length,
    foveate_network_file, foveate_network_look, foveate_network_open, foveate_pixels,
    foveate_record, foveate_regions, foveate_rendered, foveate_reset, foveate_scene,
    foveate_scores, foveate_screen, foveate_seen, foveate_step_grey, foveate_step_rgba,
};

/// A generator of random numbers, the same in every run.
struct RandomNumbers(u64);

impl RandomNumbers {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        u32::try_from(self.0 >> 40).unwrap() % end
    }

    /// Returns a number below `end` in most cases, and otherwise one that is too large.
    fn number(&mut self, end: u32) -> u32 {
        match self.below(12) {
            0 => u32::MAX - self.below(2),
            1 => end + self.below(9),
            _ => self.below(end),
        }
    }
}

#[test]
fn any_calls_in_any_order_are_answered() {
    let mut random = RandomNumbers(7);
    let (mut answered, mut refused) = (0, 0);
    for _ in 0..30_000 {
        let (handle, x, y) = (random.number(8), random.number(4), random.number(4));
        // The input is only zeros: frames, an empty configuration, or a name that no scene has.
        let bytes = [0, 1, 12 * 12, 4 * 12 * 12, 17 * 9][random.below(5) as usize];
        assert_ne!(foveate_input(bytes), 0);
        let time = [-1.0, 0.0, 40.7, f64::NAN, f64::INFINITY, 1e300][random.below(6) as usize];
        let side = [12, 12, 12, 17, 0][random.below(5) as usize];
        let answer = match random.below(25) {
            0 => {
                foveate_input(0);
                foveate_configure(side, if side == 17 { 9 } else { 12 })
            }
            1 => foveate_configure(x, y),
            2 => foveate_free(handle),
            3 => foveate_reset(handle),
            4 => foveate_record(handle, x),
            5 => foveate_events(handle),
            6 => foveate_hash(handle),
            7 => foveate_screen(handle),
            8 => foveate_seen(handle),
            9 => foveate_regions(handle),
            10 => foveate_scores(handle, x),
            11 => foveate_explain(handle, x, y),
            12 => foveate_scene(x, y, x, y),
            13 if x == 0 => foveate_describe(),
            18 => foveate_pixels(handle),
            19 => foveate_rendered(handle),
            20 => foveate_network_file(),
            21 => foveate_network_open(side, x, random.number(17)),
            22 => foveate_network_look(),
            23 => foveate_displacements(handle),
            24 => foveate_classes(handle),
            14 => foveate_step_rgba(handle, time),
            _ => foveate_step_grey(handle, time),
        };
        if answer < 0 {
            assert!(foveate_length() > 10, "a refusal has a message");
            refused += 1;
        } else {
            answered += 1;
        }
    }
    assert!(answered > 5_000 && refused > 5_000, "{answered} answered, {refused} refused");
    assert_eq!(foveate_input(usize::MAX), 0);
}
