// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reports as text, JSON and JUnit XML.

use foveate_cosim::{CosimReport, FORMAT_VERSION, Level, Mismatch, Seconds, Simulator, junit_xml};

fn report(mismatch: Option<Mismatch>) -> CosimReport {
    CosimReport {
        format_version: FORMAT_VERSION,
        name: "rcm 3x1 verilator".to_owned(),
        design: "0123456789abcdef".to_owned(),
        level: Level::Rcm { columns: 3, rows: 1 },
        grid: (3, 1),
        simulator: Simulator::Verilator,
        simulator_version: "Verilator 5.006".to_owned(),
        rtl_sha256: "00".to_owned(),
        netlist: None,
        seed: 7,
        sequences: 16,
        frames: 69,
        clocks: 7800,
        comparisons: 171_600,
        replay: mismatch.is_some().then(|| "replay".into()),
        mismatch,
        waves: None,
        seconds: Seconds { vectors: 0.5, build: 3.0, run: 0.25 },
    }
}

fn mismatch() -> Mismatch {
    Mismatch {
        sequence: "reset in a frame".to_owned(),
        frame: 2,
        clock: 1417,
        clock_in_frame: 13,
        region: Some(1),
        port: "trs_o".to_owned(),
        expected: "1".to_owned(),
        got: "x".to_owned(),
    }
}

#[test]
fn a_mismatch_names_everything() {
    assert_eq!(
        mismatch().to_string(),
        "sequence \"reset in a frame\", frame 2, clock 13 of it (1417 of the run), region 1: \
         trs_o is 'hx, expected 'h1"
    );
    assert_eq!(
        report(None).to_string(),
        "rcm 3x1 verilator: 69 frames, 7800 clocks, 171600 values compared, no mismatch"
    );
}

#[test]
fn json_comes_back_and_has_its_version() {
    for mismatch in [None, Some(mismatch())] {
        let report = report(mismatch);
        let json = serde_json::to_string(&report).unwrap();
        assert!(json.starts_with("{\"format_version\":1,"), "{json}");
        assert_eq!(serde_json::from_str::<CosimReport>(&json).unwrap(), report);
    }
}

#[test]
fn junit_has_a_case_per_report() {
    let xml = junit_xml(&[report(None), report(Some(mismatch()))]);
    for part in [
        "tests=\"2\" skipped=\"0\" failures=\"1\" errors=\"0\"",
        "classname=\"foveate.0123456789abcdef\" time=\"3.750\"",
        "type=\"mismatch\"",
        "trs_o is &apos;hx, expected &apos;h1",
        "replay it with replay/replay.sh",
    ] {
        assert!(xml.contains(part), "{part}\n{xml}");
    }
}

#[test]
fn nothing_compared_is_no_pass() {
    let nothing = CosimReport { comparisons: 0, ..report(None) };
    assert!(report(None).passed() && !nothing.passed());
    assert_eq!(nothing.to_string(), "rcm 3x1 verilator: nothing was compared");
}
