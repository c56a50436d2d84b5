#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Gives mutated files to every reader of the program and counts how it answers.

    scripts/checks/fuzz.py                       every reader, 500 files each
    scripts/checks/fuzz.py --cases 20000 NAME... some readers, longer
    scripts/checks/fuzz.py --quick               every reader, 6 files each
    scripts/checks/fuzz.py --list                the readers
    scripts/checks/fuzz.py --keep FOLDER         also keeps the files of failed cases there

A case is a valid file with a few mutations, drawn from the seed, the name of the reader and the number of the case, so that
each case can be repeated alone (--seed, --from, --cases 1). The program runs on it as a user would start it, with 4 GiB of
address space and 30 s. An answer is accepted (exit code 0), accepted in part (1: damage is reported, the frames before it are
kept), or refused (2: one line says why). Everything else fails the run: a panic, a signal, a time-out, exhausted memory,
another exit code, a refusal without a message.

FOVEATE         an executable to use instead of the debug build (scripts/checks/foveate.sh)
JOBS            number of parallel cases (default: number of processors)
"""
import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile

from fuzzing.answer import Answer, run_command
from fuzzing.mutate import mutate
from fuzzing.readers import READERS, samples

SOURCES = pathlib.Path(__file__).resolve().parents[2]
DEFAULT_CASES, QUICK_CASES = 500, 6


def run_file(program, bench, reader, data):
    """Returns the answer of a reader to a file."""
    with tempfile.TemporaryDirectory(prefix="foveate-fuzz-") as folder:
        folder = pathlib.Path(folder)
        path = folder / reader.file
        path.write_bytes(data)
        return run_command([program, *reader.command(bench, folder, path)], folder, path if reader.is_piped else None)


def run_case(program, bench, reader, sample, seed, number, keep):
    """Returns the answer to one mutated file. The file is kept if the case fails."""
    data = mutate(sample, f"{seed}:{reader.name}:{number}", reader.is_text)
    answer, messages = run_file(program, bench, reader, data)
    if answer.is_failure and keep:
        keep.mkdir(parents=True, exist_ok=True)
        (keep / f"{reader.name}-{seed}-{number}-{reader.file}").write_bytes(data)
    return answer, messages


def run_reader(pool, program, bench, reader, sample, args):
    """Counts the answers of a reader; prints each failure."""
    answer, messages = run_file(program, bench, reader, sample)
    if answer is not reader.sample_answer:
        # Mutations of a file that is not read correctly would test nothing.
        print(f"  {reader.name}: its sample is {answer.value}, not {reader.sample_answer.value}: {messages}", file=sys.stderr)
        return {**dict.fromkeys(Answer, 0), Answer.FAILED: 1}
    numbers = range(args.first, args.first + args.cases)
    cases = {pool.submit(run_case, program, bench, reader, sample, args.seed, number, args.keep): number for number in numbers}
    counts = dict.fromkeys(Answer, 0)
    for case in concurrent.futures.as_completed(cases):
        answer, messages = case.result()
        counts[answer] += 1
        if answer.is_failure:
            print(f"  {reader.name} case {cases[case]}: {answer.value}: {messages}", file=sys.stderr)
    return counts


def report(rows):
    """Prints a Markdown table of the counts."""
    answers = list(Answer)
    print("| reader | cases | " + " | ".join(answer.value for answer in answers) + " |")
    print("| --- |" + " --- |" * (len(answers) + 1))
    for name, counts in rows:
        numbers = [sum(counts.values()), *(counts[answer] for answer in answers)]
        print(f"| {name} | " + " | ".join(f"{number:,}" for number in numbers) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--cases", type=int, default=DEFAULT_CASES)
    parser.add_argument("--from", dest="first", type=int, default=0, metavar="NUMBER")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    args = parser.parse_args()
    if args.quick:
        args.cases = QUICK_CASES
    known = {reader.name: reader for reader in READERS}
    if args.list:
        print("\n".join(known))
        return 0
    unknown = [name for name in args.names if name not in known]
    if unknown:
        parser.error(f"there is no reader {unknown[0]}; there are {', '.join(known)}")
    readers = [known[name] for name in args.names] or READERS
    program = subprocess.run([SOURCES / "scripts/checks/foveate.sh"], check=True, capture_output=True, text=True).stdout.strip()
    jobs = int(os.environ.get("JOBS", os.cpu_count() or 1))
    rows = []
    with tempfile.TemporaryDirectory(prefix="foveate-fuzz-samples-") as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        bench = pathlib.Path(folder)
        sample_files = samples(program, bench, readers)
        for reader in readers:
            rows.append((reader.name, run_reader(pool, program, bench, reader, sample_files[reader.name], args)))
    total = {answer: sum(counts[answer] for _, counts in rows) for answer in Answer}
    report([*rows, ("all", total)])
    failed = sum(count for answer, count in total.items() if answer.is_failure)
    print(f"fuzz: {sum(total.values())} files of {len(rows)} readers with seed {args.seed}, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
