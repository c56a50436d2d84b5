// SPDX-License-Identifier: MIT OR Apache-2.0
//! Objects that are counted by hand, or by a naive count.

use std::fs;
use std::path::PathBuf;
use std::slice::from_ref;

use super::{check_known, images, mot_rows, recall, row};
use crate::support::cells;
use foveate_design::DesignConfig;
use foveate_engine::Engine;
use foveate_explore::studies::{Study, StudyRequest, analyze};
use foveate_media::{InputOptions, SilentHooks, open};

#[test]
fn objects_of_a_known_clip_are_counted() {
    let dir = tempfile::tempdir().unwrap();
    let (clip, out) = (dir.path().join("clip"), dir.path().join("out"));
    images(&clip, 1, 0);
    fs::write(clip.join("gt.txt"), mot_rows(1, 0)).unwrap();
    let boxes = [PathBuf::from("gt.txt")];
    let report = recall(from_ref(&clip), &boxes, &InputOptions::default(), &out).unwrap();
    check_known(&report, "clip", &out);
    let charts = ["recall", "recall-size", "recall-speed", "recall-contrast"];
    let charts = charts.iter().flat_map(|chart| [format!("{chart}.svg"), format!("{chart}.png")]);
    let files: Vec<String> =
        ["recall.csv", "recall-tracks.csv"].map(str::to_owned).into_iter().chain(charts).collect();
    assert_eq!(report.files, files);
    let notes = fs::read_to_string(out.join("recall.csv")).unwrap();
    assert!(notes.contains(&format!(
        "# clip: boxes {} (MOT); 0 lie mostly outside",
        clip.join("gt.txt").display()
    )));
    assert!(notes.contains("0 of 4 frames have no entry"), "{notes}");
    // Every threshold and region size is there, and no class occurs twice.
    for (key, points) in [
        ("spatial.0.min_score", 9),
        ("temporal.level", 10),
        ("temporal.min_count", 9),
        ("region.size", 4),
    ] {
        let all = |row: &&Vec<String>| row[1] == key && row[3..6] == ["active", "all", "all"];
        assert_eq!(report.rows.iter().filter(all).count(), points, "{key}");
    }
    let printed = report.markdown();
    assert!(
        printed
            .contains("| clip | all | 9 | 55.6 % | 44.4 % | 44.4 % | 11.1 % | 100.0 % |  | 87 |")
    );
    assert!(
        printed.contains("| clip | tracks, at least once | 3 |") && !printed.contains("min_score")
    );
}

#[test]
fn several_clips_have_boxes_of_their_own_and_a_sum() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let clips = ["a", "b"].map(|name| dir.path().join(name));
    for clip in &clips {
        images(clip, 1, 0);
    }
    fs::write(clips[0].join("gt.txt"), mot_rows(1, 0)).unwrap();
    // The second clip has one object, which is active in one of its three counted frames.
    let second: String = mot_rows(1, 0)
        .lines()
        .filter(|row| row.contains(",2,17,"))
        .fold(String::new(), |all, row| all + row + "\n");
    fs::write(clips[1].join("gt.txt"), second).unwrap();
    let report = recall(&clips, &["gt.txt".into()], &InputOptions::default(), &out).unwrap();
    let half = |clip| row(&report, clip, "active", ("all", "all"))[3].clone();
    assert_eq!([half("a"), half("b"), half("all clips")], ["0.444444", "0.333333", "0.416667"]);
    let tracks = row(&report, "all clips", "active", ("track", "all"));
    assert_eq!(tracks[..6], ["4", "0.250000", "0.750000", "0.750000", "0.500000", "3"]);
    // The same files in the other order belong to the other clips.
    let files = [clips[1].join("gt.txt"), clips[0].join("gt.txt")];
    let swapped = recall(&clips, &files, &InputOptions::default(), &out).unwrap();
    assert_eq!(row(&swapped, "b", "active", ("all", "all"))[3], "0.444444");
}

