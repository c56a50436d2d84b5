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
        # The text of each command and its output are files in this folder. The exit code comes through a pipe, whose end tells that the shell ended.
        self.files_folder = tempfile.TemporaryDirectory()
        self.exit_code_pipe, pipe_input = os.pipe()
        self.report_exit_code = f" >&{pipe_input}\n"
        self.process = subprocess.Popen(
            ["bash", "--noprofile", "--norc"], stdin=subprocess.PIPE, cwd=folder, env=environment, pass_fds=[pipe_input], start_new_session=True
        )
        os.close(pipe_input)
        RUNNING.add(self)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        RUNNING.discard(self)
        self.kill()
        self.process.stdin.close()
        self.process.wait()
        os.close(self.exit_code_pipe)
        self.files_folder.cleanup()

    def kill(self):
        """Ends the shell and all processes that it has started."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def run(self, text, seconds):
        """Runs a command. Returns its exit code, and the lines of its standard output and standard error."""
        step, printed = pathlib.Path(self.files_folder.name, "step"), pathlib.Path(self.files_folder.name, "printed")
        step.write_text(text + "\n", encoding="utf-8")
        command = f". {shlex.quote(str(step))} </dev/null >{shlex.quote(str(printed))} 2>&1; echo $?{self.report_exit_code}"
        self.process.stdin.write(command.encode())
        self.process.stdin.flush()
        if not select.select([self.exit_code_pipe], [], [], seconds)[0]:
            raise ShellError(f"this has not ended after {seconds} s")
        code = os.read(self.exit_code_pipe, 16)
        if not code.strip():
            raise ShellError("this ends the shell")
        return int(code), printed.read_text(encoding="utf-8", errors="replace").splitlines()
