# SPDX-License-Identifier: MIT OR Apache-2.0
"""The spatial features, as `foveate features` lists them, for scripts that try each of them.

    features.py ORGANIZATION [KEY=VALUE]...    prints the value of the key `spatial` with all features of an organization,
                                               each with these keys, if they apply to it

FOVEATE   an executable to use instead of the debug build (scripts/checks/foveate.sh)
"""
import functools
import json
import os
import pathlib
import subprocess
import sys


@functools.cache
def listing():
    """Returns all features: names, units, defaults and organizations."""
    script = pathlib.Path(__file__).with_name("foveate.sh")
    program = os.environ.get("FOVEATE") or subprocess.run([script], check=True, capture_output=True, text=True).stdout.strip()
    command = [program, "features", "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["features"]


def names(organization):
    """Returns the names of the features of an organization."""
    return [one["feature"] for one in listing() if organization in one["organizations"]]


def entry(name, **keys):
    """Returns a feature as an entry of `spatial`, with those of the keys that apply to it."""
    known = next(one for one in listing() if one["feature"] == name)
    applied = "".join(f",{key}={value}" for key, value in keys.items() if key in known)
    return f"{{feature='{name}'{applied}}}"


def entries(organization, **keys):
    """Returns all features of an organization as entries of `spatial`."""
    return ",".join(entry(name, **keys) for name in names(organization))


if __name__ == "__main__":
    print(f"[{entries(sys.argv[1], **dict(word.split('=') for word in sys.argv[2:]))}]")
