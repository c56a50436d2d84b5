// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files emitted for a design: they are always the same, have the ports of the specification,
//! and include only the modules that the design needs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::common::{design, every_design, pipelined_matrix, raster_matrix, serial_matrix};
use foveate_design::{Design, Organization, PortDirection, RasterTiming, SerialTiming};
use foveate_emit::{BOARD_LEAVES, LEAVES, Leaf, Prefix, SourceFile, Top, verilog};

fn core(design: &Design) -> Vec<SourceFile> {
    foveate_emit::core_files(design, &Prefix::default())
}

/// The block RAM of the ECP5, which `raster_memory` instantiates by name.
const CELL: &str = "DP16KD";

fn contents<'a>(files: &'a [SourceFile], path: &str) -> &'a str {
    &files.iter().find(|file| file.path == path).unwrap().contents
}

/// Returns the names of the modules that a file instantiates, as `name #(` or `name u_...`. Missing
/// modules that refuse a parameter and cells of a device family are left out.
fn instantiated(text: &str) -> BTreeSet<&str> {
    let first_words = text.lines().map(str::trim_start).filter_map(|line| {
        let (name, rest) = line.split_once(' ')?;
        (rest.starts_with("#(") || rest.starts_with("u_")).then_some(name)
    });
    first_words
        .filter(|name| {
            *name != "module" && *name != ")" && *name != CELL && !name.contains("_must_")
        })
        .collect()
}

#[test]
fn every_leaf_of_the_folders_is_embedded() {
    for (folder, leaves) in [("rtl", LEAVES), ("rtl/board", BOARD_LEAVES)] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
        let in_folder: BTreeSet<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter_map(|name| name.strip_suffix(".v").map(str::to_owned))
            .collect();
        let embedded: BTreeSet<String> = leaves.iter().map(|leaf| leaf.name.to_owned()).collect();
        assert_eq!(in_folder, embedded);
    }
}

#[test]
fn every_leaf_says_what_it_uses_and_stands_after_it() {
    let all: Vec<&Leaf> = LEAVES.iter().chain(BOARD_LEAVES).collect();
    for (index, leaf) in all.iter().enumerate() {
        assert!(leaf.contents.contains(&format!("\nmodule {} ", leaf.name)), "{}", leaf.name);
        let uses: BTreeSet<&str> = leaf.uses.iter().copied().collect();
        assert_eq!(instantiated(leaf.contents), uses, "{}", leaf.name);
        for used in uses {
            assert!(all[..index].iter().any(|earlier| earlier.name == used), "{used}");
        }
    }
}

/// A core has each of its leaves as it stands in `rtl/`, and all leaves that those instantiate.
#[test]
fn leaves_are_shipped_whole_and_as_they_are() {
    let leaf_of = |file: &SourceFile| LEAVES.iter().find(|leaf| file.path == file_of(leaf.name));
    for toml in every_design() {
        let files = verilog(&design(&toml), Top::Rcm);
        for (file, leaf) in files.iter().filter_map(|file| Some((file, leaf_of(file)?))) {
            assert_eq!(file.contents, leaf.contents, "{}: {toml}", leaf.name);
            for used in leaf.uses {
                assert!(files.iter().any(|file| file.path == file_of(used)), "{used}: {toml}");
            }
        }
    }
}

fn file_of(module: &str) -> String {
    format!("rtl/{module}.v")
}

#[test]
fn emission_is_deterministic() {
    for toml in [pipelined_matrix(), serial_matrix(), raster_matrix()].concat() {
        assert_eq!(core(&design(&toml)), core(&design(&toml)), "{toml}");
    }
}

#[test]
fn every_feature_is_in_the_matrices() {
    let matrices = [
        (Organization::Pipelined, pipelined_matrix()),
        (Organization::Serial, serial_matrix()),
        (Organization::Raster, raster_matrix()),
    ];
    for (name, designs) in matrices {
        for kind in name.feature_kinds() {
            let has = |text: &String| design(text).feature(kind).is_some();
            assert!(designs.iter().any(has), "no {name} design has {kind}; see tests/emit/common");
        }
    }
}

#[test]
fn module_headers_are_the_port_lists() {
    for toml in pipelined_matrix() {
        let design = design(&toml);
        let files = verilog(&design, Top::Rcm);
        for &top in Top::all_of(&design) {
            let header = contents(&files, &format!("rtl/{}.v", top.module()));
            let header = header.split_once("\nmodule ").unwrap().1.split_once("\n);").unwrap().0;
            for port in top.ports(&design) {
                let direction = match port.direction {
                    PortDirection::Input => "input",
                    PortDirection::Output => "output",
                };
                let line = header
                    .lines()
                    .filter_map(|line| line.split("//").next())
                    .find(|line| line.contains(&format!(" {}", port.name)))
                    .unwrap_or_else(|| panic!("{} is missing: {toml}", port.name));
                assert!(line.trim_start().starts_with(direction), "{line}");
                let range = match (port.per_lane, port.width) {
                    (true, 1) => "[COLUMNS*ROWS-1:0]".to_owned(),
                    (true, width) => format!("[COLUMNS*ROWS*{width}-1:0]"),
                    (false, width) => format!("[{}:0]", width - 1),
                };
                assert_eq!(line.contains(&range), port.per_lane || port.width > 1, "{line}");
            }
        }
    }
}

