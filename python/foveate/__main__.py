# SPDX-License-Identifier: MIT OR Apache-2.0
"""The command ``foveate``, which is part of the package: ``python -m foveate simulate ...``."""
import signal
import sys

from foveate._foveate import main as _main


def main() -> None:
    """Run the command with the words of this process, and exit with its code."""
    # The command handles signals itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_main(["foveate", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
