// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of layers and frames, summed over frames or over layers, gives the two other tables,
//! and they give the totals.

use crate::common::{RunSetup, TableRow, is_counted, is_near, number, rows, text};
use foveate_inference::Computation;
use foveate_network::ExecutionMode;
use parquet::record::Field;

/// The run has several clips, an approximate mode, and each accelerator in turn.
#[test]
fn layers_of_frames_add_up_to_frames_layers_and_totals() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["systolic-ws", "systolic-os", "eyeriss"] {
        let run = RunSetup {
            inputs: &["scene:street", "scene:shake"],
            computed: Computation::Mode(ExecutionMode::Truncate(0.02)),
            accelerator: Some(name),
            reference: true,
            ..RunSetup::default()
        };
        let summary = run.write(dir.path()).unwrap();
        let [details, frames, layers] =
            ["layers_frames.parquet", "frames.parquet", "layers.parquet"]
                .map(|table| rows(dir.path(), table));
        assert_eq!(details.len(), frames.len() * layers.len());
        assert_eq!((frames.len(), summary.counted_frames), (8, 6));
        for frame in &frames {
            let own =
                |row: &&TableRow| row["clip"] == frame["clip"] && row["frame"] == frame["frame"];
            let sum = |column: &str| -> f64 {
                details.iter().filter(own).map(|row| number(row, column)).sum()
            };
            for column in [
                "macs_needed",
                "macs_scheduled",
                "read_bytes",
                "halo_bytes",
                "written_bytes",
                "latency_seconds",
                "energy_mj",
            ] {
                assert!(
                    is_near(sum(column), number(frame, column)),
                    "{name}: {column} of {frame:?}"
                );
            }
            assert!(sum("seconds") <= number(frame, "seconds"), "operators are a part of it");
        }
        for (layer, row) in (0..).zip(&layers) {
            let own: Vec<&TableRow> = details
                .iter()
                .filter(|row| row["layer"] == Field::Long(layer) && is_counted(row))
                .collect();
            assert_eq!(own.len(), 6);
            let mean = |column: &str| own.iter().map(|row| number(row, column)).sum::<f64>() / 6.0;
            for column in [
                "needed_share",
                "scheduled_share",
                "changed_share",
                "read_bytes",
                "halo_bytes",
                "written_bytes",
                "mask_bytes",
                "seconds",
                "energy_mj",
            ] {
                assert!(is_near(mean(column), number(row, column)), "{name}: {column} of {layer}");
            }
            let macs = number(row, "macs");
            assert!(is_near(mean("macs_needed"), macs * number(row, "needed_share")));
            assert!(is_near(mean("macs_scheduled"), macs * number(row, "scheduled_share")));
        }
        let counted: Vec<&TableRow> = frames.iter().filter(|row| is_counted(row)).collect();
        let mean = |column: &str| counted.iter().map(|row| number(row, column)).sum::<f64>() / 6.0;
        let accelerator = summary.accelerator.as_ref().unwrap();
        for (column, total) in [
            ("macs_dense", summary.macs.whole_frame),
            ("macs_needed", summary.macs.needed),
            ("macs_scheduled", summary.macs.scheduled),
            ("read_bytes", summary.traffic.read_bytes),
            ("active_share", summary.active_share),
            ("changed_share", summary.changed_share),
            ("seconds", summary.seconds_per_frame),
            ("energy_mj", accelerator.masked.energy_mj),
            ("latency_seconds", accelerator.masked.seconds),
            ("whole_energy_mj", accelerator.whole.energy_mj),
            ("whole_latency_seconds", accelerator.whole.seconds),
        ] {
            assert!(is_near(mean(column), total), "{name}: {column}: {} {total}", mean(column));
        }
        for frame in &frames {
            let [whole, masked] = ["whole_energy_mj", "energy_mj"].map(|name| number(frame, name));
            assert!(if is_counted(frame) { masked < whole } else { is_near(masked, whole) });
        }
    }
}

/// Without an accelerator the columns exist and are empty.
#[test]
fn what_was_not_counted_is_no_number() {
    let dir = tempfile::tempdir().unwrap();
    RunSetup::default().write(dir.path()).unwrap();
    for (table, columns) in [
        ("layers_frames.parquet", &["latency_seconds", "energy_mj"][..]),
        ("frames.parquet", &["whole_latency_seconds", "latency_seconds", "whole_energy_mj"]),
    ] {
        for row in rows(dir.path(), table) {
            assert_eq!(text(&row, "clip"), "street");
            columns.iter().for_each(|&column| assert_eq!(row[column], Field::Null, "{column}"));
        }
    }
}
