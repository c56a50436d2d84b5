// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times at which a raster core sends, and what it loses without a buffer, worked out by hand
//! from docs/raster.md.

use foveate_design::{Design, DesignConfig};
use foveate_explore::link::{ArrayResults, LinkFigures, LinkUnit, SenderCameras, Timeline};
use foveate_pixels::FramePixels;

/// A frame of 20x12 pixels has 5x3 regions of 4.
const SIZE: &str = "frame={width=20,height=12}";
const CORE: &str = "hardware.organization=\"raster\"";
const REGION: &str = "region.size=4";
/// A feature without a window. With it D is 9, and S is 2 without a window.
pub(crate) const VARIANCE: &str = "spatial=[{feature=\"variance\",min_score=5000}]";
pub(crate) const NO_MEDIAN: &str = "denoise.filter=\"none\"";
/// A clock of 1 MHz, with a period of 1 us.
pub(crate) const MEGAHERTZ: u64 = 1_000_000;
/// The rate of a link that is never in the way.
const FAST: u64 = 1_000_000_000;

pub(crate) fn design(overrides: &[&str]) -> Design {
    let all: Vec<&str> = [&[SIZE, CORE, REGION][..], overrides].concat();
    DesignConfig::from_toml_with("", &all).unwrap().validate().unwrap()
}

/// Returns the timeline of two frames of 12 ms, with one row per millisecond.
fn timeline() -> Timeline {
    Timeline::new("clip", &[0, 12_000], 12).unwrap()
}

/// Returns a frame in which these regions have a pattern. All others are black.
pub(crate) fn frame(design: &Design, patterned: &[u32]) -> Vec<u8> {
    let (width, size) = (design.width(), design.region_size());
    let pixel = |place: u32| {
        let (x, y) = (place % width, place / width);
        let region = y / size * design.columns() + x / size;
        if patterned.contains(&region) && (x + y) % 2 == 0 { 255 } else { 0 }
    };
    (0..width * design.height()).map(pixel).collect()
}

/// Returns the results of a clip of equal frames. In the first frame the regions with a pattern are
/// active, and in the others none is.
fn play(design: &Design, clock: Option<u64>, rate: u64, patterned: &[u32]) -> ArrayResults {
    let timeline = timeline();
    let cameras = SenderCameras::new("clip", design, &timeline, clock).unwrap();
    let mut core = cameras.raster_array(rate).unwrap();
    for _ in 0..timeline.frames() {
        core.step(FramePixels::Bytes(&frame(design, patterned))).unwrap();
    }
    core.finish()
}

/// Returns the times of reading, decision and sending in us, and the bits.
fn times(units: &[LinkUnit]) -> Vec<(u64, u64, u64, u64)> {
    units
        .iter()
        .map(|u| (u.read_ns / 1000, u.decided_ns / 1000, u.sent_ns / 1000, u.bits))
        .collect()
}

/// A row has 20 words, which come at consecutive clocks, the last one when the row has been read.
#[test]
fn a_core_sends_row_of_regions_by_row_of_regions_while_it_takes_pixels() {
    let design = design(&[VARIANCE, NO_MEDIAN]);
    let at = |clock| play(&design, clock, FAST, &[0, 4, 11, 12]);
    // Region 4 is decided 9 clocks after its last word. It enters the queue at 10, is held at 12,
    // when the last word of region 0 is fetched, and its 16 words are fetched from 13 to 28. The
    // last word is out at 29.
    let row_0 = (9, 29);
    // Region 11 is decided at 9 - 12, and its last word is out at 29 - 12. Region 12 is decided at
    // 9 - 8 and waits for region 11: its last word is out 16 clocks later than that of region 11.
    let row_2 = (9, 29 - 12 + 16);
    let expected = [
        (1_000, 4_000 + row_0.0, 4_000 + row_0.0, 10),
        (1_000, 4_000 + row_0.0, 4_000 + row_0.1, 32 * 8),
        (5_000, 8_009, 8_009, 10),
        (9_000, 12_000 + row_2.0, 12_000 + row_2.0, 10),
        (9_000, 12_000 + row_2.0, 12_000 + row_2.1, 32 * 8),
        (13_000, 16_009, 16_009, 10),
        (17_000, 20_009, 20_009, 10),
        (21_000, 24_009, 24_009, 10),
    ];
    let clocked = at(Some(MEGAHERTZ));
    assert_eq!(times(&clocked.units), expected);
    assert_eq!(clocked.added_clocks, row_2.1);
    // Without a clock everything leaves when its row has been read.
    let instant = at(None);
    let rows = [4_000, 4_000, 8_000, 12_000, 12_000, 16_000, 20_000, 24_000];
    let without = expected.iter().zip(rows).map(|(unit, at)| (unit.0, at, at, unit.3));
    assert_eq!(times(&instant.units), without.collect::<Vec<_>>());
}

