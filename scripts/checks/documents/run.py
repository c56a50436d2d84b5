# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs pages."""
import dataclasses
import pathlib
import shlex

from documents import compare, pages
from documents.pages import PageError
from documents.shell import Shell, ShellError

# A command that takes longer hangs, or must be in the table. Long commands of the table have an hour.
SECONDS, LONG_SECONDS = 300, 3600


@dataclasses.dataclass(frozen=True)
class LeftOut:
    """An entry for a step of a page that is not run, by the beginning of its text; with `is_long` the step is run with --whole."""

    page: str
    text: str
    reason: str
    is_long: bool = False


@dataclasses.dataclass
class Count:
    """The counts of a page after its run."""

    commands: int = 0
    outputs: int = 0
    blocks: int = 0
    left_out: int = 0

    def __str__(self):
        counts = [("commands", self.commands), ("outputs compared", self.outputs), ("Python", self.blocks), ("left out", self.left_out)]
        return ", ".join(f"{name} {count}" for name, count in counts if count) or "nothing"


def entry_of(page, step, table):
    """Returns the entry of the table for a step, or None."""
    return next((entry for entry in table if entry.page == page and step.text.startswith(entry.text)), None)


def check_table(steps_of, table, pages_left_out):
    """Refuses entries of the table without a step."""
    for page in pages_left_out:
        if page not in steps_of:
            raise PageError(page, 0, "there is no such page, but a reason to leave it out; remove that reason")
    for entry in table:
        steps = steps_of.get(entry.page, [])
        if entry.page in pages_left_out or not any(entry_of(entry.page, step, [entry]) for step in steps):
            raise PageError(entry.page, 0, f"nothing begins with `{entry.text}` there, but it is left out; remove it from the table")


class PageRun:
    """The run of a page in a folder."""

    def __init__(self, page, table, is_compared=lambda command: True, whole=False):
        self.page, self.table, self.is_compared, self.whole = page, table, is_compared, whole
        self.count = Count()

    def run(self, steps, folder, environment):
        with Shell(folder, environment) as shell:
            for step in steps:
                entry = entry_of(self.page, step, self.table)
                if entry is not None and not (self.whole and entry.is_long):
                    self.count.left_out += 1
                    continue
                self.step(shell, step, LONG_SECONDS if entry is not None else SECONDS)
        return self.count

    def step(self, shell, step, seconds):
        if step.kind == "text":
            raise PageError(self.page, step.line, "no command stands before this block of text; show one, or leave it out by the table")
        text = step.text if step.kind == "command" else f"python -W error -c {shlex.quote(step.text)}"
        try:
            code, printed = shell.run(text, seconds)
        except ShellError as error:
            raise PageError(self.page, step.line, f"{error}:\n{step.text}") from None
        self.check_result(step, code, printed)
        if step.kind == "python":
            self.count.blocks += 1
        else:
            self.count.commands += 1

    def check_result(self, step, code, printed):
        start, expected = step.expected or (step.line, [])
        fails = compare.is_refusal(expected)
        if (code != 0) != fails:
            outcome = "is shown to fail, but ends with exit code 0" if fails else f"fails with exit code {code}"
            raise PageError(self.page, step.line, f"this {outcome}:\n{step.text}\n" + "\n".join(printed))
        if step.expected is None or not self.is_compared(step.text):
            return
        difference = compare.difference(expected, printed)
        if difference is not None:
            line, message = difference
            place, shown = (start + line, f"`{expected[line]}`") if expected else (step.line, "nothing")
            everything = "\n".join(printed)
            raise PageError(self.page, place, f"{shown} is shown, but the command {message}\n{step.text}\nprints\n{everything}")
        self.count.outputs += 1


def read_pages(folder, pages_left_out):
    """Returns the steps of README.md and of all pages of docs, by their names."""
    folder = pathlib.Path(folder)
    names = ["README.md", *sorted(str(page.relative_to(folder)) for page in (folder / "docs").rglob("*.md"))]
    text = {name: (folder / name).read_text(encoding="utf-8") for name in names}
    return {name: [] if name in pages_left_out else pages.steps(name, text[name]) for name in names}
