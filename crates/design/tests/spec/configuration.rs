// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of configuration files: the accepted values, the designs that they make, and the messages
//! of refusals.

use foveate_camera::ConfigError;
use foveate_design::{Design, DesignConfig, PRESETS, PipelinedTiming, Preset};

fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

fn refusal(toml: &str) -> String {
    DesignConfig::from_toml(toml).and_then(|config| config.validate()).unwrap_err().to_string()
}

#[test]
fn the_default_is_the_paper() {
    let paper = design("");
    assert_eq!((paper.columns(), paper.rows(), paper.regions()), (28, 28, 784));
    assert_eq!((paper.region_pixels(), paper.stream_pixels(), paper.pixel_max()), (64, 64, 255));
    assert_eq!((paper.count_bits(), paper.position_bits()), (7, 6));
    assert_eq!(paper.timing().clocks_per_frame(), 64);
    assert_eq!(PipelinedTiming::from_design(paper.as_pipelined().unwrap()).decision_latency, 20);
}

#[test]
fn every_preset_is_a_design_and_survives_writing() {
    for preset in PRESETS {
        let config = preset.config().unwrap();
        let design = config.validate().unwrap();
        let again = DesignConfig::from_toml(&design.config().to_toml()).unwrap();
        assert_eq!(again, design.config(), "{}", preset.name);
        assert_eq!(again.validate().unwrap().fingerprint(), design.fingerprint());
    }
    assert!(matches!(Preset::find("papre"), Err(ConfigError::UnknownPreset { .. })));
}

#[test]
fn fingerprints_tell_designs_apart() {
    let paper = design("").fingerprint();
    assert_eq!(paper, design("[frame]\nwidth = 224\n").fingerprint());
    assert_ne!(paper, design("[temporal]\nlevel = 9\n").fingerprint());
    assert_eq!(paper.len(), 16);
    let serial = |keys: &str| design(&format!("[hardware]\norganization = \"serial\"\n{keys}"));
    assert_eq!(serial("").fingerprint(), serial("feed = \"parallel\"\n").fingerprint());
    let keys = ["", "fold = 2\n", "feed = \"raster\"\n", "memory = \"block\"\n"];
    let names = keys.map(|keys| serial(keys).fingerprint());
    assert!(names[0] != paper && names[1..].iter().all(|name| *name != names[0]));
}

/// The expected numbers are computed by hand from `docs/timing.md`: N + 1 = 9 clocks for each
/// window of an isolated region, the registers of the median, and the tail delay.
#[test]
fn deep_pipelining_adds_registers_and_takes_none_of_the_clocks_of_a_frame() {
    let latencies = |keys: &str| {
        let of = |pipelining: &str| {
            let design = design(&format!("{keys}[hardware]\npipelining = \"{pipelining}\"\n"));
            let timing = PipelinedTiming::from_design(design.as_pipelined().unwrap());
            assert_eq!((timing.cycles_per_frame, timing.decision_frames), (64, 0), "{keys}");
            timing.decision_latency
        };
        (of("plain"), of("deep"))
    };
    assert_eq!(latencies(""), (9 + 2 + 9, 9 + 3 + 9 + 2));
    assert_eq!(latencies("[denoise]\nfilter = \"none\"\n"), (9, 9 + 2));
    assert_eq!(latencies("[[spatial]]\nfeature = \"variance\"\n"), (9 + 2 + 1, 9 + 3 + 2));
    let no_window = "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"variance\"\n";
    assert_eq!(latencies(no_window), (1, 2));
    let shared = |pipelining: &str| {
        let keys = "[region]\nneighborhood = \"shared\"\n[[spatial]]\nfeature = \"edge\"\n\
                    [[spatial]]\nfeature = \"mad\"\n";
        let keys = format!("{keys}[hardware]\npipelining = \"{pipelining}\"\n");
        let timing = PipelinedTiming::from_design(design(&keys).as_pipelined().unwrap());
        (timing.cycles_per_frame, timing.decision_latency, timing.decision_frames)
    };
    assert_eq!((shared("plain"), shared("deep")), ((144, 2 + 1, 1), (144, 3 + 2, 1)));
}