#[test]
fn headers_of_other_organizations_are_the_port_lists() {
    for toml in [serial_matrix(), raster_matrix()].concat() {
        let design = design(&toml);
        for &top in Top::all_of(&design) {
            let files = verilog(&design, top);
            let text = contents(&files, &format!("rtl/{}.v", top.module()));
            let header = text.split_once("\nmodule ").unwrap().1.split_once("\n);").unwrap().0;
            let names: Vec<&str> = header
                .lines()
                .filter(|line| line.contains(" wire "))
                .map(|line| line.split("//").next().unwrap().trim().trim_end_matches(','))
                .map(|line| line.rsplit(' ').next().unwrap())
                .collect();
            let ports = top.ports(&design);
            let expected: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
            assert_eq!(names, expected, "{toml}");
        }
    }
}

#[test]
fn a_serial_core_has_its_array_and_its_lone_lane() {
    let design = design("[hardware]\norganization = 'serial'\nfold = 4\n");
    let files = core(&design);
    let rpu = contents(&files, "rtl/rpu.v");
    assert!(rpu.contains("parameter COLUMNS = 4,") && rpu.contains("parameter ROWS = 1 "), "{rpu}");
    let listed = |list: &str, path: &str| contents(&files, list).lines().any(|line| line == path);
    assert!(listed("rpu.f", "rtl/rpu.v") && !listed("rpu.f", "rtl/rcm.v"));
    assert!(listed("rcm.f", "rtl/rcm.v") && !listed("rcm.f", "rtl/rpu.v"));
    assert!(contents(&files, "README.md").contains("196 serial lanes"));
    assert!(contents(&files, "foveate_rcm.core").contains("toplevel: rcm_replay"));
}

/// The README states the order of regions and the wait of a stream in the numbers of the design.
#[test]
fn the_readme_of_a_folded_core_says_where_regions_are_and_how_long_a_stream_waits() {
    let hardware = "[hardware]\norganization = 'serial'\nfold = 5\n";
    for (feed, words) in [("raster", "forward_region_o"), ("parallel", "`forward_slot_o`")] {
        let design = design(&format!("{hardware}feed = '{feed}'\n"));
        let files = core(&design);
        let readme = contents(&files, "README.md");
        let stall = SerialTiming::from_design(design.as_serial().unwrap()).edges_to_ready();
        for part in [
            "**region = lane * 5 + slot**, lane = 0..156, slot = 0..4",
            "The last 1 slots of lane 156 are empty",
            &format!("`ready_o` is 0 for **{stall} clocks**"),
            words,
        ] {
            assert!(readme.contains(part), "{part}: {readme}");
        }
        assert_eq!(design.as_serial().unwrap().region_in_slot(156, 3), Some(783));
        assert_eq!(design.as_serial().unwrap().region_in_slot(156, 4), None);
    }
}

#[test]
fn a_raster_core_has_one_top() {
    let files = core(&design("[hardware]\norganization = 'raster'\n"));
    assert!(contents(&files, "rcm.f").lines().any(|line| line == "rtl/rcm.v"));
    for file in &files {
        // No file belongs to a module `rpu`, and no text mentions one.
        assert!(!file.path.contains("rpu"), "{}", file.path);
        let is_own = |line: &str| line.split(|c: char| !c.is_alphanumeric()).any(|w| w == "rpu");
        let named = file.contents.lines().find(|line| is_own(line));
        assert_eq!(named, None, "{}", file.path);
    }
}

