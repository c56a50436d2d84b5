# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/checks/versions.py finds each place with another version, and everything that a release lacks."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import versions  # noqa: E402

CITATION = "cff-version: 1.2.0\nversion: 1.2.3\ndate-released: 2026-11-25\n"
CHANGELOG = "# Changelog\n\n## [1.2.3] - 2026-11-25\n### Added\n- A thing.\n\n## [1.2.2] - 2026-01-01\n- Another.\n"


def manifest(**package):
    dependency = {"path": "crates/pixels", "version": "=1.2.3"}
    return {"workspace": {"package": {"version": "1.2.3", "repository": "https://here", **package}, "dependencies": {"foveate-pixels": dependency}}}


def pyproject(**project):
    return {"project": {"dynamic": ["version"], **project}}


class VersionTests(unittest.TestCase):
    def disagreements(self, manifest_table=None, project=None, citation=CITATION, changelog=CHANGELOG):
        return list(versions.disagreements(manifest_table or manifest(), project or pyproject(), citation, changelog))

    def release_problems(self, manifest_table=None, citation=CITATION, changelog=CHANGELOG, tag=None):
        return list(versions.release_problems(manifest_table or manifest(), citation, changelog, tag))

    def test_nothing_where_all_agree(self):
        self.assertEqual(self.disagreements(), [])
        self.assertEqual(self.disagreements(changelog="## [Unreleased]\n- A thing.\n"), [])
        self.assertEqual(self.release_problems(tag="v1.2.3"), [])

    def test_every_place_is_looked_at(self):
        older = manifest()
        older["workspace"]["dependencies"]["foveate-pixels"]["version"] = "1.2.3"
        for changed, word in [
            ({"manifest_table": older}, 'foveate-pixels is of version 1.2.3; it has to be "=1.2.3"'),
            ({"project": pyproject(dynamic=[])}, "pyproject.toml"),
            ({"citation": CITATION.replace("1.2.3", "1.2.4")}, "CITATION.cff: version is 1.2.4"),
            # This is not the version of the format.
            ({"citation": "cff-version: 1.2.3\n"}, "CITATION.cff: version is None"),
            ({"changelog": CHANGELOG.replace("1.2.3", "1.3.0")}, "the newest section is [1.3.0]"),
        ]:
            (one,) = self.disagreements(**changed)
            self.assertIn(word, one)

    def test_a_release_lacks_what_is_not_there(self):
        for changed, word in [
            ({"changelog": CHANGELOG.replace("[1.2.3] - 2026-11-25", "[Unreleased]")}, "name it [1.2.3]"),
            ({"changelog": CHANGELOG.replace(" - 2026-11-25", "")}, "is of None"),
            ({"changelog": CHANGELOG.replace("- A thing.", "")}, "says nothing"),
            ({"citation": CITATION.replace("11-25", "11-24")}, "date-released is 2026-11-24; the changelog says 2026-11-25"),
            ({"manifest_table": manifest(repository=None)}, "no repository"),
            ({"tag": "1.2.3"}, "it has to be v1.2.3"),
        ]:
            (one,) = self.release_problems(**changed)
            self.assertIn(word, one)

    def test_a_crate_without_licences_or_with_a_link_to_elsewhere_is_unfit(self):
        with tempfile.TemporaryDirectory() as elsewhere, tempfile.TemporaryDirectory() as project:
            folder = pathlib.Path(project, "crates/pixels")
            folder.mkdir(parents=True)
            (folder / "Cargo.toml").write_text('[package]\nname = "foveate-pixels"\ndescription = "A frame"\n')
            self.assertEqual(len(list(versions.missing_files(folder))), 2)
            for name in versions.LICENSES:
                (pathlib.Path(project) / name).write_text("")
                (folder / name).symlink_to(f"../../{name}")
            self.assertEqual(list(versions.missing_files(folder)), [])
            secret = pathlib.Path(elsewhere, "secret")
            secret.write_text("")
            (folder / "data").symlink_to(secret)
            (one,) = versions.missing_files(folder)
            self.assertIn("leads out of the project", one)


if __name__ == "__main__":
    unittest.main()
