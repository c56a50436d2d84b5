// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that no configuration, however broken, makes the parser or the validation panic, and that
//! every error is one line. `FOVEATE_FUZZ_CASES` sets the number of cases.

use foveate_design::{DesignConfig, PRESETS};

/// The random generator SplitMix64, which makes the same cases on every machine.
struct CaseGenerator(u64);

impl CaseGenerator {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() % n as u64).unwrap()
    }

    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

const VALUES: &[&str] = &[
    "0",
    "1",
    "-1",
    "2",
    "3",
    "5",
    "7",
    "8",
    "16",
    "64",
    "65",
    "255",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "0.5",
    "1e-9",
    "1e300",
    "-0.0",
    "nan",
    "inf",
    "\"\"",
    "\"edge\"",
    "\"mad\"",
    "\"shared\"",
    "\"last-sent\"",
    "\"serial\"",
    "\"raster\"",
    "\"external\"",
    "true",
    "[]",
    "{}",
    "[{}]",
    "[1]",
    "1979-05-27",
    "[{feature=\"mad\",mean_fraction_bits=12}]",
    "[{feature=\"corner\"},{feature=\"variance\",min_score=0.000000001}]",
    "\u{1F980}",
    "'",
    "\"\\u0000\"",
];
const KEYS: &[&str] = &[
    "frame.width",
    "frame.height",
    "frame.pixel_bits",
    "region.size",
    "region.neighborhood",
    "denoise.filter",
    "spatial",
    "spatial.0.level",
    "spatial.0.min_score",
    "spatial.0.feature",
    "spatial.1",
    "spatial.0.mean_fraction_bits",
    "decision.combine",
    "temporal.level",
    "temporal.min_count",
    "temporal.reference",
    "render.payload",
    "hardware.fold",
    "hardware.feed",
    "hardware.memory",
    "hardware.organization",
    "hardware.store",
    "hardware.forward",
    "hardware.thresholds",
    "hardware",
    "frame",
    "",
    ".",
    "a.b.c",
    "frame.width.x",
    "\u{0}",
];
const FRAGMENTS: &[&str] = &[
    "[",
    "]",
    "[[",
    "]]",
    "=",
    "\n",
    "\"",
    "'",
    ".",
    "#",
    "[[spatial]]\n",
    "[frame]\n",
    "\u{FEFF}",
    "level = 3\n",
    "size = 64\n",
    "feature = \"mad\"\n",
    "\\",
    "\t",
    "\u{7F}",
    "{",
    "}",
];

fn cases() -> u64 {
    std::env::var("FOVEATE_FUZZ_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(20_000)
}

/// Parses and validates a configuration. Returns true for a design and false for an error, whose
/// message must be one line.
fn attempt(text: &str, overrides: &[String]) -> bool {
    let result = DesignConfig::from_toml_with(text, overrides).and_then(|config| config.validate());
    match result {
        Ok(design) => {
            assert_eq!(
                DesignConfig::from_toml(&design.config().to_toml()).unwrap(),
                design.config()
            );
            assert!(!design.rcm_ports().is_empty() && design.fingerprint().len() == 16);
            assert!(design.timing().clocks_per_frame() > 0);
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && message.lines().count() == 1, "{text:?}: {message:?}");
            false
        }
    }
}

#[test]
fn overrides_of_every_kind() {
    let mut random = CaseGenerator(1);
    let mut designs = 0;
    for _ in 0..cases() {
        let count = random.below(4) + 1;
        let overrides: Vec<String> =
            (0..count).map(|_| format!("{}={}", random.pick(KEYS), random.pick(VALUES))).collect();
        designs += u64::from(attempt("", &overrides));
    }
    assert!(designs > 0, "some of the cases are designs");
}

#[test]
fn broken_files() {
    let mut random = CaseGenerator(2);
    let originals: Vec<String> = PRESETS
        .iter()
        .map(|preset| preset.config().unwrap().validate().unwrap().config().to_toml())
        .collect();
    let mut designs = 0;
    for _ in 0..cases() {
        let mut text: Vec<char> = originals[random.below(originals.len())].chars().collect();
        for _ in 0..=random.below(3) {
            let at = random.below(text.len().max(1)).min(text.len());
            let end = (at + random.below(12)).min(text.len());
            match random.below(4) {
                0 => drop(text.drain(at..end)),
                1 => drop(text.splice(at..end, random.pick(FRAGMENTS).chars())),
                2 => drop(text.splice(at..end, random.pick(VALUES).chars())),
                _ => text.truncate(at.max(1)),
            }
        }
        designs += u64::from(attempt(&text.into_iter().collect::<String>(), &[]));
    }
    assert!(designs > 0, "some of the cases are designs");
}
