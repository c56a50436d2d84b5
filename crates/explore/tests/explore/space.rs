// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spaces as files define them.

use foveate_camera::Decimal;
use foveate_design::DesignConfig;
use foveate_explore::{BUILT_IN_SPACES, DesignSpace};

fn points(text: &str) -> (Vec<DesignConfig>, Vec<String>) {
    let (points, refused) = DesignSpace::from_toml(text).unwrap().points(64, 48);
    let configs = points.into_iter().map(|point| point.config).collect();
    (
        configs,
        refused.into_iter().map(|refused| refused.settings + ": " + &refused.reason).collect(),
    )
}

fn problem(text: &str) -> String {
    DesignSpace::from_toml(text).unwrap_err().to_string()
}

#[test]
fn a_grid_has_every_combination_that_is_a_design() {
    let (configs, refused) = points(
        "[vary]\nhardware.organization = ['pipelined', 'serial']\nhardware.fold = [1, 2]\nregion.size = [8]\n",
    );
    assert_eq!(configs.len(), 3);
    assert_eq!(refused.len(), 1);
    let of = "hardware.organization = pipelined, hardware.fold = 2, region.size = 8: ";
    assert!(refused[0].starts_with(of), "{refused:?}");
    assert!(configs.iter().all(|config| config.camera.frame.width == Some(64)));
}

/// An empty table `zones` makes a camera with zones, also in a space.
#[test]
fn zones_without_keys_are_zones() {
    let (configs, _) = points("[design]\nzones = {}\n[vary]\nregion.size = [8, 16]\n");
    assert_eq!(configs.len(), 2);
    assert!(configs.iter().all(|config| config.camera.zones.is_some()));
}

/// A frame of 320x240 pixels has 1,200 regions of 8x8, and the default frame has 784.
#[test]
fn the_start_is_judged_with_the_size_of_the_clips() {
    let text = "[design]\nhardware.organization = 'serial'\nhardware.fold = 1200\n[vary]\nframe.pixel_bits = [8, 6]\n";
    let (points, refused) = DesignSpace::from_toml(text).unwrap().points(320, 240);
    assert_eq!((points.len(), refused.len()), (2, 0));
    let (points, refused) = DesignSpace::from_toml(text).unwrap().points(224, 224);
    assert_eq!((points.len(), refused.len()), (0, 2));
    assert!(refused[0].reason.contains("1..=784"), "{refused:?}");
}

#[test]
fn one_at_a_time_starts_from_the_start() {
    let text = "method = 'each'\n[design]\nregion.size = 4\n[vary]\nregion.size = [4, 8]\nframe.pixel_bits = [5]\n";
    let space = DesignSpace::from_toml(text).unwrap();
    let (points, refused) = space.points(64, 48);
    let described: Vec<String> =
        points.iter().map(|point| space.settings_of_point(&point.settings)).collect();
    // The point with regions of 4 equals the start.
    assert_eq!(described, ["the start", "region.size = 8", "frame.pixel_bits = 5"]);
    assert!(refused.is_empty());
}

#[test]
fn thresholds_are_in_grey_levels_of_the_start() {
    let text = "[design]\nspatial = [{ feature = 'edge', level = 101, min_score = 5 }, { feature = 'mad', min_score = 5 }, { feature = 'variance', min_score = 50 }]\n\
                temporal.level = 9\n[vary]\nframe.pixel_bits = [8, 5, 10]\n";
    let (configs, _) = points(text);
    let of = |config: &DesignConfig| {
        let [edge, mad, variance] = config.camera.spatial.as_slice() else {
            panic!("three features")
        };
        let score = |entry: &foveate_camera::SpatialConfig| entry.min_score.unwrap();
        (
            edge.level.unwrap(),
            config.camera.temporal.level.unwrap(),
            score(edge),
            score(mad),
            score(variance),
        )
    };
    let whole = Decimal::from_whole;
    assert_eq!(of(&configs[0]), (101, 9, whole(5), whole(5), whole(50)));
    let eighths = |value| Decimal::from_f64(value).unwrap();
    assert_eq!(of(&configs[1]), (12, 1, whole(5), eighths(0.625), eighths(0.78125)));
    assert_eq!(of(&configs[2]), (404, 36, whole(5), whole(20), whole(800)));
    // Varied thresholds are also in grey levels of the start, and the ideal camera follows its own
    // depth.
    let text = "[design]\nframe.pixel_bits = 6\ntemporal.level = 3\n[ideal]\nframe.pixel_bits = 8\n[vary]\nframe.pixel_bits = [6, 5]\ntemporal.level = [2, 10]\n";
    let levels: Vec<u32> =
        points(text).0.iter().map(|config| config.camera.temporal.level.unwrap()).collect();
    assert_eq!(levels, [2, 10, 1, 5]);
    assert_eq!(DesignSpace::from_toml(text).unwrap().ideal.temporal.level, Some(12));
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let wrong = [
        ("methods = 'grid'", "unknown field"),
        ("method = 'all'", "use \"grid\", \"each\" or \"sample\""),
        ("method = 'sample'", "needs points"),
        ("points = 3", "only for method = \"sample\""),
        ("clock_mhz = 0", "not within 1 to 10000"),
        ("preset = 'none'", "paper"),
        ("[vary]\nregion.size = 8", "is not a list of values"),
        ("[design]\nregion.sise = 8", "[design]"),
        ("method = 'each'\n[vary]\nregion.sise = [8]", "[vary]"),
        ("[ideal]\nregion.size = 1", "[ideal]"),
        (
            "[vary]\na = [1,2,3,4,5,6,7,8,9,10]\nb = [1,2,3,4,5,6,7,8,9,10]\nc = [1,2,3,4,5,6,7,8,9,10]\n\
          d = [1,2,3,4,5,6,7,8,9,10]\ne = [1,2,3,4,5,6,7,8,9,10]\nf = [1,2]",
            "more than 100000 points",
        ),
        ("= 1", "line 1"),
    ];
    for (text, part) in wrong {
        let problem = problem(text);
        assert!(problem.contains(part), "{text}: {problem}");
    }
}

#[test]
fn spaces_of_the_program_are_spaces() {
    for space in BUILT_IN_SPACES {
        let read = DesignSpace::from_toml(space.toml).unwrap();
        let (points, _) = read.points(224, 224);
        assert!(points.len() > 10, "{}", space.name);
    }
}
