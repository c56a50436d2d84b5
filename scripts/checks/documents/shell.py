# SPDX-License-Identifier: MIT OR Apache-2.0
"""A shell that runs the commands of a page one by one, so that variables and the folder stay."""
import os
import pathlib
import select
import shlex
import signal
import subprocess
import tempfile

# The running shells, which must be ended together with all processes that they have started.
RUNNING = set()


class ShellError(Exception):
    """The error of a command that does not end, or that ends the shell."""


class Shell:
    """A bash in a folder."""

    def __init__(self, folder, environment):
        self.beside = tempfile.TemporaryDirectory()
        self.ended, ended = os.pipe()
        self.said = f" >&{ended}\n"
        self.process = subprocess.Popen(
            ["bash", "--noprofile", "--norc"], stdin=subprocess.PIPE, cwd=folder, env=environment, pass_fds=[ended], start_new_session=True
        )
        os.close(ended)
        RUNNING.add(self)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        RUNNING.discard(self)
        self.kill()
        self.process.stdin.close()
        self.process.wait()
        os.close(self.ended)
        self.beside.cleanup()

    def kill(self):
        """Ends the shell and all processes that it has started."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def run(self, text, seconds):
        """Runs a command. Returns its exit code, and the lines of its standard output and standard error."""
        step, printed = pathlib.Path(self.beside.name, "step"), pathlib.Path(self.beside.name, "printed")
        step.write_text(text + "\n", encoding="utf-8")
        ask = f". {shlex.quote(str(step))} </dev/null >{shlex.quote(str(printed))} 2>&1; echo $?{self.said}"
        self.process.stdin.write(ask.encode())
        self.process.stdin.flush()
        if not select.select([self.ended], [], [], seconds)[0]:
            raise ShellError(f"this has not ended after {seconds} s")
        code = os.read(self.ended, 16)
        if not code.strip():
            raise ShellError("this ends the shell")
        return int(code), printed.read_text(encoding="utf-8", errors="replace").splitlines()
