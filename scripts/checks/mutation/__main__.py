# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by mutation.sh: makes mutants of the Verilog, which the co-simulation vectors must kill, and judges the survivors.

1. Records the vectors of every design of mutation/designs.txt once, as co-simulation gives them to Icarus (design.py).
2. Makes the mutants: one edit each, from a seed, spread over all leaves and rendered modules of an organization (mutants.py).
   The edits are those of edits.py; parameter defaults, limits, clocks and loop steps are left alone, declared ranges only become narrower.
3. Replays the vectors of the designs that contain the module, smallest first, until a mismatch (verdicts.py). A replay that
   takes 12 times the processor time of the unmutated one, or in which Icarus aborts, counts as a mismatch, too.
4. If Icarus makes the same program, the mutant is not in the design. A survivor is equivalent if Yosys makes the same netlist
   of it in every design. It is not a mutant if it leaves a net without a driver or with two: every synthesis tool refuses that.
   The other survivors get longer vectors.
5. Mutants that still survive must be proven equal in every design, from reset on (proof.py), or mutation/survivors.txt must say why.
"""
import argparse
import collections
import concurrent.futures
import os
import shutil
import sys
import time

from design import LATER, ORGANIZATIONS, WORK, designs, recorded
from mutants import drawn, only, pools, wanted
from verdicts import REASONS, Journal, claimed_equal, judge, judge_longer, prove, reasons, replay


def examine(organization, options, excuses, used):
    """Judges the mutants of an organization, and prints the verdicts. Returns the number of survivors without a reason."""
    began = time.monotonic()
    all_of = recorded(organization, options.jobs, options.sample)
    found = pools(all_of, options.seed)
    takes = wanted(found, options.count)
    if options.modules:
        found = only(found, options.modules)
    print(f"{organization}: {len(all_of)} designs recorded in {time.monotonic() - began:.0f} s, {len(found)} modules with"
          f" {sum(map(len, found.values()))} possible mutants", flush=True)
    if options.sample:
        found, takes = sampled(found, takes, options.sample)
    journal = Journal(all_of)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        mutants = drawn(found, takes, pool, lambda mutant: journal.ask("short", mutant, lambda it: judge(it, all_of, options.prove)))
        survivors = [mutant for mutant in mutants if mutant.verdict in ("survived", "equivalent")]
        unknown = [mutant for mutant in survivors if mutant.verdict == "survived"]
        if options.sample:
            unknown = shown_to_others(organization, [mutant for mutant in unknown if mutant.key() not in excuses])
        elif options.longer:
            list(pool.map(lambda mutant: journal.ask("long", mutant, lambda it: judge_longer(it, all_of)), unknown))
            unknown = [mutant for mutant in unknown if mutant.key() not in excuses]
        unknown = [mutant for mutant in unknown if mutant.verdict == "survived"]
        if options.prove:
            if options.longer:
                list(pool.map(lambda mutant: journal.ask("proof", mutant, lambda it: prove(it, all_of)), unknown))
            control_proofs(mutants, survivors, all_of, pool)
    # A mutant that does not elaborate in another design is not a mutant.
    mutants, survivors = ([mutant for mutant in of if mutant.verdict != "refused"] for of in (mutants, survivors))
    open_ones = excuse(survivors, excuses, used, options.verbose)
    if options.table:
        print_table(found, mutants)
    print_counts(organization, found, mutants, open_ones, time.monotonic() - began)
    return open_ones


def sampled(found, takes, sample):
    """Returns an evenly spread sample of the mutants of a whole run of these designs."""
    whole = [mutant for place in found for mutant in found[place][:takes[place]]]
    step = len(whole) / sample
    chosen = collections.defaultdict(list)
    for index in range(sample):
        mutant = whole[int((index + 0.5) * step)]
        chosen[mutant.place()].append(mutant)
    # A mutant that does not elaborate is replaced by another of its module.
    found = {place: chosen[place] + [m for m in found[place] if m not in chosen[place]] for place in chosen}
    return found, {place: len(chosen[place]) for place in chosen}


def shown_to_others(organization, unknown):
    """Replays the vectors of designs outside of the sample, only for mutants that survived and that these designs may kill."""
    for mutant in unknown:
        others = [design for design in designs(organization) if not (design.starred or mutant.design)]
        mutant.verdict = None
        for design in others:
            stage = LATER if design.late else 0
            design.record(stage)
            if design.has(mutant.module) and replay(mutant, [design], stage):
                break
        mutant.verdict = mutant.verdict or "survived"
    return unknown


def control_proofs(mutants, survivors, all_of, pool):
    """Runs the negative control of the proofs: a killed mutant of the same module must not be proven equal."""
    proven = {mutant.place(): mutant.proof for mutant in survivors if mutant.proof}
    killed = collections.defaultdict(list)
    for mutant in mutants:
        if mutant.verdict == "killed" and mutant.place() in proven:
            killed[mutant.place()].append(mutant)
    for claimed in pool.map(lambda place: claimed_equal(killed[place], all_of, proven[place]), killed):
        if claimed:
            sys.exit(f"mutation: proven equal is what the vectors tell apart: {claimed}")


def excuse(survivors, excuses, used, verbose):
    """Prints the survivors without a reason. Returns their number."""
    open_ones = 0
    for mutant in survivors:
        if mutant.verdict == "survived" and mutant.key() in excuses:
            mutant.verdict = "waived"
            used.add(mutant.key())
        if mutant.verdict == "survived":
            open_ones += 1
            print(f"SURVIVES {mutant}")
        elif verbose:
            print(f"{mutant.verdict}{f' ({mutant.proof})' if mutant.proof else ''} {mutant}")
    return open_ones


def print_table(found, mutants):
    print(f"  {'module':28} mutants  killed  equivalent   waived")
    for place in found:
        of = [mutant.verdict for mutant in mutants if mutant.place() == place]
        print(f"  {place:28} {len(of):7} {of.count('killed'):7} {of.count('equivalent'):11} {of.count('waived'):8}")


def print_counts(organization, found, mutants, open_ones, seconds):
    count = collections.Counter(mutant.verdict for mutant in mutants)
    alike = sum(1 for mutant in mutants if mutant.verdict == "equivalent" and mutant.proof == "same")
    longer = sum(1 for mutant in mutants if mutant.by and mutant.by[0] > 0)
    hangs, aborts = (sum(1 for mutant in mutants if mutant.by and mutant.by[2] == outcome) for outcome in ("hang", "abort"))
    print(f"{organization}: {len(mutants)} mutants of {len(found)} modules: {count['killed']} killed ({longer} of them by the"
          f" longer vectors, {hangs} by time, {aborts} by an abort of Icarus), {count['equivalent']} proven equivalent ({alike} of"
          f" them by the same netlist), {count['waived']} waived with a reason, {open_ones} open; {seconds:.0f} s", flush=True)


def main():
    parser = argparse.ArgumentParser(prog="mutation.sh", description="Mutants of the Verilog against the co-simulation vectors.")
    parser.add_argument("organizations", nargs="*", metavar="ORGANIZATION", help=f"{', '.join(ORGANIZATIONS)}; by default all")
    parser.add_argument("--modules", nargs="+", metavar="NAME",
                        help="only those mutants of a whole run that are in these modules: serial_lane, rcm, rcm@deep, 'raster_c*'")
    parser.add_argument("--count", type=int, default=320, help="mutants of an organization (%(default)s)")
    parser.add_argument("--sample", type=int, metavar="N",
                        help="only N of them, evenly spread, in the smallest designs; the others only for survivors")
    parser.add_argument("--seed", type=int, default=1, help="seed of the mutants (%(default)s)")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("JOBS", os.cpu_count() or 1)), help="at a time (%(default)s)")
    parser.add_argument("--table", action="store_true", help="print a table by module")
    parser.add_argument("--verbose", action="store_true", help="print the survivors that are proven or waived, too")
    parser.add_argument("--no-proofs", dest="prove", action="store_false", help="do not try to prove survivors equivalent")
    parser.add_argument("--no-longer", dest="longer", action="store_false", help="leave survivors of the short vectors open")
    parser.add_argument("--resume", action="store_true",
                        help="go on where a run was ended; what other designs or vectors touch is found anew")
    options = parser.parse_args()
    organizations = options.organizations or ORGANIZATIONS
    if set(organizations) - set(ORGANIZATIONS):
        parser.error(f"an organization is one of {', '.join(ORGANIZATIONS)}, not {' '.join(organizations)}")
    if options.modules and len(organizations) != 1:
        parser.error("--modules are those of one organization")
    if not options.resume:
        shutil.rmtree(WORK, ignore_errors=True)
    # Hundreds of builds would displace the user's own in the cache. A sample uses the cached run time of Verilator.
    if not options.sample:
        os.environ["FOVEATE_CACHE"] = os.path.join(WORK, "cache")
    excuses, used = reasons(), set()
    open_ones = sum(examine(organization, options, excuses, used) for organization in organizations)
    unused = []
    is_whole = list(organizations) == ORGANIZATIONS and (options.seed, options.count) == (1, 320)
    if is_whole and options.prove and not (options.sample or options.modules):
        unused = [key for key in excuses if key not in used]
        for place, was, now in unused:
            print(f"{REASONS}: no survivor needs this; remove it: {place}\n    - {was}\n    + {now}")
    sys.exit(1 if open_ones or unused else 0)


if __name__ == "__main__":
    main()
