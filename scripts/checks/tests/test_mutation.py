# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the parts of mutation.sh: the reading of Verilog, its edits, the drawing of mutants, and the reasons that count."""
import os
import sys
import tempfile
import unittest
from types import SimpleNamespace

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "mutation"))

import proof  # noqa: E402
import verdicts  # noqa: E402
from edits import edits  # noqa: E402
from mutants import Mutant, draw_mutants, mutant_counts, selected_modules  # noqa: E402
from verilog import declared, literals, partners, statements, tokens  # noqa: E402

MODULE = """\
module counter #(parameter WIDTH = 4) (input wire clk_i, input wire [3:0] step_i, output reg [3:0] count_q);
    wire [3:0] other = count_q;  // not this: 9
    always @(posedge clk_i)
        if (step_i != 4'd0) count_q <= count_q + step_i;
endmodule
"""


def first_choice(_):
    return SimpleNamespace(choice=lambda names: names[0])


def edit_set(text):
    """Returns (operator, text, replacement) of every edit."""
    return {(operator, text[start:end], replacement) for operator, start, end, replacement in edits(text, False, first_choice)}


class Reading(unittest.TestCase):
    def test_comments_and_attributes_are_no_tokens(self):
        self.assertEqual([token.text for token in tokens("a /* b */ <= (* c *) 4'hF; // d")], ["a", "<=", "4'hF", ";"])

    def test_brackets_find_each_other(self):
        stream = tokens("f(a[{b}])")
        self.assertEqual(partners(stream), {1: 8, 8: 1, 3: 7, 7: 3, 4: 6, 6: 4})

    def test_a_statement_begins_after_its_condition(self):
        stream = tokens("if (a) b <= c; d <= e;")
        starts, depths = statements(stream, partners(stream))
        self.assertEqual([stream[start].text for start in starts][4:], ["b"] * 4 + ["d"] * 4)
        self.assertEqual(depths[2], 1)

    def test_literals_are_one_more_and_one_less_in_their_bits(self):
        def others(text):
            return literals(tokens(text)[0])

        self.assertEqual(others("0"), ["1"])
        self.assertEqual(others("7"), ["8", "6"])
        self.assertEqual(others("2'b11"), ["2'b00", "2'b10"])
        self.assertEqual(others("8'h10"), ["8'hf", "8'h11"])
        self.assertEqual(others("4'sd1"), [])

    def test_names_of_one_range_can_stand_for_each_other(self):
        stream = tokens(MODULE)
        names = declared(stream, partners(stream))
        self.assertEqual(names["count_q"], ("signal", "[3:0]"))
        self.assertEqual(names["other"], names["step_i"])
        self.assertEqual(names["WIDTH"][0], "constant")


class Edits(unittest.TestCase):
    def test_every_operator_of_mutation_is_there(self):
        found_edits = edit_set(MODULE)
        for edit in [
            ("operator", "!=", "=="),
            ("operator", "+", "-"),
            ("condition", "step_i != 4'd0", "1'b0"),
            ("condition", "step_i != 4'd0", "!(step_i != 4'd0)"),
            ("constant", "4'd0", "4'd1"),
            ("drop", "count_q + step_i", "count_q"),
            ("name", "step_i", "count_q"),
            ("range", "", "-1"),
        ]:
            self.assertIn(edit, found_edits)

    def test_parameters_clocks_and_comments_are_left_alone(self):
        for operator, original, replacement in edit_set(MODULE):
            self.assertNotIn("clk_i", (original, replacement), operator)
            self.assertNotIn(original, ("4", "9"), operator)

    def test_limits_are_left_alone(self):
        limit = "    generate if (WIDTH < 7) begin : g_width WIDTH_must_be_7_or_more u_refused (); end endgenerate\n"
        self.assertEqual(edit_set(MODULE.replace("    always", limit + "    always")), edit_set(MODULE))
        loose = limit.replace("_must_", "_may_")
        self.assertNotEqual(edit_set(MODULE.replace("    always", loose + "    always")), edit_set(MODULE))

    def test_an_edit_changes_its_line_only(self):
        operator, start, end, replacement = next(edit for edit in edits(MODULE, False, first_choice) if edit[0] == "drop")
        mutant = Mutant("counter", None, MODULE, operator, start, end, replacement)
        self.assertEqual(mutant.line, 4)
        self.assertEqual(mutant.new_line, "if (step_i != 4'd0) count_q <= count_q;")
        changed = [pair for pair in zip(MODULE.splitlines(), mutant.text.splitlines(), strict=True) if pair[0] != pair[1]]
        self.assertEqual(len(changed), 1)
        self.assertEqual(mutant.key(), ("counter", mutant.old_line, mutant.new_line))


class Drawing(unittest.TestCase):
    def test_every_module_gets_four_and_large_ones_more(self):
        counts = mutant_counts({"small": [0] * 3, "middle": [0] * 50, "large": [0] * 400}, 60)
        self.assertEqual(sum(counts.values()), 60)
        self.assertEqual(counts["small"], 3)
        self.assertGreater(counts["large"], counts["middle"])

    def test_modules_are_named_with_or_without_their_design_or_by_a_pattern(self):
        pools = dict.fromkeys(["serial_lane", "serial_group", "rcm@deep", "rcm@plain", "rpu@deep"])
        self.assertEqual(list(selected_modules(pools, ["rcm", "serial_lane"])), ["serial_lane", "rcm@deep", "rcm@plain"])
        self.assertEqual(list(selected_modules(pools, ["*@deep"])), ["rcm@deep", "rpu@deep"])
        with self.assertRaisesRegex(SystemExit, "no module is called serial_lanes"):
            selected_modules(pools, ["rcm", "serial_lanes"])

    def test_a_refused_mutant_is_replaced_by_the_next(self):
        pool = [SimpleNamespace(number=number, verdict=None, place=lambda: "leaf") for number in range(5)]

        def check(mutant):
            mutant.verdict = "refused" if mutant.number < 2 else "killed"

        accepted = draw_mutants({"leaf": pool}, {"leaf": 2}, SimpleNamespace(map=map), check)
        self.assertEqual([mutant.number for mutant in accepted], [2, 3])


