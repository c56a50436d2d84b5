# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests that scripts/checks/circles.py finds imports in a circle, and no others."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))

from circles import Crate, paths  # noqa: E402


class CircleTests(unittest.TestCase):
    def circles(self, expected, **texts):
        modules = {tuple(name.split("__")) if name != "lib" else (): text for name, text in texts.items()}
        circles = Crate(modules).circles()
        self.assertEqual(sorted(sorted("::".join(module) for module in circle) for circle in circles), expected)

    def test_a_circle_is_found(self):
        self.circles([["a", "b"]], a="use crate::b::B;", b="fn f() { crate::a::g() }")
        self.circles([["a", "b", "c"]], a="use crate::{b, d};", b="use super::c::C;", c="use crate::a::{self, A};", d="")
        self.circles([["a", "b"], ["c", "d"]], a="use crate::b;", b="use crate::a;", c="use crate::d;", d="use crate::c;")

    def test_a_reexport_counts_for_the_file_that_defines_the_item(self):
        lib = "mod a; mod b; pub use a::A; pub use b::{B, other as Other};"
        self.circles([["a", "b"]], lib=lib, a="use crate::B;", b="use crate::A;")
        self.circles([], lib=lib, a="use crate::B;", b="use std::fmt;")

    def test_parent_and_child_are_one_thing(self):
        self.circles([], a="use crate::a::b::B;", a__b="use super::A;")
        self.circles([["a::b", "c"]], a="pub use b::B;", a__b="use crate::c::C;", c="use crate::a::B;")

    def test_one_direction_comments_and_tests_are_none(self):
        self.circles([], a="use crate::b::B;", b="// use crate::a::A;\n")
        self.circles([], a="use crate::b::B;", b="#[cfg(test)]\nmod tests { use crate::a::A; }")

    def test_paths_of_a_tree(self):
        self.assertEqual(paths("a::{b, c::{d, e as f}, self}"), [("a", "b"), ("a", "c", "d"), ("a", "c", "e"), ("a", "self")])


if __name__ == "__main__":
    unittest.main()
