// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reports as text, JSON and JUnit XML.

use foveate_cosim::{
    CosimLevel, CosimReport, CosimSummary, CosimVerdict, Mismatch, Occurrences, PortMismatch,
    Simulator, StepSeconds, UnelaboratedVariant, UnreachedVerilog, UnsimulatedModules, junit_xml,
};

fn report(mismatch: Option<Mismatch>) -> CosimReport {
    CosimReport {
        name: "rcm 3x1 verilator".to_owned(),
        design: "0123456789abcdef".to_owned(),
        level: CosimLevel::Rcm { columns: 3, rows: 1 },
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
        situations: Occurrences::default(),
        replay: mismatch.is_some().then(|| "replay".into()),
        mismatch,
        waves: None,
        seconds: StepSeconds { vectors: 0.5, build: 3.0, run: 0.25 },
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
        score: None,
        activity: "pixel 12 of 64 (x 4, y 1) of frame 2 enters".to_owned(),
        expected: "1".to_owned(),
        actual: "x".to_owned(),
        ports: vec![PortMismatch {
            port: "score_o".to_owned(),
            clock: 1420,
            region: Some(1),
            score: Some("edge".to_owned()),
            activity: "frame 1, slot 0, phase \"rotate edge\", step 3 of 4".to_owned(),
            expected: "0f".to_owned(),
            actual: "1f".to_owned(),
        }],
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
        mismatch().ports[0].to_string(),
        "clock 1420: score_o (edge), region 1, is 'h1f, expected 'h0f; frame 1, slot 0, \
         phase \"rotate edge\", step 3 of 4"
    );
    assert_eq!(
        report(None).to_string(),
        "rcm 3x1 verilator: 69 frames, 7800 clocks, 171600 values compared, no mismatch"
    );
}

/// Returns a summary of these runs; with `spare`, a file was reached by none of them.
fn summary_of_runs(runs: Vec<CosimReport>, spare: bool, whole: bool) -> CosimSummary {
    let (file, modules) = ("rtl/spare.v".to_owned(), vec!["spare".to_owned()]);
    let modules = if spare { vec![UnsimulatedModules { file, modules }] } else { Vec::new() };
    summary_with_unreached(runs, UnreachedVerilog { modules, variants: Vec::new() }, whole)
}

fn summary_with_unreached(
    runs: Vec<CosimReport>,
    left: UnreachedVerilog,
    whole: bool,
) -> CosimSummary {
    CosimSummary::new("0123456789abcdef".to_owned(), runs, Vec::new(), left, whole)
}

/// A parameter value that no run has elaborated is not a pass, in words, JSON and JUnit.
#[test]
fn a_parameter_value_that_was_not_elaborated_is_no_pass() {
    let left = || {
        let (module, parameters) = ("store".to_owned(), vec!["WORDS = 4b000".to_owned()]);
        let variants = vec![UnelaboratedVariant { module, is_module_known: true, parameters }];
        UnreachedVerilog { modules: Vec::new(), variants }
    };
    let whole = summary_with_unreached(vec![report(None)], left(), true);
    assert_eq!(whole.verdict(), CosimVerdict::Incomplete);
    assert_eq!(whole.describe_unreached(), "store with WORDS = 4b000");
    let json = serde_json::to_value(&whole).unwrap();
    assert_eq!(json["not_elaborated"][0]["parameters"][0], "WORDS = 4b000");
    let xml = junit_xml(&whole);
    assert!(xml.contains("failures=\"1\"") && xml.contains("store with WORDS = 4b000"), "{xml}");
    assert_eq!(
        summary_with_unreached(vec![report(None)], left(), false).verdict(),
        CosimVerdict::Passed
    );
}

#[test]
fn json_round_trips_and_has_its_version() {
    for mismatch in [None, Some(mismatch())] {
        let summary = summary_of_runs(vec![report(mismatch)], true, true);
        let json = serde_json::to_string(&summary).unwrap();
        assert!(json.starts_with("{\"format_version\":2,\"passed\":false,"), "{json}");
        assert_eq!(serde_json::from_str::<CosimSummary>(&json).unwrap(), summary);
    }
}

#[test]
fn junit_has_a_case_per_run_and_one_for_unreached_modules() {
    let runs = vec![report(None), report(Some(mismatch()))];
    let xml = junit_xml(&CosimSummary {
        not_run: vec!["full verilator".to_owned()],
        ..summary_of_runs(runs.clone(), true, true)
    });
    for part in [
        "tests=\"4\" skipped=\"1\" failures=\"2\" errors=\"0\"",
        "classname=\"foveate.0123456789abcdef\" time=\"3.750\"",
        "type=\"mismatch\"",
        "trs_o is &apos;hx, expected &apos;h1",
        "clock 1420: score_o (edge)",
        "replay it with replay/replay.sh",
        "message=\"rtl/spare.v (module spare)\" type=\"not simulated\"",
    ] {
        assert!(xml.contains(part), "{part}\n{xml}");
    }
    let xml = junit_xml(&summary_of_runs(vec![report(None)], true, false));
    assert!(xml.contains("tests=\"2\" skipped=\"1\" failures=\"0\""), "{xml}");
    let nothing = CosimReport { comparisons: 0, ..report(None) };
    let xml = junit_xml(&summary_of_runs(vec![nothing], false, false));
    assert!(xml.contains("failures=\"1\"") && xml.contains("nothing was compared"), "{xml}");
}

#[test]
fn a_pass_needs_every_run_and_if_required_all_of_the_verilog() {
    let verdict = |runs, spare, whole| {
        let summary = summary_of_runs(runs, spare, whole);
        assert_eq!(summary.passed, summary.verdict() == CosimVerdict::Passed);
        summary.verdict()
    };
    assert_eq!(verdict(vec![report(None)], false, true), CosimVerdict::Passed);
    assert_eq!(verdict(vec![report(None)], true, false), CosimVerdict::Passed);
    assert_eq!(verdict(vec![report(None)], true, true), CosimVerdict::Incomplete);
    let second = vec![report(None), report(Some(mismatch()))];
    assert_eq!(verdict(second, true, true), CosimVerdict::Mismatch);
    assert_eq!(verdict(Vec::new(), false, false), CosimVerdict::Mismatch);
}

#[test]
fn nothing_compared_is_no_pass() {
    let nothing = CosimReport { comparisons: 0, ..report(None) };
    assert!(report(None).passed() && !nothing.passed());
    assert_eq!(nothing.to_string(), "rcm 3x1 verilator: nothing was compared");
}

#[test]
fn a_situation_that_did_not_occur_is_no_pass() {
    let counted = |count| {
        let json = format!("[{{\"situation\":\"a mean waits for the sink\",\"count\":{count}}}]");
        let situations: Occurrences = serde_json::from_str(&json).unwrap();
        CosimReport { situations, ..report(None) }
    };
    let verdict = |runs| {
        CosimSummary::new("design".to_owned(), runs, Vec::new(), UnreachedVerilog::default(), false)
            .verdict()
    };
    assert_eq!(verdict(vec![counted(0)]), CosimVerdict::Incomplete);
    assert_eq!(verdict(vec![counted(3)]), CosimVerdict::Passed);
    // One run may reach a situation that another cannot.
    assert_eq!(verdict(vec![counted(0), counted(1)]), CosimVerdict::Passed);
}