#[test]
fn plain_pipelining_is_the_default() {
    let pipelining = |value: &str| format!("[hardware]\npipelining = \"{value}\"\n");
    let paper = design("").fingerprint();
    assert_eq!(design(&pipelining("plain")).fingerprint(), paper);
    let deep = design(&pipelining("deep"));
    assert_ne!(deep.fingerprint(), paper);
    assert_eq!(deep.config().hardware.description(), "pipelined, deep pipelining");
    let serial = |keys: &str| design(&format!("{keys}organization = \"serial\"\n"));
    let plain = serial("[hardware]\n");
    assert_eq!(serial(&pipelining("plain")).fingerprint(), plain.fingerprint());
    let deep = serial(&pipelining("deep"));
    assert_ne!(deep.fingerprint(), plain.fingerprint());
    assert!(deep.config().hardware.description().contains("deep pipelining"));
}

#[test]
fn frames_that_are_no_multiple_are_padded() {
    let ragged = design("[frame]\nwidth = 17\nheight = 3\n");
    assert_eq!((ragged.columns(), ragged.rows()), (3, 1));
}

#[test]
fn the_halo_follows_the_windows() {
    let halo = |filter: &str, feature: &str| {
        design(&format!(
            "[region]\nneighborhood = \"shared\"\n[denoise]\nfilter = \"{filter}\"\n[[spatial]]\nfeature = \"{feature}\"\n"
        ))
        .halo()
    };
    assert_eq!(halo("median3x3", "edge"), 2);
    assert_eq!(halo("median3x3", "mad"), 1);
    assert_eq!(halo("none", "corner"), 1);
    assert_eq!(halo("none", "variance"), 0);
    assert_eq!(design("").halo(), 0);
}

#[test]
fn decimal_thresholds_are_rounded_up_to_score_units() {
    let mad = design("[[spatial]]\nfeature = \"mad\"\nmin_score = 2.51\nmean_fraction_bits = 1\n");
    assert_eq!(mad.features()[0].min_score(), 322); // 2.51 * 128 = 321.28
    let variance = design("[[spatial]]\nfeature = \"variance\"\nmin_score = 0.1\n");
    assert_eq!(variance.features()[0].min_score(), 410); // 0.1 * 4096 = 409.6
}

#[test]
fn unknown_keys_name_the_nearest() {
    for (toml, key, nearest) in [
        ("[region]\nsiez = 8\n", "region.siez", "region.size"),
        ("[temporal]\nmin_conut = 8\n", "temporal.min_conut", "temporal.min_count"),
        ("[[spatial]]\nfeature = \"edge\"\nlevle = 1\n", "spatial[0].levle", "spatial.level"),
        ("[frames]\nwidth = 8\n", "frames", "frame"),
        ("[hardware]\nfede = \"raster\"\n", "hardware.fede", "hardware.feed"),
        ("[frame]\npayload = \"raw\"\n", "frame.payload", "render.payload"),
    ] {
        let expected = format!("unknown key `{key}`; did you mean `{nearest}`?");
        assert_eq!(refusal(toml), expected);
    }
}

#[test]
fn wrong_types_name_the_key() {
    for (toml, message) in [
        (
            "[region]\nsize = \"big\"\n",
            "`region.size`: \"big\" is not valid; it takes a whole number, 2..=64",
        ),
        (
            "[region]\nsize = 8.0\n",
            "`region.size`: 8.0 is not valid; it takes a whole number, 2..=64",
        ),
        (
            "[[spatial]]\nfeature = \"edges\"\n",
            "`spatial[0].feature`: \"edges\" is not valid; it takes \"edge\", \"corner\", \"mad\", \"variance\", \"range\", \"surface\", \"segment\" or \"flow\"",
        ),
        ("[[spatial]]\nlevel = 3\n", "`spatial[0]`: it lacks `feature`"),
        ("region = 8\n", "`region`: 8 is not valid; it takes a table"),
        ("spatial = \"edge\"\n", "`spatial`: \"edge\" is not valid; it takes an array of tables"),
    ] {
        assert_eq!(refusal(toml), message);
    }
    assert!(refusal("[region\nsize = 8").contains("line 1"));
    assert!(refusal("[[spatial]]\nfeature = \"mad\"\nmin_score = -1\n").contains("min_score"));
}