/// Returns the rows or columns of regions that a span of pixels belongs to, by counting pixels.
/// `side` is the side of a region, and `size` that of the frame.
fn covered_grid_lines(from: u32, to: u32, side: u32, size: u32) -> Vec<u32> {
    let count = |line: u32, wanted: &dyn Fn(u32) -> bool| {
        (line * side..((line + 1) * side).min(size)).filter(|&at| wanted(at)).count()
    };
    let inside = |line: u32| count(line, &|at| (from..to).contains(&at));
    let all: Vec<u32> = (0..size.div_ceil(side)).collect();
    let half: Vec<u32> =
        all.iter().copied().filter(|&line| 2 * inside(line) >= count(line, &|_| true)).collect();
    if !half.is_empty() {
        return half;
    }
    let most = all.iter().map(|&line| inside(line)).max().unwrap();
    all.into_iter().filter(|&line| inside(line) == most).take(1).collect()
}

#[test]
fn a_naive_count_of_random_boxes_agrees() {
    let dir = tempfile::tempdir().unwrap();
    let (gt, out) = (dir.path().join("gt.txt"), dir.path().join("out"));
    let input = InputOptions { frames: Some(6), ..InputOptions::default() };
    let config = DesignConfig::from_toml("frame.width = 93\nframe.height = 70").unwrap();
    let mut random = fastrand::Rng::with_seed(7);
    let boxes: Vec<[u32; 5]> = (0..300)
        .map(|_| {
            let (x, y) = (random.u32(0..92), random.u32(0..69));
            [random.u32(1..=6), x, y, random.u32(1..=93 - x), random.u32(1..=70 - y)]
        })
        .collect();
    let rows = boxes.iter().enumerate().map(|(track, [frame, x, y, w, h])| {
        format!("{frame},{track},{},{},{w},{h},1,1,1\n", x + 1, y + 1)
    });
    fs::write(&gt, rows.collect::<String>()).unwrap();
    let scene = [PathBuf::from("scene:shake")];
    let request = StudyRequest {
        study: Study::Recall,
        inputs: &scene,
        input: &input,
        config: &config,
        sensor_events: None,
        sensor_start_us: 0,
        boxes: &[gt],
    };
    let report = analyze(&request, &out, true, &SilentHooks).unwrap();

    let design = config.validate().unwrap();
    let mut engine = Engine::new(&design);
    let mut source = open(&scene, &config.camera, &input).unwrap();
    let (mut objects, mut sums) = (0, [0; 4]);
    for number in 1..=6 {
        let frame = source.next_frame().unwrap().unwrap();
        let active = engine.step_byte_frame(&frame.frame).unwrap().active.clone();
        for [_, x, y, w, h] in boxes.iter().filter(|one| one[0] == number && number > 1) {
            let columns = covered_grid_lines(*x, x + w, 8, 93);
            let regions = covered_grid_lines(*y, y + h, 8, 70)
                .into_iter()
                .flat_map(|row| columns.iter().map(move |c| row * 12 + c));
            let votes: Vec<bool> = regions.map(|region| active[region as usize]).collect();
            let (yes, all) = (votes.iter().filter(|&&vote| vote).count(), votes.len());
            objects += 1;
            for (sum, seen) in
                sums.iter_mut().zip([yes == 0, 4 * yes >= all, 2 * yes >= all, yes == all])
            {
                *sum += u32::from(seen);
            }
        }
    }
    let found = &row(&report, "shake", "active", ("all", "all"))[..5];
    let shares = sums.map(|sum| format!("{:.6}", f64::from(sum) / f64::from(objects)));
    assert_eq!((found[0].as_str(), &found[1..]), (objects.to_string().as_str(), &shares[..]));
    assert!(sums.iter().all(|&sum| sum > 10 && sum < objects - 10), "it shows nothing: {sums:?}");
}

/// The real sequences are in the folder that the environment variable FOVEATE_DATA names.
#[test]
fn real_pedestrians_are_counted() {
    let Some(data) = foveate_tools::testing::data_folder() else { return };
    let dir = tempfile::tempdir().unwrap();
    let clip = data.join("mot17/MOT17-11");
    let input = InputOptions { resize: Some((480, 270)), ..InputOptions::default() };
    let report =
        recall(from_ref(&clip), &["gt.txt".into()], &input, dir.path().join("out").as_path())
            .unwrap();
    let gt = fs::read_to_string(clip.join("gt.txt")).unwrap();
    let rows = gt.lines().filter(|row| {
        let fields: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
        fields[0] > 1.0 && fields[6] == 1.0 && fields[7] == 1.0 && fields[8] >= 0.25
    });
    let objects: u64 = cells(&report, "objects")[0].parse().unwrap();
    assert_eq!(objects, rows.count() as u64, "none of them is mostly outside");
}
