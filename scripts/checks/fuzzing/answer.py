# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs the program on a file, and classifies its exit code and messages."""
import enum
import resource
import subprocess

MEMORY = 4 << 30
SECONDS = 30


class Answer(enum.Enum):
    """The kind of the program's answer to a file."""

    ACCEPTED = "accepted"
    PARTIAL = "in part"
    REFUSED = "refused"
    FAILED = "failed"

    @property
    def is_failure(self):
        """Returns whether no file may get this answer."""
        return self is Answer.FAILED


def limit_memory():
    """Limits the address space of the calling process."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def answer_of(code, messages):
    """Returns the answer of a run from its exit code and its lines on standard error, and the reason of a failure."""
    errors = [line for line in messages.splitlines() if line.startswith("foveate: ") and not line.startswith("foveate: warning: ")]
    if "panicked at" in messages or "memory allocation of" in messages:
        return Answer.FAILED, messages.strip().splitlines()[0]
    if code == 0:
        return Answer.ACCEPTED, ""
    if code not in (1, 2):
        return Answer.FAILED, f"exit code {code}: {messages.strip()[:200]}"
    if not errors:
        return Answer.FAILED, f"exit code {code} without a message: {messages.strip()[:200]}"
    return (Answer.PARTIAL if code == 1 else Answer.REFUSED), errors[0]


def run_command(command, folder, standard_input=None):
    """Runs a command in a folder, with a file or nothing as its input. Returns its answer, and the reason of a failure."""
    source = open(standard_input, "rb") if standard_input else subprocess.DEVNULL
    try:
        run = subprocess.run(command, cwd=folder, stdin=source, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                             timeout=SECONDS, preexec_fn=limit_memory, check=False)
    except subprocess.TimeoutExpired:
        return Answer.FAILED, f"no end within {SECONDS} s"
    finally:
        if standard_input:
            source.close()
    return answer_of(run.returncode, run.stderr.decode("utf-8", "replace"))
