# SPDX-License-Identifier: MIT OR Apache-2.0
"""The verdicts of mutants: killed by vectors, proven equivalent, waived with a reason, or survivor."""
import hashlib
import json
import os
import re
import sys
import threading

from design import LATER, WORK

REASONS = "mutation/survivors.txt"
# After this number of the smallest designs, the mutant is tested for any effect on the netlist.
QUICK = 3


def reasons():
    """Reads the reviewed survivors. Each is a paragraph: `place`, `- line`, `+ line`, `reason`."""
    found = {}
    for paragraph in re.split(r"\n\s*\n", open(REASONS).read()):
        lines = [line.strip() for line in paragraph.splitlines() if line.strip() and not line.startswith("#")]
        if not lines:
            continue
        if len(lines) < 4 or not lines[1].startswith("- ") or not lines[2].startswith("+ "):
            sys.exit(f"mutation: {REASONS}: wants a place, `- line`, `+ line` and a reason: {lines[0]}")
        found[lines[0], lines[1][2:], lines[2][2:]] = " ".join(lines[3:])
    return found


class Journal:
    """The known verdicts of mutants, so that an interrupted run can continue."""

    def __init__(self, all_of):
        self.all_of, self.lock, self.path, self.found = all_of, threading.Lock(), os.path.join(WORK, "journal"), {}
        for line in open(self.path) if os.path.exists(self.path) else ():
            key, *verdict = json.loads(line)
            self.found[key] = verdict

    def key(self, mutant, phase):
        of = [design.digest(phase) for design in containing(mutant, self.all_of)]
        return hashlib.sha256(json.dumps([sorted(of), mutant.place(), mutant.text, phase]).encode()).hexdigest()

    def ask(self, phase, mutant, find):
        """Sets the verdict of a mutant: the known one, or that of `find`."""
        key = self.key(mutant, phase)
        if key not in self.found:
            find(mutant)
            with self.lock, open(self.path, "a") as out:
                print(json.dumps([key, mutant.verdict, mutant.by, mutant.proof]), file=out)
        else:
            mutant.verdict, mutant.by, mutant.proof = self.found[key]


def replay(mutant, designs, stage):
    """Replays the vectors of designs. Returns whether they decide; the verdict is then `refused` or `killed`."""
    for design in designs:
        if design.name in mutant.apart:
            continue
        outcome = design.run(stage, mutant.module, mutant.text)
        if outcome == "refused":
            mutant.verdict = "refused"
        elif outcome == "same":
            mutant.apart.add(design.name)
        elif outcome != "pass":
            mutant.verdict, mutant.by = "killed", (stage, design.name, outcome)
        if mutant.verdict:
            return True
    return False


def judge(mutant, all_of, prove):
    """Sets the verdict of the short vectors and of the netlists: `refused`, `killed`, `equivalent` or `survived`."""
    if mutant.pointless():
        mutant.verdict = "refused"
        return
    contain = [design for design in containing(mutant, all_of) if not design.late]
    if replay(mutant, contain[:QUICK], 0):
        return
    found = everywhere(mutant, all_of, "same") if prove else False
    if found is not False:
        mutant.verdict, mutant.proof = "refused" if found is None else "equivalent", "same"
        return
    if replay(mutant, contain[QUICK:], 0):
        return
    # A proof of a leaf is cheap in comparison with the longer vectors of all designs around it.
    if prove and not mutant.design and everywhere(mutant, all_of, "equal", around=False):
        mutant.verdict, mutant.proof = "equivalent", "equal"
        return
    mutant.verdict = "survived"


def judge_longer(mutant, all_of):
    """Sets the verdict of the longer vectors: `refused`, `killed` or `survived`."""
    mutant.verdict = None
    if not replay(mutant, containing(mutant, all_of), LATER):
        mutant.verdict = "survived"


def containing(mutant, all_of):
    return [mutant.design] if mutant.design else [design for design in all_of if design.has(mutant.module)]


def everywhere(mutant, all_of, proof, around=True):
    """Returns whether the proof holds in every design: for the module with the design's parameters, or else for the design around it,
    with `around`. Returns None if the proof does."""
    known = {}
    for design in containing(mutant, all_of):
        if design.name in mutant.apart:
            continue
        if design.late and design.alike(mutant.module, mutant.text):
            mutant.apart.add(design.name)
            continue
        variants = design.variants(mutant.module)
        for name in variants:
            if name not in known:
                known[name] = getattr(design, proof)(mutant.module, mutant.text, name)
            if known[name] is None:
                return None
            if not (known[name] or around and design.top not in variants):
                return False
        if not all(known[name] for name in variants) and not getattr(design, proof)(mutant.module, mutant.text):
            return False
    return True


def prove(mutant, all_of):
    if everywhere(mutant, all_of, "equal"):
        mutant.verdict, mutant.proof = "equivalent", "equal"


def claimed_equal(killed, all_of, proof):
    """Returns the last of these mutants that is a circuit, if the proof holds for it."""
    for mutant in reversed(killed):
        # Simulation kills a net without a single driver. Synthesis chooses a value for it, so that a proof has no meaning.
        if everywhere(mutant, all_of, "same") is not None:
            return mutant if everywhere(mutant, all_of, proof) else None
    return None
