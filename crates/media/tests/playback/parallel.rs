// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of clips in parallel.

use foveate_media::run_in_parallel;

#[test]
fn results_are_in_the_order_of_the_clips() {
    let squares: Vec<_> = (0..50).map(|clip| Some(clip * clip)).collect();
    assert_eq!(run_in_parallel(50, |clip| Some(clip * clip)), squares);
    assert_eq!(run_in_parallel(0, Some), []);
    let stopped = run_in_parallel(50, |clip| (clip < 9).then_some(clip));
    assert_eq!(stopped.iter().flatten().count(), 9);
}
