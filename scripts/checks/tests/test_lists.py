# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts and pages which list organizations, features or references list all those of the configuration."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
CAMERA, DESIGN = "crates/camera/src/choice.rs", "crates/design/src/choice.rs"
FEATURES = "crates/camera/src/feature_spec/mod.rs"


def names(choice, file):
    """Returns the values of a key, as they are written in a configuration."""
    text = (ROOT / file).read_text(encoding="utf-8")
    body = re.search(rf"\n    {choice} \{{(.*?)\n    \}}", text, re.DOTALL)[1]
    return re.findall(r'^        \w+ = "([\w-]+)"', body, re.MULTILINE)


class ListTests(unittest.TestCase):
    def check(self, choice, file, listing, default=None):
        known = [name for name in names(choice, file) if name != default]
        self.assertGreater(len(known), 1, choice)
        for path in listing:
            text = (ROOT / path).read_text(encoding="utf-8")
            missing = [name for name in known if not re.search(rf"['\"`]{name}['\"`]", text)]
            self.assertEqual(missing, [], f"{path} lists no such {choice}")

    def test_organizations(self):
        self.check("Organization", DESIGN, ["scripts/checks/mutation/design.py", "docs/organizations.md", "docs/configuration.md"])
        # The default need not be named.
        listing = ["scripts/checks/area_growth.py", "scripts/checks/lint.py", "scripts/coverage.sh", "scripts/figures/clock.py"]
        self.check("Organization", DESIGN, listing, "pipelined")

    def test_features(self):
        self.check("FeatureKind", FEATURES, ["docs/contract.md", "docs/configuration.md"])

    def test_filters(self):
        self.check("DenoiseFilter", CAMERA, ["scripts/checks/lint.py", "docs/contract.md", "docs/configuration.md"])

    def test_references(self):
        self.check("ReferencePolicy", CAMERA, ["scripts/checks/lint.py", "docs/contract.md", "docs/configuration.md"])

    def test_irrelevant_regions(self):
        self.check("IrrelevantRendering", CAMERA, ["scripts/checks/lint.py", "docs/contract.md", "docs/configuration.md"])


if __name__ == "__main__":
    unittest.main()
