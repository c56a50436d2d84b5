# SPDX-License-Identifier: MIT OR Apache-2.0
"""The verdicts of mutants: killed by vectors, proven equivalent, waived with a reason, or survivor."""
import hashlib
import json
import os
import re
import sys
import threading

from design import LONG_STAGE, WORK

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

    def __init__(self, designs):
        self.designs, self.lock, self.path, self.found = designs, threading.Lock(), os.path.join(WORK, "journal"), {}
        for line in open(self.path) if os.path.exists(self.path) else ():
            key, *verdict = json.loads(line)
            self.found[key] = verdict

    def key(self, mutant, phase):
        digests = [design.digest(phase) for design in containing_designs(mutant, self.designs)]
        return hashlib.sha256(json.dumps([sorted(digests), mutant.place(), mutant.text, phase]).encode()).hexdigest()

    def set_verdict(self, phase, mutant, find):
        """Sets the verdict of a mutant: the known one, or that of `find`."""
        key = self.key(mutant, phase)
        if key not in self.found:
            find(mutant)
            with self.lock, open(self.path, "a") as out:
                print(json.dumps([key, mutant.verdict, mutant.killed_by, mutant.proof]), file=out)
        else:
            mutant.verdict, mutant.killed_by, mutant.proof = self.found[key]


def replay(mutant, designs, stage):
    """Replays the vectors of designs until one decides the verdict, `refused` or `killed`. Returns whether one did."""
    for design in designs:
        if design.name in mutant.unaffected_designs:
            continue
        outcome = design.run(stage, mutant.module, mutant.text)
        if outcome == "refused":
            mutant.verdict = "refused"
        elif outcome == "same":
            mutant.unaffected_designs.add(design.name)
        elif outcome != "pass":
            mutant.verdict, mutant.killed_by = "killed", (stage, design.name, outcome)
        if mutant.verdict:
            return True
    return False


def judge_short(mutant, designs, prove):
    """Sets the verdict of the short vectors and of the netlists: `refused`, `killed`, `equivalent` or `survived`."""
    if mutant.is_pointless():
        mutant.verdict = "refused"
        return
    containing = [design for design in containing_designs(mutant, designs) if not design.is_late]
    if replay(mutant, containing[:QUICK], 0):
        return
    is_same = holds_everywhere(mutant, designs, "same") if prove else False
    if is_same is not False:
        mutant.verdict, mutant.proof = "refused" if is_same is None else "equivalent", "same"
        return
    if replay(mutant, containing[QUICK:], 0):
        return
    # A proof of a leaf is cheap in comparison with the longer vectors of all designs around it.
    if prove and not mutant.design and holds_everywhere(mutant, designs, "equal", around=False):
        mutant.verdict, mutant.proof = "equivalent", "equal"
        return
    mutant.verdict = "survived"


def judge_longer(mutant, designs):
    """Sets the verdict of the longer vectors: `refused`, `killed` or `survived`."""
    mutant.verdict = None
    if not replay(mutant, containing_designs(mutant, designs), LONG_STAGE):
        mutant.verdict = "survived"


def containing_designs(mutant, designs):
    return [mutant.design] if mutant.design else [design for design in designs if design.has(mutant.module)]


def holds_everywhere(mutant, designs, proof, around=True):
    """Returns whether the proof holds in every design: for the module with the design's parameters, or else, with `around`,
    for the design around it. Returns None if the proof finds that the edit is no mutant."""
    results = {}
    for design in containing_designs(mutant, designs):
        if design.name in mutant.unaffected_designs:
            continue
        if design.is_late and design.has_same_program(mutant.module, mutant.text):
            mutant.unaffected_designs.add(design.name)
            continue
        variants = design.variants(mutant.module)
        for name in variants:
            if name not in results:
                results[name] = getattr(design, proof)(mutant.module, mutant.text, name)
            if results[name] is None:
                return None
            if not (results[name] or around and design.top not in variants):
                return False
        if not all(results[name] for name in variants) and not getattr(design, proof)(mutant.module, mutant.text):
            return False
    return True


def prove(mutant, designs):
    if holds_everywhere(mutant, designs, "equal"):
        mutant.verdict, mutant.proof = "equivalent", "equal"


def find_wrongly_proven(killed, designs, proof):
    """Returns a killed mutant for which the proof holds, which is an error of the proof: only the last of them that is a circuit is tried."""
    for mutant in reversed(killed):
        # Simulation kills a net without a single driver. Synthesis chooses a value for it, so that a proof has no meaning.
        if holds_everywhere(mutant, designs, "same") is not None:
            return mutant if holds_everywhere(mutant, designs, proof) else None
    return None
