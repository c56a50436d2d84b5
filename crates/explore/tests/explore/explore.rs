// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explorations over scenes: the files that are written, the results that are kept, and the results
//! that are measured again.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use foveate_emit::Top;
use foveate_estimate::{EstimateJob, estimate};
use foveate_explore::{
    DesignSpace, Exploration, ExploreError, ExploreRequest, SynthesisRequest, Synthesizer, explore,
};
use foveate_media::{InputOptions, PlaybackError, RunHooks, RunProgress, testing::RecordingHooks};
use foveate_tools::{Cache, Tool, Toolchain, testing::require_tools};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

pub(crate) const SPACE: &str = "method = 'each'\n[design]\nframe.width = 48\nframe.height = 32\nregion.neighborhood = 'shared'\n\
     temporal.reference = 'last-sent'\n[vary]\nframe.pixel_bits = [8, 6, 3]\nregion.size = [16]\n\
     temporal.reference = ['previous']\ntemporal.min_count = [5, 10]\nhardware.organization = ['serial']\n";

pub(crate) fn run(
    text: &str,
    inputs: &[&str],
    output: &Path,
    hooks: &RecordingHooks,
) -> Result<Exploration, ExploreError> {
    let space = DesignSpace::from_toml(text).unwrap();
    let inputs: Vec<PathBuf> = inputs.iter().map(PathBuf::from).collect();
    let input = InputOptions { frames: Some(12), ..InputOptions::default() };
    explore(
        &ExploreRequest {
            space: &space,
            inputs: &inputs,
            input: &input,
            disturbance: None,
            synthesis: None,
        },
        output,
        hooks,
    )
}

fn lines(file: &Path) -> Vec<String> {
    fs::read_to_string(file).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn every_figure_is_in_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let found =
        run(SPACE, &["scene:street", "scene:shake"], &output, &RecordingHooks::new()).unwrap();
    // The start also has 8 bits and a count of 5, and a serial array computes the same as the
    // start.
    assert_eq!(found.rows.len(), 7);
    let row = |what: &str| {
        found.rows.iter().find(|row| row.settings.iter().any(|value| value.contains(what))).unwrap()
    };
    let start = &found.rows[0].figures;
    assert_eq!((start.frames, start.action_flips, start.psnr_ideal), (24, 0.0, None));
    assert_eq!(row("serial").figures, *start);
    assert!(row("serial").clocks_per_frame > found.rows[0].clocks_per_frame);
    for what in ["3", "16", "previous"] {
        let figures = &row(what).figures;
        assert!(figures.action_flips > 0.0 && figures.psnr_ideal.is_some(), "{what}: {figures:?}");
    }
    assert!(row("6").figures.action_flips <= row("3").figures.action_flips);
    let points = lines(&output.join("points.csv"));
    assert_eq!(points.len(), 8);
    assert!(points[0].starts_with("point,frame.pixel_bits,region.size,"), "{}", points[0]);
    let columns = points[0].split(',').count();
    assert!(points.iter().all(|line| line.split(',').count() == columns));
    assert_eq!(lines(&output.join("clips.csv")).len(), 1 + 2 * 7);
    // The worst clip has the most flips of the lines of its design.
    let clips = lines(&output.join("clips.csv"));
    let flips = clips[0].split(',').position(|column| column == "action_flips").unwrap();
    let cell = |line: &str, column: usize| line.split(',').nth(column).unwrap().to_owned();
    for row in &found.rows {
        let own = clips.iter().filter(|line| cell(line, 0) == row.number.to_string());
        let own = own.map(|line| (cell(line, flips).parse::<f64>().unwrap(), cell(line, 1)));
        let worst = own.max_by(|one, other| one.0.total_cmp(&other.0)).unwrap();
        let expected = (worst.0 > 0.0).then_some(worst);
        let found = row.worst_clip.clone().map(|clip| (clip.action_flips, clip.name));
        assert_eq!(found, expected, "point {}", row.number);
    }
    for row in &found.rows {
        let toml = fs::read_to_string(output.join(format!("designs/{}.toml", row.number))).unwrap();
        let design = foveate_design::DesignConfig::from_toml(&toml).unwrap().validate().unwrap();
        assert_eq!(design.fingerprint(), row.fingerprint);
    }
    let parquet = fs::read(output.join("points.parquet")).unwrap();
    assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
}

/// Hooks that look at the folder when the first synthesis begins.
struct SynthesisWatch<'a> {
    folder: &'a Path,
    has_begun: AtomicBool,
}

impl RunHooks for SynthesisWatch<'_> {
    fn progress(&self, progress: &RunProgress<'_>) {
        if progress.label == "synthesizing with Yosys"
            && !self.has_begun.swap(true, Ordering::Relaxed)
        {
            let page = fs::read_to_string(self.folder.join("report.html")).unwrap();
            assert!(page.contains("The areas of 2 of 2 designs are not known yet"));
            assert_eq!(lines(&self.folder.join("points.csv")).len(), 3);
            assert!(
                lines(&self.folder.join("exploration.json"))[0].contains("\"finished\": false")
            );
        }
    }

    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Each design has the clock of its own netlist, unless the space gives a clock. Page and tables