#[test]
fn ranges_name_key_value_and_range() {
    for (toml, message) in [
        ("[region]\nsize = 65\n", "`region.size` = 65 is out of range; the valid range is 2..=64"),
        (
            "[frame]\npixel_bits = 17\n",
            "`frame.pixel_bits` = 17 is out of range; the valid range is 1..=16",
        ),
        ("[frame]\nwidth = 0\n", "`frame.width` = 0 is out of range; the valid range is 1..=16384"),
        (
            "[hardware]\norganization = \"serial\"\nfold = 785\n",
            "`hardware.fold` = 785 is out of range; the valid range is 1..=784 (the frame has 784 regions); fold = 784 makes one lane",
        ),
        (
            "[temporal]\nmin_count = 65\n",
            "`temporal.min_count` = 65 is out of range; the valid range is 0..=64 for regions of 64 pixels",
        ),
        (
            "[[spatial]]\nfeature = \"edge\"\nlevel = 1531\n",
            "`spatial[0].level` = 1531 is out of range; the valid range is 0..=1529 (pixels of 8 bits reach 1530) for `edge`",
        ),
        (
            "[[spatial]]\nfeature = \"mad\"\nmin_score = 127.6\n",
            "`spatial[0].min_score` = 127.6 is out of range; the valid range is 0..=127.5 for `mad`",
        ),
    ] {
        assert_eq!(refusal(toml), message);
    }
}

#[test]
fn impossible_combinations_say_what_to_do() {
    for (toml, part) in [
        ("[[spatial]]\nfeature = \"mad\"\nlevel = 3\n", "leave the key out"),
        ("[[spatial]]\nfeature = \"edge\"\nmean_fraction_bits = 3\n", "leave the key out"),
        (
            "[[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"edge\"\n",
            "list each feature once",
        ),
        (
            "[[spatial]]\nfeature = \"segment\"\nmean_fraction_bits = 2\n\
             [[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 3\n",
            "`spatial[1].mean_fraction_bits` = 3 cannot be combined with `spatial[0].mean_fraction_bits` = 2 of `segment`; all features of a camera use one mean; give both keys the same value",
        ),
        // A key that is left out is 0.
        (
            "[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 3\n\
             [[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"segment\"\n",
            "`spatial[2].mean_fraction_bits` = 0 cannot be combined with `spatial[0].mean_fraction_bits` = 3 of `mad`",
        ),
        ("[hardware]\nfeed = \"raster\"\n", "leave the key out"),
        (
            "[hardware]\norganization = \"serial\"\n[region]\nsize = 3\n",
            "`region.size` = 3 cannot be combined with organization = \"serial\"; use 4..=64",
        ),
        ("[hardware]\nfold = 2\n", "use 1"),
        (
            "[hardware]\nmemory = \"block\"\n",
            "`hardware.memory` = \"block\" cannot be combined with organization = \"pipelined\"; only the serial",
        ),
        (
            "[hardware]\norganization = \"serial\"\nmemory = \"flash\"\n",
            "it takes \"distributed\" or \"block\"",
        ),
        ("spatial = []\n", "1..=8 features"),
        ("[frame]\nwidth = 16384\nheight = 16384\n[region]\nsize = 2\n", "67108864 regions"),
    ] {
        assert!(refusal(toml).contains(part), "{}", refusal(toml));
    }
}

