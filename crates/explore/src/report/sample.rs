// SPDX-License-Identifier: MIT OR Apache-2.0
//! Made-up explorations, for tests of the page.

use foveate_estimate::{Area, ClockEstimate, FrameRate, LogicPath};
use foveate_measure::{FidelityFigures, ScoreError, Staleness};

use crate::objective::mark_fronts;
use crate::row::count_to_f64;
use crate::{
    ClipRow, DesignArea, DesignRow, DesignSpace, Exploration, FrontMembership, RefusedCombination,
    WorstClip,
};

fn clock(mhz: f64) -> ClockEstimate {
    let (low_mhz, high_mhz) = (mhz / 1.25, mhz / 0.75);
    ClockEstimate { mhz, low_mhz, high_mhz, wiring_share: 0.65, path: LogicPath::default() }
}

/// Returns an exploration with every design of a space, with figures that follow from its settings.
pub(crate) fn sample_exploration(space: &str, areas: bool) -> Exploration {
    let space = DesignSpace::from_toml(space).unwrap();
    let (points, refused) = space.points(224, 224);
    let mut rows = Vec::new();
    for (index, point) in points.into_iter().enumerate() {
        let design = point.config.validate().unwrap();
        let noise = count_to_f64(u64::try_from(index * 37 % 11).unwrap()) / 11.0;
        let clocks = design.timing().clocks_per_frame();
        let bits = f64::from(design.pixel_bits());
        let of = |axis: &str| {
            let found = space.axes.iter().position(|other| other.key == axis);
            found.and_then(|axis| point.settings[axis].trim_matches('"').parse::<f64>().ok())
        };
        let level = of("spatial.0.level").unwrap_or(100.0);
        let steady = point.settings.iter().any(|text| text.contains("shared"));
        let flips = if steady && bits > 7.5 && noise < 0.3 {
            0.0
        } else {
            0.0004 * (9.0 - bits).powi(3) * (1.0 + noise) + (level - 100.0).abs() / 900.0
        };
        let fold = count_to_f64(clocks).log10();
        let luts = 20_000.0 * bits / fold * (1.0 + 0.1 * noise);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "small and positive"
        )]
        let count = |value: f64| value as u64;
        let area = |scale: f64| Area {
            lut_total_packed: count(luts * scale),
            lut_memory_packed: count(luts * scale / 9.0),
            ff: count(luts * scale * 1.4),
            bram18: 3,
            ..Area::default()
        };
        rows.push(DesignRow {
            number: index + 1,
            settings: point.settings,
            config: point.config,
            fingerprint: design.fingerprint(),
            figures: figures(flips, bits, (130.0 - level) / 200.0 + bits / 300.0 + fold / 90.0),
            bytes_per_frame: 196.0 + 6000.0 * bits * (0.2 + noise / 30.0),
            clocks_per_frame: clocks,
            // Each design has its own clock, as a synthesis would find it.
            speed: areas.then(|| FrameRate::at_estimated_clock(&clock(40.0 + 2.0 * bits), clocks)),
            silicon: areas.then(|| DesignArea {
                unit: area(0.01),
                units: 784,
                array: area(1.0),
                logic_levels: 9,
            }),
            device_share: areas.then(|| luts / 1_182_240.0),
            process: None,
            worst_clip: Some(WorstClip { name: "hall.mp4".to_owned(), action_flips: 1.5 * flips }),
            load: None,
            front: FrontMembership::default(),
        });
    }
    mark_fronts(&mut rows, false);
    Exploration {
        format_version: 1,
        program: "foveate 0.1.0".to_owned(),
        clips: vec![
            ClipRow {
                name: "street <script>alert(1)</script> & \"night\"".to_owned(),
                frames: 1200,
            },
            ClipRow { name: "hall.mp4".to_owned(), frames: 300 },
        ],
        size: (224, 224),
        disturbance: None,
        luma: "coded",
        ideal: space.ideal.to_toml(),
        clock_mhz: space.clock_mhz,
        library: None,
        energy_rate: None,
        link_bits_per_second: None,
        axes: space.axes.iter().map(|axis| axis.key.clone()).collect(),
        rows,
        refused: [refused_sample()].into_iter().chain(refused).collect(),
        problems: vec!["hall.mp4: frame 300 of 450 is damaged".to_owned()],
        awaited_areas: 0,
    }
}

fn refused_sample() -> RefusedCombination {
    RefusedCombination {
        settings: "region.size = 65".to_owned(),
        reason: "<65> is more than 64".to_owned(),
    }
}

fn figures(flips: f64, bits: f64, active: f64) -> FidelityFigures {
    let score = |feature: &str, unit: &str, max: f64| ScoreError {
        feature: feature.to_owned(),
        unit: unit.to_owned(),
        max,
        mean: max / 30.0,
        rms: max / 12.0,
    };
    FidelityFigures {
        frames: 1500,
        scores: vec![
            score("edge", "share of pixels", 0.125),
            score("temporal", "grey levels", 6.0),
        ],
        srs_flips: flips * 0.6,
        trs_flips: flips * 0.7,
        action_flips: flips,
        missed: flips * 1.7,
        false_alarms: flips * 1.1,
        active_iou: 1.0 - flips * 2.0,
        active,
        ideal_active: 0.172,
        summarized: 0.0,
        psnr_ideal: (flips > 0.0).then(|| 22.0 - 6.0 * flips.log10()),
        psnr_input: Some(18.0 + 1.4 * bits),
        ssim_ideal: 1.0 - flips,
        ssim_input: 0.7 + bits / 50.0,
        stale_regions: flips * 0.9,
        staleness: Staleness {
            max: 30.0,
            mean: 0.4 + flips * 20.0,
            longest: 12,
            share: flips * 0.9,
        },
    }
}
