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

from design import LONG_STAGE, ORGANIZATIONS, WORK, designs, record_designs
from mutants import draw_mutants, make_pools, mutant_counts, selected_modules
from verdicts import REASONS, Journal, find_wrongly_proven, judge_longer, judge_short, prove, reasons, replay


def run_organization(organization, options, waivers, used):
    """Judges the mutants of an organization, and prints the verdicts. Returns the number of survivors without a reason."""
    start = time.monotonic()
    all_designs = record_designs(organization, options.jobs, options.sample)
    pools = make_pools(all_designs, options.seed)
    counts = mutant_counts(pools, options.count)
    if options.modules:
        pools = selected_modules(pools, options.modules)
    print(f"{organization}: {len(all_designs)} designs recorded in {time.monotonic() - start:.0f} s, {len(pools)} modules with"
          f" {sum(map(len, pools.values()))} possible mutants", flush=True)
    if options.sample:
        pools, counts = sample_mutants(pools, counts, options.sample)
    journal = Journal(all_designs)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        def check(mutant):
            journal.set_verdict("short", mutant, lambda it: judge_short(it, all_designs, options.prove))

        mutants = draw_mutants(pools, counts, pool, check)
        survivors = [mutant for mutant in mutants if mutant.verdict in ("survived", "equivalent")]
        unknown = [mutant for mutant in survivors if mutant.verdict == "survived"]
        if options.sample:
            unknown = replay_in_other_designs(organization, [mutant for mutant in unknown if mutant.key() not in waivers])
        elif options.longer:
            list(pool.map(lambda mutant: journal.set_verdict("long", mutant, lambda it: judge_longer(it, all_designs)), unknown))
            unknown = [mutant for mutant in unknown if mutant.key() not in waivers]
        unknown = [mutant for mutant in unknown if mutant.verdict == "survived"]
        if options.prove:
            if options.longer:
                list(pool.map(lambda mutant: journal.set_verdict("proof", mutant, lambda it: prove(it, all_designs)), unknown))
            control_proofs(mutants, survivors, all_designs, pool)
    # An edit that does not elaborate in another design makes no circuit there, so it is not counted as a mutant.
    mutants, survivors = ([mutant for mutant in group if mutant.verdict != "refused"] for group in (mutants, survivors))
    open_count = waive(survivors, waivers, used, options.verbose)
    if options.table:
        print_table(pools, mutants)
    print_counts(organization, pools, mutants, open_count, time.monotonic() - start)
    return open_count


def sample_mutants(pools, counts, sample):
    """Returns an evenly spread sample of the mutants of a whole run of these designs."""
    whole = [mutant for module in pools for mutant in pools[module][:counts[module]]]
    step = len(whole) / sample
    selected = collections.defaultdict(list)
    for index in range(sample):
        mutant = whole[int((index + 0.5) * step)]
        selected[mutant.place()].append(mutant)
    # A mutant that does not elaborate is replaced by another of its module.
    pools = {module: selected[module] + [m for m in pools[module] if m not in selected[module]] for module in selected}
    return pools, {module: len(selected[module]) for module in selected}


def replay_in_other_designs(organization, unknown):
    """Replays the vectors of designs outside of the sample, only for mutants that survived and that these designs may kill."""
    for mutant in unknown:
        other_designs = [design for design in designs(organization) if not (design.is_in_sample or mutant.design)]
        mutant.verdict = None
        for design in other_designs:
            stage = LONG_STAGE if design.is_late else 0
            design.record(stage)
            if design.has(mutant.module) and replay(mutant, [design], stage):
                break
        mutant.verdict = mutant.verdict or "survived"
    return unknown


def control_proofs(mutants, survivors, all_designs, pool):
    """Runs the negative control of the proofs: a killed mutant of the same module must not be proven equal."""
    proven = {mutant.place(): mutant.proof for mutant in survivors if mutant.proof}
    killed = collections.defaultdict(list)
    for mutant in mutants:
        if mutant.verdict == "killed" and mutant.place() in proven:
            killed[mutant.place()].append(mutant)
    for wrongly_proven in pool.map(lambda place: find_wrongly_proven(killed[place], all_designs, proven[place]), killed):
        if wrongly_proven:
            sys.exit(f"mutation: proven equal is what the vectors tell apart: {wrongly_proven}")


def waive(survivors, waivers, used, verbose):
    """Prints the survivors without a reason. Returns their number."""
    open_count = 0
    for mutant in survivors:
        if mutant.verdict == "survived" and mutant.key() in waivers:
            mutant.verdict = "waived"
            used.add(mutant.key())
        if mutant.verdict == "survived":
            open_count += 1
            print(f"SURVIVES {mutant}")
        elif verbose:
            print(f"{mutant.verdict}{f' ({mutant.proof})' if mutant.proof else ''} {mutant}")
    return open_count


def print_table(pools, mutants):
    print(f"  {'module':28} mutants  killed  equivalent   waived")
    for place in pools:
        verdicts = [mutant.verdict for mutant in mutants if mutant.place() == place]
        print(f"  {place:28} {len(verdicts):7} {verdicts.count('killed'):7} {verdicts.count('equivalent'):11} {verdicts.count('waived'):8}")


def print_counts(organization, pools, mutants, open_count, seconds):
    verdict_counts = collections.Counter(mutant.verdict for mutant in mutants)
    same_netlist_count = sum(1 for mutant in mutants if mutant.verdict == "equivalent" and mutant.proof == "same")
    longer_count = sum(1 for mutant in mutants if mutant.killed_by and mutant.killed_by[0] > 0)
    hang_count, abort_count = (sum(1 for mutant in mutants if mutant.killed_by and mutant.killed_by[2] == outcome) for outcome in ("hang", "abort"))
    print(f"{organization}: {len(mutants)} mutants of {len(pools)} modules: {verdict_counts['killed']} killed ({longer_count} of them by the"
          f" longer vectors, {hang_count} by time, {abort_count} by an abort of Icarus), {verdict_counts['equivalent']} proven equivalent"
          f" ({same_netlist_count} of them by the same netlist), {verdict_counts['waived']} waived with a reason, {open_count} open;"
          f" {seconds:.0f} s", flush=True)


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
    waivers, used = reasons(), set()
    open_count = sum(run_organization(organization, options, waivers, used) for organization in organizations)
    unused = []
    is_whole = list(organizations) == ORGANIZATIONS and (options.seed, options.count) == (1, 320)
    if is_whole and options.prove and not (options.sample or options.modules):
        # Samples take other mutants of the generated modules.
        unused = [key for key in waivers if key not in used and not key[0].startswith("rcm@")]
        for place, old_line, new_line in unused:
            print(f"{REASONS}: no survivor needs this; remove it: {place}\n    - {old_line}\n    + {new_line}")
    sys.exit(1 if open_count or unused else 0)


if __name__ == "__main__":
    main()
