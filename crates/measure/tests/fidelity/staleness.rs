// SPDX-License-Identifier: MIT OR Apache-2.0
//! The staleness of a screen, with exact numbers by hand.

use foveate_camera::{Camera, CameraConfig, Decimal, ReferencePolicy};
use foveate_measure::{Fidelity, FrameOrder, Staleness};
use foveate_pixels::ByteFrame;

use crate::results::{
    blank_ideal, blank_outcome, config, frame_from_words, pixels, shown_as_denoised, tally,
};

/// Returns a camera in which every region is relevant; a pixel has changed if it differs by more
/// than 2.
fn fading(reference: ReferencePolicy) -> Camera {
    let mut config = config((16, 8), 8, 8);
    config.spatial[0].min_score = Some(Decimal::from_whole(0));
    config.temporal.level = Some(2);
    config.temporal.reference = reference;
    config.validate().unwrap()
}

fn fade(camera: &Camera, frames: u16) -> Vec<ByteFrame> {
    (0..frames).map(|level| frame_from_words(camera, vec![10 + level; pixels(camera)])).collect()
}

/// The candidate with `previous` sends only the first of eight frames, because it never sees a
/// change of one level per frame. Its screen stays at 10 while the scene goes to 17. Frames 3 to 7
/// differ by more than 2.
#[test]
fn a_fade_is_stale_once_it_has_left_the_level_behind() {
    let (ideal, candidate) = (fading(ReferencePolicy::LastSent), fading(ReferencePolicy::Previous));
    let figures = tally(&ideal, &candidate, &fade(&ideal, 8)).figures();
    let expected = Staleness { max: 7.0, mean: 28.0 / 8.0, longest: 5, share: 5.0 / 8.0 };
    assert_eq!(figures.staleness, expected);
    assert_eq!(figures.stale_regions, 5.0 / 8.0);
    // The ideal sends frames 0, 3 and 6. The first frame does not count as active: every camera
    // sends it.
    assert_eq!((figures.ideal_active, figures.active), (3.0 / 8.0, 1.0 / 8.0));
    assert_eq!((figures.missed, figures.false_alarms), (1.0, 0.0));
    // The squared differences of the screens are 9 in frames 3 to 5, and 36 in frames 6 and 7.
    let mse: f64 = (3.0 * 9.0 + 2.0 * 36.0) / 8.0;
    assert_eq!(figures.psnr_ideal, Some(10.0 * (255.0 * 255.0 / mse).log10()));
}

#[test]
fn pixels_that_were_sent_are_never_stale() {
    let camera = fading(ReferencePolicy::LastSent);
    let figures = tally(&camera, &camera, &fade(&camera, 8)).figures();
    // The differences are 0 1 2 0 1 2 0 1.
    let expected = Staleness { max: 2.0, mean: 7.0 / 8.0, longest: 0, share: 0.0 };
    assert_eq!(figures.staleness, expected);
}

/// Returns the staleness of one region with made-up frames: whether it is relevant, and the number
/// of its pixels from which the screen differs by 9.
fn region_staleness(
    config: &CameraConfig,
    frames: &[(bool, usize)],
    next_clip_at: Option<usize>,
) -> Staleness {
    let camera = config.validate().unwrap();
    let mut fidelity = Fidelity::new(&camera, &camera).unwrap();
    let input = frame_from_words(&camera, vec![0; pixels(&camera)]);
    for (number, &(srs, differing)) in frames.iter().enumerate() {
        if next_clip_at == Some(number) {
            fidelity.next_clip();
        }
        let mut ideal = blank_ideal(&camera);
        ideal.srs = vec![srs];
        ideal.denoised[..differing].fill(9.0);
        let (blank, mut denoised) = (blank_outcome(&camera), Vec::new());
        let candidate = shown_as_denoised(&blank, input.borrowed_pixels(), &mut denoised);
        fidelity.add(&input, &ideal, candidate, FrameOrder::Later).unwrap();
    }
    fidelity.tally().figures().staleness
}

#[test]
fn a_frame_that_is_not_relevant_or_not_stale_ends_a_run() {
    let mut config = config((8, 8), 8, 8);
    (config.temporal.level, config.temporal.min_count) = (Some(8), 3);
    let run = |frames: &[(bool, usize)]| {
        let staleness = region_staleness(&config, frames, None);
        (staleness.longest, staleness.share)
    };
    assert_eq!(run(&[(true, 3); 5]), (5, 1.0));
    assert_eq!(run(&[(true, 3), (true, 3), (false, 3), (true, 64)]), (2, 1.0));
    assert_eq!(run(&[(true, 3), (true, 2), (true, 4), (true, 4)]), (2, 0.75));
    assert_eq!(run(&[(false, 64); 3]), (0, 0.0));
    let two_clips = region_staleness(&config, &[(true, 3); 5], Some(2));
    assert_eq!((two_clips.longest, two_clips.share), (3, 1.0), "a clip ends every run");
    config.temporal.level = Some(9);
    assert_eq!(region_staleness(&config, &[(true, 64)], None).share, 0.0, "9 is not more than 9");
}

#[test]
fn a_minimum_count_is_limited_to_one_and_to_the_pixels_of_a_region() {
    let mut config = config((8, 8), 8, 8);
    (config.temporal.level, config.temporal.min_count) = (Some(8), 0);
    assert_eq!(region_staleness(&config, &[(true, 0), (true, 1)], None).share, 0.5);
    // Only 2x3 pixels of an 8x8 region lie inside of the frame.
    (config.frame.width, config.frame.height) = (Some(2), Some(3));
    config.temporal.min_count = 20;
    assert_eq!(region_staleness(&config, &[(true, 5), (true, 6)], None).share, 0.5);
}
