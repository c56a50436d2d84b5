# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by snippets.sh: runs README.md and the pages of docs as a reader pastes them, each in a new folder."""
import argparse
import concurrent.futures
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from documents import left_out
from documents.given import make_reader_files
from documents.pages import PageError
from documents.readers import ReaderError, read_names
from documents.run import PageRun, check_table, read_pages
from documents.shell import RUNNING

FOVEATE = os.environ["FOVEATE"]
# Yosys counts for these commands, and the pages show the figures of this version.
YOSYS, COUNTED = "Yosys 0.23", ("foveate estimate ", "foveate fit ")


def environment(tools):
    """Returns the environment of a reader's shell: a terminal of 100 columns, no lines of progress, and the programs."""
    programs = os.pathsep.join([str(tools), str(pathlib.Path(sys.executable).parent), os.environ["PATH"]])
    return {**os.environ, "PATH": programs, "COLUMNS": "100", "FOVEATE_PROGRESS": "0"}


def is_compared(has_yosys):
    """Returns whether the output of a command is compared: figures of Yosys only if that version is installed."""
    return lambda command: has_yosys or not command.startswith(COUNTED)


def run_page(page, steps, options, has_yosys):
    """Runs a page in a copy of the folder with the reader's files. Returns the counts and the seconds."""
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        tools, place = pathlib.Path(folder, "tools"), pathlib.Path(folder, "reader")
        tools.mkdir()
        (tools / "foveate").symlink_to(FOVEATE)
        (tools / "nextpnr-ecp5").symlink_to(os.environ["FOVEATE_NEXTPNR_ECP5"])
        shutil.copytree(options.reader_files, place)
        run = PageRun(page, left_out.TABLE, is_compared(has_yosys), options.whole)
        count = run.run(steps, place, environment(tools))
    return f"{page}: {count}  [{time.monotonic() - start:.0f} s]"


def run_pages(steps_of, options):
    """Runs the pages in parallel. Returns the errors."""
    version = subprocess.run(["yosys", "-V"], capture_output=True, text=True, check=True).stdout
    has_yosys = version.startswith(YOSYS)
    if not has_yosys:
        print(f"not compared: what {' and '.join(COUNTED)}print, which is of {YOSYS}, as this is {version.strip()}")
    errors = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = [pool.submit(run_page, page, steps, options, has_yosys) for page, steps in steps_of.items() if steps]
        for run in concurrent.futures.as_completed(runs):
            try:
                print(run.result(), flush=True)
            except PageError as error:
                errors.append(str(error))
    return errors


def stop(number, _):
    """Ends the shells, which are not in the group of this process, and then this process."""
    for shell in list(RUNNING):
        shell.kill()
    os._exit(128 + number)


def main():
    for number in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]:
        signal.signal(number, stop)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="*", help="only these, such as docs/tutorial.md, without the readers of tables")
    parser.add_argument("--whole", action="store_true", help="also the commands that take minutes, but none of those that cannot be run")
    parser.add_argument("--list", action="store_true", help="print what is left out, and why")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("JOBS", os.cpu_count())), help="pages at a time")
    options = parser.parse_args()
    if options.list:
        for page, reason in left_out.PAGES.items():
            print(f"{page}: {reason}")
        for entry in left_out.TABLE:
            print(f"{entry.page}: {entry.text}\n    {'--whole runs it; it takes ' * entry.is_long}{entry.reason}")
        return
    try:
        steps_of = read_pages(".", left_out.PAGES)
        check_table(steps_of, left_out.TABLE, left_out.PAGES)
    except PageError as error:
        sys.exit(str(error))
    if unknown := set(options.pages) - set(steps_of):
        sys.exit(f"snippets: there is no page {', '.join(unknown)}")
    chosen_pages = {page: steps for page, steps in steps_of.items() if not options.pages or page in options.pages}
    with tempfile.TemporaryDirectory() as folder:
        options.reader_files = pathlib.Path(folder)
        make_reader_files(options.reader_files, FOVEATE)
        errors = run_pages(chosen_pages, options)
    if errors:
        sys.exit("\n\n".join(sorted(errors)))
    if not options.pages:
        try:
            read_names(FOVEATE)
        except ReaderError as error:
            sys.exit(str(error))


main()