class Netlists(unittest.TestCase):
    WIRE = "  wire \\{}\n"
    CELL = "  cell $dff \\{}\n    parameter \\WIDTH 1\n    connect \\Q \\{}\n  end\n"

    def text(self, *parts):
        return proof.in_order("module \\top\n" + "".join(parts) + "end\n")

    def test_the_order_of_parts_tells_nothing(self):
        parts = [self.WIRE.format("a"), self.WIRE.format("b"), self.CELL.format("x", "a"), self.CELL.format("y", "b")]
        self.assertEqual(self.text(*parts), self.text(*reversed(parts)))
        self.assertEqual(self.text(*parts).count("\n"), 12)

    def test_what_a_cell_drives_and_how_a_wire_begins_tells_them_apart(self):
        one, zero = "  attribute \\init 1'1\n", "  attribute \\init 1'0\n"
        a, b = self.WIRE.format("a"), self.WIRE.format("b")
        self.assertNotEqual(self.text(one, a, zero, b), self.text(zero, a, one, b))
        orders = [[self.CELL.format("x", one), self.CELL.format("y", other)] for one, other in ("ab", "ba")]
        self.assertNotEqual(*(self.text(*way) for way in orders))


class Proofs(unittest.TestCase):
    """Tests with Yosys and ABC."""
    DELAY = """\
module delay (input wire clk_i, input wire we_i, input wire [1:0] at_i, input wire bit_i, output wire bit_o, output wire word_o);
    reg bit_q, more_q, read_q;
    reg words_q[0:3];
    assign bit_o = bit_q && more_q;
    assign word_o = read_q;
    always @(posedge clk_i) begin
        bit_q  <= bit_i;
        more_q <= bit_i;
        read_q <= words_q[at_i];
        if (we_i) words_q[at_i] <= bit_i;
    end
endmodule
"""

    def equal(self, original, replacement):
        self.assertIn(original, self.DELAY)
        with tempfile.TemporaryDirectory() as work:
            os.mkdir(os.path.join(work, "rtl"))
            with open(os.path.join(work, "rtl", "delay.v"), "w") as out:
                out.write(self.DELAY)
            design = SimpleNamespace(files=["rtl/delay.v"], bench=None, sources=work, top="delay", chparam=lambda: "")
            return proof.is_equal(design, work, "delay", self.DELAY.replace(original, replacement))

    def test_another_form_of_the_same_is_equal(self):
        self.assertTrue(self.equal("bit_q && more_q", "more_q"))

    def test_a_register_that_is_never_loaded_is_not_equal(self):
        self.assertFalse(self.equal("bit_q  <= bit_i;", "bit_q  <= bit_q;"))
        self.assertFalse(self.equal("read_q <= words_q[at_i];", "read_q <= read_q;"))

    def test_a_memory_that_is_never_written_is_not_equal(self):
        self.assertFalse(self.equal("if (we_i)", "if (we_i && !we_i)"))
        self.assertFalse(self.equal("<= bit_i;\n    end", "<= words_q[at_i];\n    end"))

    def test_an_initial_value_counts_where_an_output_shows_it(self):
        self.assertFalse(self.equal("read_q;\n    reg", "read_q = 1'b1;\n    reg"))
        self.assertTrue(self.equal("more_q, read_q;", "more_q = 1'b1, read_q;"))


class Reasons(unittest.TestCase):
    def read(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write(text)
            file.flush()
            previous, verdicts.REASONS = verdicts.REASONS, file.name
            try:
                return verdicts.reasons()
            finally:
                verdicts.REASONS = previous

    def test_a_paragraph_is_a_place_two_lines_and_a_reason(self):
        reasons = self.read("# why\n\nleaf\n- a = b;\n+ a = c;\nb and c\nare equal\n")
        self.assertEqual(reasons, {("leaf", "a = b;", "a = c;"): "b and c are equal"})

    def test_an_excuse_without_a_reason_is_refused(self):
        with self.assertRaises(SystemExit):
            self.read("leaf\n- a = b;\n+ a = c;\n")

    def test_the_project_s_own_reasons_are_read(self):
        self.assertTrue(verdicts.reasons())


class ControlOfProofs(unittest.TestCase):
    def claimed(self, *mutants):
        """Returns the claim about mutants with these answers to the proofs `same` and `equal`."""
        design = SimpleNamespace(name="d", is_late=False, top="top", has=lambda module: True, variants=lambda module: ["leaf"],
                                 same=lambda module, text, inside=None: text[0], equal=lambda module, text, inside=None: text[1])
        killed = [SimpleNamespace(module="leaf", design=None, unaffected_designs=set(), text=answers) for answers in mutants]
        mutant = verdicts.find_wrongly_proven(killed, [design], "equal")
        return mutant and mutant.text

    def test_a_killed_mutant_that_is_proven_equal_is_found(self):
        self.assertEqual(self.claimed((False, True)), (False, True))
        self.assertIsNone(self.claimed((False, False)))

    def test_a_net_with_two_drivers_controls_nothing(self):
        self.assertIsNone(self.claimed((None, True)))
        self.assertEqual(self.claimed((False, True), (None, False)), (False, True))


if __name__ == "__main__":
    unittest.main()