/// At the slowest clock that keeps up, 249 clocks take 12 ms, and a row of pixels takes 20.75.
#[test]
fn a_core_adds_its_clocks_of_the_clip_at_the_slowest_clock() {
    let design = design(&[VARIANCE, NO_MEDIAN]);
    let timeline = timeline();
    let cameras = SenderCameras::new("clip", &design, &timeline, None).unwrap();
    // There are 240 words, and 9 clocks until the last decision, in 12 ms.
    assert_eq!(cameras.needed_clock_hz(), 20_750);
    // The row of regions 2 is that of the test above, and row 0 sends less.
    assert_eq!(play(&design, None, FAST, &[0, 4, 11, 12]).added_clocks, 33);
    assert_eq!(play(&design, None, FAST, &[0, 4]).added_clocks, 29);
    // Without words, the first row of regions of the second frame is the latest. The last word of
    // the first frame is taken at edge 249, and the first one of the second frame 10 clocks later.
    // The 80th word of the second frame is taken at edge 338, and the row has been read at edge
    // 332.
    assert_eq!(play(&design, None, FAST, &[]).added_clocks, 338 + 9 - 332);
}

/// A window waits for a row and a word more. Below the frame the core makes them by itself.
#[test]
fn a_core_with_windows_waits_for_the_rows_below() {
    let design = design(&[]);
    // The median and the edges wait for two rows and two words. These are the first two words of a
    // third row, and come 18 clocks before that has been read. D is 11.
    let above = |rows: u64| 1_000 * (rows + 3) - 18 + 11;
    // These are two rows of 20 words and two words, one per clock.
    let below = 12_000 + 42 + 11;
    let units = play(&design, Some(MEGAHERTZ), FAST, &[]).units;
    let expected = [(1_000, above(4)), (5_000, above(8)), (9_000, below)];
    assert_eq!(times(&units)[..3], expected.map(|(read, at)| (read, at, at, 10)));
    let units = play(&design, None, FAST, &[]).units;
    let expected = [(1_000, 7_000), (5_000, 11_000), (9_000, 12_000)];
    assert_eq!(times(&units)[..3], expected.map(|(read, at)| (read, at, at, 10)));
}

/// Every time is later by at most the stated clocks, and one time is later by these, apart from the
/// part of a clock until the first edge after a row has been read.
#[test]
fn the_clocks_of_a_core_are_left_out_and_stated() {
    let (mad, sent) = ("spatial=[{feature=\"mad\"}]", "temporal.reference=\"last-sent\"");
    let words = ["hardware.pixels_per_clock=2", "frame.width=30"];
    for set in [&[][..], &[VARIANCE, NO_MEDIAN], &[mad], &words, &[sent], &[sent, mad]] {
        let design = design(set);
        let all: Vec<u32> = (0..design.regions()).collect();
        let timeline = timeline();
        let needed =
            SenderCameras::new("clip", &design, &timeline, None).unwrap().needed_clock_hz();
        assert!(
            SenderCameras::new("clip", &design, &timeline, Some(needed - 1)).is_err(),
            "{set:?}"
        );
        let without = play(&design, None, FAST, &all);
        let with = play(&design, Some(needed), FAST, &all);
        let later = with.units.iter().zip(&without.units).map(|(with, without)| {
            assert_eq!((with.read_ns, with.bits), (without.read_ns, without.bits), "{set:?}");
            with.sent_ns.saturating_sub(without.sent_ns)
        });
        // The clocks of this test are far below 1 GHz, and its times are below a minute.
        let clocks = later.max().unwrap() * needed / 1_000_000_000;
        let stated = without.added_clocks;
        assert!((stated..=stated + 1).contains(&clocks), "{set:?}: {clocks}, not {stated}");
        assert_eq!(with.added_clocks, stated, "{set:?}");
        assert!(with.units.iter().any(|unit| unit.bits > 10), "{set:?}");
    }
}

/// A row has 64 words and 16 regions. The pixels of region 0 are out before the last decision of
/// its row.
#[test]
fn pixels_may_leave_before_the_last_decision_of_their_row() {
    let design = design(&[VARIANCE, NO_MEDIAN, "frame.width=64"]);
    let clocked = play(&design, Some(MEGAHERTZ), FAST, &[0]);
    // Region 0 is decided 9 clocks after its last word, and its last word is out 20 clocks later.
    let out = 4_000 - 60 + 9 + 20;
    let expected = [(1_000, 4_009, 4_009, 32), (1_000, out, out, 16 * 8)];
    assert_eq!(times(&clocked.units)[..2], expected);
    assert_eq!(clocked.added_clocks, 9);
}

