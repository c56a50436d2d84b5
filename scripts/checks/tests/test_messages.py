# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/checks/messages.py finds the texts that a user may see, and no others."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))

from messages import RustReader, page_texts, python_texts, script_texts  # noqa: E402


class Messages(unittest.TestCase):
    def rust(self, source, *expected):
        self.assertEqual(RustReader().read(source), list(expected))

    def test_errors_are_found_even_if_they_are_one_word(self):
        self.rust('enum E { #[error("interrupted")] A, #[error("no `{}`", .0)] B }', "interrupted", "no `{}`")

    def test_a_literal_needs_two_words_beside_its_placeholders(self):
        self.rust('fn f() { g("key"); h("a.toml"); i(format!("no file {x}")); j("{} frames") }', "no file {x}")

    def test_continued_lines_are_one_message(self):
        self.rust('fn f() -> &str { "expected a\\\n     whole number" }', "expected awhole number")
        self.rust('fn f() -> &str { "expected a \\\n     whole number" }', "expected a whole number")

    def test_panics_lints_comments_and_tests_are_left_out(self):
        self.rust('fn f() { g().expect("it was checked"); assert!(a, "it is odd"); }')
        self.rust('#[expect(clippy::x, reason = "it is long")]\nfn f() {} // "in a comment"\n')
        self.rust('#[cfg(test)]\nmod tests {\n    fn f() { g("a test says") }\n}\n')

    def test_help_is_that_of_types_that_derive_clap(self):
        self.rust("/// A type.\nstruct S { /// A field.\n a: u8 }\n")
        help_text = "/// Write a core\n///\n/// It is\n/// new.\n#[derive(Args)]\nstruct S { /// Folder\n #[arg(long)] a: u8 }\n"
        self.rust(help_text, "Write a core", "It is new.", "Folder")

    def test_lines_of_other_languages_are_left_out(self):
        self.rust('fn f() { g("assign led_o = blink and more;"); h("<svg width=\\"8\\"> two words"); }')

    def test_python_without_docstrings(self):
        source = '"""A doc string."""\nraise ValueError(f"{name} is missing: give a name")\n'
        self.assertEqual(python_texts(source), ["{name} is missing: give a name"])

    def test_scripts_and_pages(self):
        self.assertEqual(script_texts("f(`${n} of the frames`) // 'a comment here'\n"), ["${n} of the frames"])
        self.assertEqual(page_texts('<p title="a small page">One word</p><style>a b</style>word'), ["a small page", "One word"])
        self.assertEqual(page_texts("<p>All {% if x %}points of {{ y }}{% endif %}</p>"), ["All points of {}"])


if __name__ == "__main__":
    unittest.main()