#[test]
fn overrides_reach_every_key() {
    let with = |overrides: &[&str]| DesignConfig::from_toml_with("", overrides);
    let config = with(&["region.size=16", "temporal.reference=last-sent", "spatial.0.level=50"]);
    let design = config.unwrap().validate().unwrap();
    assert_eq!((design.region_size(), design.features()[0].level()), (16, Some(50)));
    let two = with(&["spatial=[{feature=\"mad\"},{feature=\"corner\"}]"]).unwrap();
    assert_eq!(two.camera.spatial.len(), 2);
    for wrong in [
        "region.size=16\ntemporal=3",
        "region.size",
        "=3",
        "spatial.1.level=3",
        "region.size.deep=1",
        "region..size=1",
    ] {
        assert!(with(&[wrong]).is_err(), "{wrong}");
    }
}

/// A preset or a file with means can be shown without means by one override.
#[test]
fn an_override_that_shows_no_means_removes_the_periphery_of_the_text() {
    let text = "[render]\nirrelevant = \"mean\"\n[periphery]\nblocks = 4\nlevel = 3\n";
    let with = |text: &str, overrides: &[&str]| {
        let config = DesignConfig::from_toml_with(text, overrides).unwrap();
        config.validate().map(|design| design.config())
    };
    for shown in ["hold", "zero"] {
        let shown = format!("render.irrelevant={shown}");
        let others = ["frame.pixel_bits=10", "temporal.level=7"];
        for more in [&others[..0], &others[..1], &others] {
            let overrides = [&[shown.as_str()], more].concat();
            assert_eq!(with(text, &overrides).unwrap(), with("", &overrides).unwrap());
        }
        // The periphery of an override stays, and is an error.
        let refused = with(text, &[&shown, "periphery.level=2"]).unwrap_err().to_string();
        assert!(refused.contains("`periphery.level` = 2 cannot be combined"), "{refused}");
    }
    // So do the levels that zones have for means; their other keys stay.
    let zones =
        "[zones]\noff_level = 9\nkeen = { temporal = { level = 3 }, periphery = { level = 2 } }\n";
    assert_eq!(
        with(&format!("{text}{zones}"), &["render.irrelevant=hold"]).unwrap(),
        with("", &["render.irrelevant=hold", "zones.keen.temporal.level=3"]).unwrap()
    );
    let whole_table = with(text, &["render={irrelevant='hold'}"]).unwrap();
    assert_eq!(whole_table, with("", &["render.irrelevant=hold"]).unwrap());
    let misspelt = text.replace("level", "levle");
    let refused = DesignConfig::from_toml_with(&misspelt, &["render.irrelevant=hold"]).unwrap_err();
    assert!(refused.to_string().contains("periphery.levle"), "{refused}");
    let kept = with(text, &["render.irrelevant=mean", "temporal.level=7"]).unwrap();
    assert_eq!(kept.camera.periphery.blocks, Some(4));
    // A file is checked as it stands.
    let wrong = text.replace("mean", "hold");
    assert!(with(&wrong, &["temporal.level=7"]).is_err());
}

#[test]
fn an_input_gives_its_size_unless_the_file_names_another() {
    let mut open = DesignConfig::default();
    open.camera.fit_frame(640, 480).unwrap();
    assert_eq!(open.validate().unwrap().width(), 640);
    let error = open.camera.fit_frame(320, 480).unwrap_err().to_string();
    assert!(error.contains("frame.width") && error.contains("640") && error.contains("320x480"));
}

#[test]
fn ports_of_the_rcm_are_those_of_the_rpu_times_its_regions() {
    let paper = design("");
    let (rpu, rcm) = (paper.rpu_ports(), paper.rcm_ports());
    assert_eq!(rpu.len(), rcm.len());
    let pixel = rcm.iter().find(|port| port.name == "pixel_i").unwrap();
    assert_eq!((pixel.width, pixel.lanes, pixel.bits()), (8, 784, 6272));
    let constant = design("[hardware]\nthresholds = \"constant\"\n");
    assert!(constant.rpu_ports().iter().all(|port| !port.name.ends_with("level_i")));
    let shared = design("[region]\nneighborhood = \"shared\"\n");
    assert!(shared.rpu_ports().iter().any(|port| port.name == "border_i"));
    assert!(shared.rcm_ports().iter().all(|port| port.name != "border_i"));
}
