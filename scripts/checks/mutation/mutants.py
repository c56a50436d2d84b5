# SPDX-License-Identifier: MIT OR Apache-2.0
"""Mutants: one edit of one module each, and the choice of those that are drawn."""
import collections
import fnmatch
import random
import re
import sys

from edits import edits

LEAVES = "crates/emit/src/leaf.rs"


class Mutant:
    """A mutant: one edit of one module; `design` is set if the module is rendered for that design."""

    def __init__(self, module, design, text, operator, start, end, replacement):
        self.module, self.design, self.operator = module, design, operator
        self.text = text[:start] + replacement + text[end:]
        self.line = text.count("\n", 0, start) + 1
        low, high = text.rfind("\n", 0, start) + 1, text.find("\n", end)
        self.old_line = one_line(text[low:high])
        self.new_line = one_line(text[low:start] + replacement + text[end:high])
        self.verdict = self.killed_by = self.proof = None
        # The names of designs in which the changed code is not elaborated, so that their vectors need no replay.
        self.unaffected_designs = set()

    def is_pointless(self):
        """Returns whether the edit cannot matter: it changes a wire that only marks unused signals for lint, or assigns a wire to itself."""
        assignment = re.match(r"(?:wire|assign)\b.*?(\w+)(?:\[[^=]*\])? = (.*)", self.new_line)
        return "unused_" in self.old_line or bool(self.operator == "name" and assignment and re.search(rf"\b{assignment[1]}\b", assignment[2]))

    def key(self):
        return self.place(), self.old_line, self.new_line

    def place(self):
        return f"{self.module}@{self.design.name}" if self.design else self.module

    def __str__(self):
        return f"{self.place()}:{self.line} {self.operator}\n    - {self.old_line}\n    + {self.new_line}"


def one_line(text):
    return " ".join(text.split())


def make_pools(designs, seed):
    """Returns all mutants of each module, in the order in which they are drawn: the operators take turns."""
    leaves = re.findall(r'^    "(\w+)" => \[', open(LEAVES).read(), re.M)
    texts, pools = {}, {}
    for design in designs:
        for name, text in design.mutable().items():
            module = re.fullmatch(r"rtl/(\w+)\.v", name)
            if not module:
                continue
            module = module.group(1)
            # A leaf has the same text in every design; a rendered module has a text for each design.
            if module in leaves:
                texts[module] = (module, None, text)
            else:
                texts[f"{module}@{design.name}"] = (module, design, text)
    for place, (module, design, text) in sorted(texts.items()):
        def pick(where, place=place):
            return random.Random(f"{seed}:{place}:{where}")

        groups, texts_of_mutants = collections.defaultdict(list), {text}
        for operator, start, end, replacement in edits(text, design is not None, pick):
            mutant = Mutant(module, design, text, operator, start, end, replacement)
            if mutant.text not in texts_of_mutants:
                texts_of_mutants.add(mutant.text)
                groups[operator].append(mutant)
        turns = []
        for operator in sorted(groups):
            pick(operator).shuffle(groups[operator])
            size = len(groups[operator])
            turns += [((rank + pick(f"{operator}{rank}").random()) / size, operator, rank) for rank in range(size)]
        pools[place] = [groups[operator][rank] for _, operator, rank in sorted(turns)]
    return pools


def mutant_counts(pools, count):
    """Returns the number of mutants of each module: in proportion to the square root of all of its mutants, and at least four."""
    counts = {place: min(4, len(pool)) for place, pool in pools.items()}
    while sum(counts.values()) < count:
        open_places = [place for place in pools if counts[place] < len(pools[place])]
        if not open_places:
            break
        counts[max(open_places, key=lambda place: len(pools[place]) ** 0.5 / (counts[place] + 1))] += 1
    return counts


def selected_modules(pools, patterns):
    """Returns the modules that a run names: a leaf, a rendered module with or without its design, or a pattern as for file names."""
    places_of = {pattern: [place for place in pools if fnmatch.filter((place, place.partition("@")[0]), pattern)] for pattern in patterns}
    unknown = [pattern for pattern in places_of if not places_of[pattern]]
    if unknown:
        sys.exit(f"mutation: no module is called {' or '.join(unknown)}; the modules are {' '.join(pools)}")
    return {place: pools[place] for place in pools if any(place in places for places in places_of.values())}


def draw_mutants(pools, counts, pool, check):
    """Returns the mutants that elaborate and can have an effect, the wanted number of each module."""
    next_index, accepted = collections.Counter(), collections.defaultdict(list)
    while True:
        batch = []
        for place, mutants in pools.items():
            missing = counts[place] - len(accepted[place])
            batch += mutants[next_index[place]:next_index[place] + missing]
            next_index[place] += missing
        if not batch:
            return [mutant for place in pools for mutant in accepted[place]]
        list(pool.map(check, batch))
        for mutant in batch:
            if mutant.verdict != "refused":
                accepted[mutant.place()].append(mutant)