/// The link takes a word at every hundredth clock. The first row of regions has 80 words. The first
/// is on the ports at 3,998, and is taken at 4,000. From then on a word is taken at every multiple
/// of 100, and the next is on the ports at the same edge.
#[test]
fn a_slow_link_loses_regions_without_a_buffer() {
    let design = design(&[VARIANCE, NO_MEDIAN]);
    let at = |rate| play(&design, Some(MEGAHERTZ), rate, &[0, 1, 2, 3, 4]);
    let slow = at(8 * MEGAHERTZ / 100);
    let unbuffered = slow.unbuffered.clone().unwrap();
    // Row of regions 0 is stale when the first word of row of regions 2 is stored, at 8,983. Word k
    // is fetched at 4,000 + 100 (k - 2), so that word 51 is the last one. It is the fourth word of
    // region 3, which is lost in the middle, and region 4 before a word of it leaves.
    assert_eq!((unbuffered.lost_regions, &unbuffered.frames_with_losses[..]), (2, &[0][..]));
    // Word 51 is on the ports at 9,000, and is taken at 9,100.
    assert_eq!(unbuffered.last_word_ns, (9_100 - 1_000) * 1000);
    assert_eq!(unbuffered.clock_hz, MEGAHERTZ);
    // With a link that is as fast as the core nothing is lost: 80 words follow each other.
    let fast = at(8 * MEGAHERTZ);
    let unbuffered = fast.unbuffered.unwrap();
    assert_eq!((unbuffered.lost_regions, unbuffered.frames_with_losses.len()), (0, 0));
    assert_eq!(unbuffered.last_word_ns, (3_998 + 80 - 1_000) * 1000);
    // A word less in a hundred, and a link that takes a word in two clocks, are fast enough, too.
    for rate in [8 * MEGAHERTZ * 99 / 100, 4 * MEGAHERTZ] {
        assert_eq!(at(rate).unbuffered.unwrap().lost_regions, 0, "{rate}");
    }
    // The buffer in front of the link does not change with its rate.
    assert_eq!(slow.units, fast.units);
}

/// A row has 16 words of two pixels and 8 regions of 8 words. The link takes a word of 16 bits at
/// every hundredth clock.
#[test]
fn a_word_of_two_pixels_takes_the_time_of_both() {
    let words = ["hardware.pixels_per_clock=2", "frame.width=32"];
    let design = design(&[VARIANCE, NO_MEDIAN, words[0], words[1]]);
    let at = |rate| {
        let results = play(&design, Some(MEGAHERTZ), rate, &[0, 1, 2, 3, 4, 5, 6, 7]);
        results.unbuffered.unwrap()
    };
    // Word k is on the ports at 4,000 + 100 k, and is fetched 100 clocks earlier. The last one that
    // is fetched before 8,987 is word 50, the third of region 6.
    let slow = at(16 * MEGAHERTZ / 100);
    assert_eq!((slow.lost_regions, slow.last_word_ns), (2, (9_100 - 1_000) * 1000));
    let fast = at(16 * MEGAHERTZ);
    assert_eq!((fast.lost_regions, fast.last_word_ns), (0, (4_000 + 64 - 1_000) * 1000));
}

/// A buffer keeps what the link has lost in the test above: 10 bits of decisions at 4,009 and 640
/// bits of pixels at 4,077, on a link that needs 12.5 us for a bit.
#[test]
fn a_buffer_keeps_the_regions_of_a_slow_link() {
    let design = design(&[VARIANCE, NO_MEDIAN]);
    let rate = 8 * MEGAHERTZ / 100;
    let units = play(&design, Some(MEGAHERTZ), rate, &[0, 1, 2, 3, 4]).units;
    assert_eq!(times(&units)[1], (1_000, 4_009, 4_077, 640));
    let figures = LinkFigures::from_units(units, &timeline(), rate);
    // 4.56 bits of the decisions are left when the pixels come.
    assert_eq!(figures.buffer_bytes, 645_u64.div_ceil(8));
    // The last bit has left 650 bits after 4,009.
    assert_eq!(figures.delivery_ns.longest, (4_009 - 1_000) * 1000 + 650 * 12_500);
    assert!(!figures.overloaded);
}

/// A core that waits for pending regions loses none, but makes the next frame wait.
#[test]
fn a_core_with_few_rows_of_regions_waits_for_a_slow_link() {
    let sent = "temporal.reference=\"last-sent\"";
    let design = design(&[VARIANCE, NO_MEDIAN, sent, "frame.height=8"]);
    let timeline = Timeline::new("clip", &[0, 8_000], 8).unwrap();
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(MEGAHERTZ)).unwrap();
    let mut core = cameras.raster_array(8 * MEGAHERTZ / 100).unwrap();
    let all: Vec<u32> = (0..10).collect();
    for patterned in [&all[..], &[]] {
        core.step(FramePixels::Bytes(&frame(&design, patterned))).unwrap();
    }
    let unbuffered = core.finish().unbuffered.unwrap();
    assert_eq!(unbuffered.lost_regions, 0);
    // The 160 words of the first frame are taken at 4,000 and at every multiple of 100 after it.
    // Its second row of regions was read from 5,000 on.
    assert_eq!(unbuffered.last_word_ns, (4_000 + 159 * 100 - 5_000) * 1000);
}
