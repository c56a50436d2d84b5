# SPDX-License-Identifier: MIT OR Apache-2.0
"""Packages that only a part of ``foveate`` needs, and the error if one is missing."""
from __future__ import annotations

from importlib.util import find_spec


def missing_package_error(user: str, package: str, extra: str) -> ImportError:
    """Return the error of a part that lacks a package: one line that says what to install."""
    name = {"PIL": "pillow"}.get(package, package)
    return ImportError(f"{user} needs {name}, which is not installed: pip install {name}, or in a clone of the sources "
                       f"pip install '.[{extra}]'", name=package)


def require_packages(user: str, packages: list[str], extra: str) -> None:
    """Raise an error if a package is missing, before any work begins. Imports none of the packages."""
    for package in packages:
        if find_spec(package) is None:
            raise missing_package_error(user, package, extra)