/// have the errors before the first synthesis begins.
#[test]
fn a_point_has_the_clock_of_its_netlist() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    const TINY: &str = "[design]\nframe.width = 16\nframe.height = 8\n[vary]\ndenoise.filter = ['none']\n\
         hardware.organization = ['pipelined', 'serial']\n";
    let synthesizer =
        Synthesizer { toolchain: Toolchain::system(), cache: Cache::from_env().unwrap() };
    let folder = tempfile::tempdir().unwrap();
    let inputs = [PathBuf::from("scene:street")];
    let input = InputOptions { frames: Some(3), ..InputOptions::default() };
    for (clock, name) in [("", "own"), ("clock_mhz = 50\n", "given")] {
        let space = &DesignSpace::from_toml(&format!("{clock}{TINY}")).unwrap();
        let output = folder.path().join(name);
        let synthesis = Some(SynthesisRequest { synthesizer: &synthesizer, process: None });
        let request =
            ExploreRequest { space, inputs: &inputs, input: &input, disturbance: None, synthesis };
        let watch = SynthesisWatch { folder: &output, has_begun: AtomicBool::new(false) };
        let found = explore(&request, &output, &watch).unwrap();
        assert!(watch.has_begun.into_inner());
        let page = fs::read_to_string(output.join("report.html")).unwrap();
        assert!(!page.contains("are not known yet") && page.contains("of the device"));
        let points = lines(&output.join("points.csv"));
        let at = points[0].split(',').position(|column| column == "clock_mhz").unwrap();
        for (row, line) in found.rows.iter().zip(&points[1..]) {
            let design = row.config.validate().unwrap();
            let job = EstimateJob::for_design(&design, Top::Rcm);
            let clock =
                estimate(&synthesizer.toolchain, &synthesizer.cache, &job).unwrap().clock.unwrap();
            let expected = if name == "own" { clock.mhz } else { 50.0 };
            let speed = row.speed.unwrap();
            let clocks = f64::from(u32::try_from(row.clocks_per_frame).unwrap());
            assert_eq!(speed.clock_mhz, expected);
            assert_eq!(speed.frames_per_second, expected * 1e6 / clocks);
            let cell: f64 = line.split(',').nth(at).unwrap().parse().unwrap();
            assert!((cell - expected).abs() < 1e-9 * expected, "{line}");
        }
        assert_ne!(found.rows[0].clocks_per_frame, found.rows[1].clocks_per_frame);
    }
}

/// The tables have the area of a core on AXI, and not that of the array in it.
#[test]
#[ignore = "`cli` synthesizes such a core in every run; scripts/release.sh whole runs it"]
fn a_core_on_axi_is_counted_as_a_whole() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    const ON_AXI: &str = "[design]\nframe.width = 32\nframe.height = 16\nregion.size = 4\nhardware.organization = 'raster'\n\
         hardware.interface = 'axi'\n[vary]\ndenoise.filter = ['none']\n";
    let synthesizer =
        Synthesizer { toolchain: Toolchain::system(), cache: Cache::from_env().unwrap() };
    let folder = tempfile::tempdir().unwrap();
    let space = &DesignSpace::from_toml(ON_AXI).unwrap();
    let inputs = [PathBuf::from("scene:street")];
    let input = InputOptions { frames: Some(2), ..InputOptions::default() };
    let synthesis = Some(SynthesisRequest { synthesizer: &synthesizer, process: None });
    let request =
        ExploreRequest { space, inputs: &inputs, input: &input, disturbance: None, synthesis };
    let found = explore(&request, &folder.path().join("out"), &RecordingHooks::new()).unwrap();
    let design = found.rows[0].config.validate().unwrap();
    let job = EstimateJob::for_design(&design, Top::Rcm);
    let report = estimate(&synthesizer.toolchain, &synthesizer.cache, &job).unwrap();
    let silicon = found.rows[0].silicon.as_ref().unwrap();
    assert_eq!(
        (silicon.array, silicon.logic_levels),
        (report.bus.as_ref().unwrap().whole, report.levels())
    );
    assert!(silicon.array.lut_total > report.rcm.lut_total && report.rcm.lut_total > 0);
}

/// Returns every cell of a column of `points.parquet` as text.
fn parquet_column(file: &Path, name: &str) -> Vec<String> {
    let reader = SerializedFileReader::new(fs::File::open(file).unwrap()).unwrap();
    let of = |row: parquet::record::Row| {
        let (_, field) = row.get_column_iter().find(|(column, _)| *column == name).unwrap();
        match field {
            Field::Str(text) => text.clone(),
            other => panic!("{name} is no string: {other:?}"),
        }
    };
    reader.get_row_iter(None).unwrap().map(|row| of(row.unwrap())).collect()
}

