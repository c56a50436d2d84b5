# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that variants.py finds the code that would take a new variant for a known one."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))

from variants import variant_tests  # noqa: E402


class Variants(unittest.TestCase):
    def lines(self, text, expected):
        self.assertEqual(variant_tests(text), expected, text)

    def test_comparisons_are_found(self):
        self.lines("let a = 1;\nif design.organization() == Organization::Raster {}", [2])
        self.lines("if Organization::Serial != design.organization() {}", [1])
        self.lines("if reference == foveate_design::ReferencePolicy::LastSent {}", [1])
        self.lines("let is = matches!(design.hardware(), Hardware::Serial(_));", [1])
        self.lines("let is = matches!(\n    kind,\n    FeatureKind::Edge | FeatureKind::Corner\n);", [1])

    def test_what_variants_are_asked_for_is_found_too(self):
        self.lines("if reference.write_time() == ReferenceWriteTime::WhenSent {}", [1])
        self.lines("match unit.array {\n    ArrayStructure::Copies => 1,\n    _ => 2,\n}", [3])
        self.lines("match unit.array {\n    ArrayStructure::Copies => 1,\n    ArrayStructure::Whole => 2,\n}", [])

    def test_arms_that_catch_all_are_found(self):
        self.lines("match design.hardware() {\n    Hardware::Raster(own) => own.words(),\n    _ => 1,\n}", [3])
        self.lines("match kind {\n    FeatureKind::Edge => { a(b, c) }\n    other => d(other),\n}", [3])
        self.lines("match (reference, is) {\n    (ReferencePolicy::Previous, true) => 1,\n    _ => 2,\n}", [3])

    def test_views_that_stand_for_all_others_are_found(self):
        self.lines("let lanes =\n    design.as_serial().map(lanes).unwrap_or(1);", [2])
        self.lines("match design.as_raster() { Some(core) => 1, None => 2 }", [1])
        self.lines('let own = design.as_pipelined()\n    .expect("it is");', [])

    def test_what_only_one_feature_has_is_found(self):
        self.lines("if feature.mean().is_some() {}", [1])
        self.lines("let detects = feature.kind().name() == name;", [1])
        self.lines("let mean = features.iter().find_map(|feature| feature.mean());", [1])
        self.lines("let mean = features.iter().find_map(SpatialFeature::mean);", [1])
        self.lines("let counts = entry.level.is_some();", [1])
        self.lines('let mean = feature.mean().expect("mad has a mean");', [])

    def test_names_that_are_compared_are_found(self):
        self.lines('if design.organization().name() == "raster" {}', [1])
        self.lines('if temporal.reference.name() != "previous" {}', [1])
        self.lines('if preset.name == "raster" {}', [])

    def test_what_names_every_variant_is_not(self):
        self.lines("match kind {\n    None => 0,\n    Some(FeatureKind::Edge | FeatureKind::Mad) => 1,\n}", [])
        self.lines("match role {\n    PortRole::Region => 1,\n    _ => 2,\n}", [])
        self.lines("match hardware {\n    Hardware::Serial(own) => match own.feed { Feed::Raster => 1, _ => 2 },\n}", [])
        self.lines("config.organization = Organization::Raster;", [])
        self.lines("let all = FeatureKind::ALL.len() == FeatureKind::COUNT;", [])

    def test_comments_text_and_tests_are_not_looked_at(self):
        self.lines("// a == Organization::Raster\n", [])
        self.lines('let text = "a == Organization::Raster";', [])
        self.lines("#[cfg(test)]\nmod tests { fn f() { a == Organization::Raster } }", [])


if __name__ == "__main__":
    unittest.main()
