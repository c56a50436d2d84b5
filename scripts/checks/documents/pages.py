# SPDX-License-Identifier: MIT OR Apache-2.0
"""A page as steps: its commands with their output, its blocks of Python, and blocks of text that belong to no command."""
import dataclasses
import re
import subprocess

# The languages of blocks of commands, and of blocks that are files and are not run.
SHELLS = ["sh", "bash"]
FILES = ["c", "toml", "yaml"]
ITEM = re.compile(r" *([*-]|\d+\.) ")


class PageError(Exception):
    """An error of a page that cannot be read or is wrong. The message names page and line."""

    def __init__(self, page, line, message):
        super().__init__(f"{page}:{line}: {message}")


@dataclasses.dataclass
class Step:
    """A command, a block of Python ("python"), or a block of text without a command ("text")."""

    line: int
    kind: str
    text: str
    # The line number in the page and the lines themselves; None if the page shows no output.
    expected: tuple[int, list[str]] | None = None


def is_whole(command):
    """Returns whether a command is complete, so that a shell would not wait for the end of a loop, a quote or a line."""
    if command.rstrip("\n").endswith("\\"):
        return False
    return subprocess.run(["bash", "-n"], input=command, capture_output=True, text=True, check=False).returncode == 0


def commands(lines):
    """Yields the commands of a block of (number, line), each with all its lines. An incomplete last command fails when it is run."""
    command, start = "", 0
    for number, line in lines:
        start = start if command else number
        command += line + "\n"
        if not command.strip() or is_whole(command):
            if any(part.strip() and not part.strip().startswith("#") for part in command.splitlines()):
                yield Step(start, "command", command.strip())
            command = ""
    if command:
        yield Step(start, "command", command.strip())


def session(start, lines):
    """Returns the steps of a block of text: lines that start with `$ ` are commands, other lines are their output."""
    steps, number = [], 0
    while number < len(lines):
        line, command = start + number, lines[number].removeprefix("$ ")
        while not is_whole(command + "\n") and number + 1 < len(lines):
            number += 1
            command += "\n" + lines[number]
        steps += commands([(line, command)])
        number += 1
        printed = []
        while number < len(lines) and not lines[number].startswith("$ "):
            printed.append(lines[number])
            number += 1
        steps[-1].expected = (start + number - len(printed), printed)
    return steps


class Reader:
    """Reads a page line by line."""

    def __init__(self, page):
        self.page, self.steps = page, []
        # The block, in ``` or of indented lines, that is read now.
        self.language, self.start, self.fenced = None, 0, []
        self.code = []
        # A list, whose paragraphs are indented, is open; the line before; a block of commands has just ended.
        self.in_list, self.before, self.follows = False, "", False

    def read(self, text):
        for number, line in enumerate(text.splitlines(), 1):
            self.take(number, line)
        self.end_code()
        if self.language is not None:
            raise PageError(self.page, self.start - 1, "this block has no end")
        return self.steps

    def take(self, number, line):
        if self.language is not None:
            self.take_fenced(line)
        elif line.startswith("```"):
            self.end_code()
            self.language, self.start, self.fenced = line[3:].split()[0] if line[3:].split() else "", number + 1, []
        elif line.startswith("    ") and not self.in_list and (self.code or not self.before.strip() or self.before.startswith("#")):
            self.code.append((number, line[4:]))
        elif line.strip():
            self.end_code()
            self.follows = False
            # A list ends at a line that is neither an item nor indented.
            self.in_list = bool(ITEM.match(line)) or (self.in_list and line.startswith(" "))
        elif self.code:
            self.code.append((number, ""))
        self.before = line

    def end_code(self):
        if self.code:
            self.steps += commands(self.code)
            self.code, self.follows = [], True

    def take_fenced(self, line):
        if not line.startswith("```"):
            self.fenced.append(line)
            return
        language, lines, follows = self.language, self.fenced, self.follows
        self.language, self.follows = None, False
        if language in SHELLS:
            self.steps += commands(list(enumerate(lines, self.start)))
            self.follows = True
        elif language == "python":
            self.steps.append(Step(self.start, "python", "\n".join(lines) + "\n"))
            self.follows = True
        elif language == "text" and lines and lines[0].startswith("$ "):
            self.steps += session(self.start, lines)
        elif language == "text" and follows:
            self.steps[-1].expected = (self.start, lines)
        elif language == "text":
            self.steps.append(Step(self.start, "text", "\n".join(lines)))
        elif language not in FILES:
            known = ", ".join(["python", "text", *SHELLS, *FILES])
            raise PageError(self.page, self.start - 1, f"a block of `{language}` is of no kind that is known; there are {known}")


def steps(page, text):
    """Returns the steps of a page in order."""
    return Reader(page).read(text)