/// The README states for how long a stream waits, when a region is lost, and what the memories
/// hold. A frame of 50x20 pixels in words of two pixels has 7x3 regions, rows of 28 words, of which
/// 25 are taken, and two windows.
#[test]
fn the_readme_of_a_raster_core_says_how_long_a_source_waits_and_a_sink_may_stall() {
    let frame = "frame = { width = 50, height = 20 }\n[hardware]\norganization = 'raster'\n";
    let design = design(&format!("{frame}pixels_per_clock = 2\n"));
    let readme = core(&design).pop().unwrap();
    assert_eq!(readme.path, "README.md");
    let readme = readme.contents;
    // The clocks are 3 words of the last row, 4 rows, 2 * 29 for the windows, and 11 to the
    // decision.
    let stall = 3 + 4 * 28 + 2 * 29 + 11;
    assert_eq!(RasterTiming::from_design(design.as_raster().unwrap()).edges_to_ready(), stall);
    for part in [
        &format!("`ready_o` is 0 for **{stall} clocks**"),
        "7 blank rows of 28 clocks are enough",
        "except for **3 clocks** after the last word of every row",
        "**region = row * 7 + column**",
        "comes 69 clocks after the last word of the region",
        "from 5 clocks after its decision on",
        "stalls for at most **17 clocks** in all",
        "the number of the region's frame since reset, modulo 256",
        "has `forward_last_o` = 1 and `forward_abort_o` = 1",
        "its words up to `forward_position_o` = 62 never come",
        "with its number and that of its frame on `lost_region_o` and `lost_frame_o`",
        "Pixels beyond the frame leave, too",
        "| references: the frame store | 672 | 16 | 10752 |",
        "| two rows of pixels, for the filter | 28 | 32 | 896 |",
        "| `edge_level_i` | 100 |",
        "    .edge_level_i(11'd100),",
        "until `ready_o` is 1 again after its last word.",
        "sh tb/replay.sh",
    ] {
        assert!(readme.contains(part), "{part}: {readme}");
    }
}

/// Small frames with the reference `last-sent` wait for the sink, so nothing is lost.
#[test]
fn the_readme_of_a_raster_core_that_waits_for_its_sink_says_so() {
    let toml = "frame = { width = 64, height = 16 }\ntemporal.reference = 'last-sent'\n\
                spatial = [{ feature = 'edge' }]\nhardware.organization = 'raster'\n";
    let readme = core(&design(toml)).pop().unwrap().contents;
    for (part, is_there) in [
        ("a source waits for the sink", true),
        ("So no region is ever lost", true),
        ("`forward_abort_o`, `lost_o`, `lost_count_o` and `lost_valid_o` stay 0", true),
        ("**lost**", false),
        ("Pixels beyond the frame", false),
        ("except for", false),
        ("which regions have a reference, by losses | 16 | 1 | 16 |", true),
    ] {
        assert_eq!(readme.contains(part), is_there, "{part}: {readme}");
    }
}

#[test]
fn the_array_is_a_loop() {
    let rcm = verilog(&design(""), Top::Rcm).pop().unwrap();
    assert_eq!(rcm.path, "rtl/rcm.v");
    assert_eq!(rcm.contents.matches("rpu u_rpu").count(), 1);
    assert!(rcm.contents.lines().count() < 100);
}

#[test]
fn the_banner_names_the_design_and_nothing_that_changes() {
    let design = design("");
    for file in core(&design) {
        let generated = file.contents.contains("Generated by Foveate");
        assert!(!generated || file.contents.contains(&design.fingerprint()), "{}", file.path);
        assert!(!file.contents.contains("{=") && !file.contents.contains("=}"), "{}", file.path);
        assert!(file.contents.ends_with('\n') && !file.contents.contains('\r'), "{}", file.path);
    }
}

#[test]
fn file_lists_name_every_file_once_in_order() {
    let files = core(&design(""));
    let expected: Vec<&str> =
        files.iter().map(|f| f.path.as_str()).filter(|path| path.starts_with("rtl/")).collect();
    let listed: Vec<&str> = contents(&files, "rcm.f").lines().collect();
    assert_eq!(listed, expected);
    let fusesoc = contents(&files, "foveate_rcm.core");
    assert!(expected.iter().all(|path| fusesoc.contains(&format!("- {path}\n"))));
}

/// The README tells a user what a lost pixel does to the core, and how to mark a frame where the
/// core has a port for it.
#[test]
fn the_readme_of_every_core_says_where_frames_start() {
    for (organization, beats) in [
        ("organization = 'pipelined'", "64 pixels of every region"),
        ("organization = 'serial'\nfold = 2", "128 pixels of every lane"),
        ("organization = 'serial'\nfeed = 'raster'", "50176 pixels."),
        ("organization = 'raster'\npixels_per_clock = 2", "25088 words."),
    ] {
        let readme = |more: &str| {
            let design = design(&format!("[hardware]\n{organization}\n{more}\n"));
            core(&design).pop().unwrap().contents
        };
        let (with, without) = (readme("sync = true"), readme(""));
        assert!(with.contains(beats) && without.contains(beats), "{beats}: {with}");
        for part in [
            "## Where a frame starts",
            "| `sof_i` | pixels | in | 1 |",
            ".sof_i(sof),",
            "`sync_error_o` is 1",
        ] {
            assert!(with.contains(part), "{part}: {with}");
        }
        assert!(without.contains("out of step until reset") && !without.contains("sof_i"));
        assert!(!with.contains("out of step until reset"));
        let has_ready = with.contains("| `ready_o` |");
        assert_eq!(with.contains("`ready_o` is 0 meanwhile"), has_ready, "{organization}");
    }
}
