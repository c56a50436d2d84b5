# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tables with difficult names, read by the readers that people use."""
import csv
import pathlib
import subprocess
import tempfile

import numpy
import pandas
import pyarrow.csv

from documents.given import make_reader_files

READERS = {
    "csv": lambda path: [row["name"] for row in csv.DictReader(open(path, newline="", encoding="utf-8"))],
    "numpy.genfromtxt": lambda path: list(
        numpy.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")["name"]
    ),
    "pandas": lambda path: list(pandas.read_csv(path)["name"]),
    "pandas, comments": lambda path: list(pandas.read_csv(path, comment="#")["name"]),
    "pyarrow": lambda path: pyarrow.csv.read_csv(path)["name"].to_pylist(),
}


class ReaderError(Exception):
    """The error of a reader that reads other names."""


def read_names(foveate):
    """Checks that every reader reads the same names of frames from a set with difficult names."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        make_reader_files(folder, foveate)
        command = [foveate, "dataset", "-o", "out", "--resize", "64x64", "--quiet"]
        for inputs, count in [(["photos"], 4), (["train-images-idx3-ubyte.gz"], 12)]:
            result = subprocess.run([*command, "--force", *inputs], cwd=folder, capture_output=True, text=True)
            if result.returncode != 0:
                raise ReaderError(f"dataset {inputs} fails:\n{result.stderr}")
            names = {reader: read(folder / "out/frames.csv") for reader, read in READERS.items()}
            for reader, read_by_reader in names.items():
                if read_by_reader != names["csv"] or len(set(read_by_reader)) != count:
                    raise ReaderError(f"{reader} reads {read_by_reader}\nwhere csv reads {names['csv']}")
            print(f"frames.csv of {inputs[0]}: {count} names, the same in {len(names)} readers, the last {names['csv'][-1]}")