#[test]
fn strings_are_plain_in_every_table() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let space = "[design]\nframe.width = 48\nframe.height = 32\n[vary]\nhardware.organization = ['pipelined', 'serial']\n";
    let found = run(space, &["scene:street"], &output, &RecordingHooks::new()).unwrap();
    let expected = ["pipelined", "serial"];
    let lines = lines(&output.join("points.csv"));
    let column = lines[0].split(',').position(|name| name == "hardware.organization").unwrap();
    let cells: Vec<&str> =
        lines[1..].iter().map(|line| line.split(',').nth(column).unwrap()).collect();
    assert_eq!(cells, expected);
    let cells = parquet_column(&output.join("points.parquet"), "hardware_organization");
    assert_eq!(cells, expected);
    let settings: Vec<&[String]> = found.rows.iter().map(|row| row.settings.as_slice()).collect();
    assert_eq!(settings, [["pipelined"], ["serial"]]);
    assert_eq!(found.settings_text(&found.rows[1]), "hardware.organization = serial");
}

#[test]
fn a_rerun_does_only_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let whole = run(SPACE, &["scene:street"], &output, &RecordingHooks::new()).unwrap();
    let again = RecordingHooks::cancelling_after(1);
    let same = run(SPACE, &["scene:street"], &output, &again).unwrap();
    assert_eq!(again.reports().len(), 0);
    assert_eq!(serde_json::to_string(&same).unwrap(), serde_json::to_string(&whole).unwrap());
    let larger = SPACE.replace("[8, 6, 3]", "[8, 7, 6, 3]");
    let more = RecordingHooks::new();
    assert_eq!(run(&larger, &["scene:street"], &output, &more).unwrap().rows.len(), 8);
    assert_eq!(more.reports().len(), 12);
}

#[test]
fn an_interrupted_run_keeps_what_is_finished() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    // The run is stopped after all frames of the first clip and some of the second.
    let stopped =
        run(SPACE, &["scene:street", "scene:fade"], &output, &RecordingHooks::cancelling_after(16));
    assert!(
        matches!(stopped, Err(ExploreError::Playback(PlaybackError::Interrupted))),
        "{stopped:?}"
    );
    assert_eq!(fs::read_dir(output.join("measured")).unwrap().count(), 6);
    let rest = RecordingHooks::new();
    let whole = run(SPACE, &["scene:street", "scene:fade"], &output, &rest).unwrap();
    assert_eq!((whole.rows.len(), rest.reports().len()), (7, 12));
    let fresh = folder.path().join("fresh");
    let at_once =
        run(SPACE, &["scene:street", "scene:fade"], &fresh, &RecordingHooks::new()).unwrap();
    let figures =
        |found: &Exploration| found.rows.iter().map(|row| row.figures.clone()).collect::<Vec<_>>();
    assert_eq!(figures(&whole), figures(&at_once));
}

#[test]
fn a_damaged_result_is_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let whole = run(SPACE, &["scene:street"], &output, &RecordingHooks::new()).unwrap();
    for file in fs::read_dir(output.join("measured")).unwrap() {
        fs::write(file.unwrap().path(), "{").unwrap();
    }
    let again = run(SPACE, &["scene:street"], &output, &RecordingHooks::new()).unwrap();
    assert_eq!(whole.rows[3].figures, again.rows[3].figures);
}

#[test]
fn what_cannot_be_explored_is_refused_before_work() {
    let folder = tempfile::tempdir().unwrap();
    let taken = folder.path().join("taken");
    fs::create_dir(&taken).unwrap();
    fs::write(taken.join("mine.txt"), "mine").unwrap();
    let never = RecordingHooks::cancelling_after(1);
    let occupied = run(SPACE, &["scene:street"], &taken, &never).unwrap_err();
    assert!(matches!(occupied, ExploreError::OtherFolder { .. }), "{occupied}");
    let none = "[vary]\nregion.size = [1]\n";
    let output = folder.path().join("out");
    let refused = run(none, &["scene:street"], &output, &never).unwrap_err();
    assert!(refused.to_string().contains("region.size = 1"), "{refused}");
    assert!(!output.exists());
}

/// Thresholds that are left out follow the depth, so that a camera with fewer bits still sees
/// changes.
#[test]
fn a_camera_of_any_depth_sees_about_as_much() {
    let folder = tempfile::tempdir().unwrap();
    let space = "[design]\nframe.width = 128\nframe.height = 96\ntemporal.reference = 'last-sent'\n[vary]\nframe.pixel_bits = [16, 12, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1]\n";
    let output = folder.path().join("out");
    let found = run(space, &["scene:street"], &output, &RecordingHooks::new()).unwrap();
    let active =
        |bits: &str| found.rows.iter().find(|row| row.settings[0] == bits).unwrap().figures.active;
    for row in &found.rows {
        let share = row.figures.active;
        // With 4 bits and fewer, one level is as large as the changes of the scene.
        if row.config.camera.frame.pixel_bits >= 5 {
            assert!((share / active("8") - 1.0).abs() < 0.05, "{} bits: {share}", row.settings[0]);
        }
        assert!((0.05..0.5).contains(&share), "{} bits: {share}", row.settings[0]);
    }
}
