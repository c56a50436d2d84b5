# SPDX-License-Identifier: MIT OR Apache-2.0
"""Region events as tables of NumPy, pandas and PyArrow, and clocks as tables of NumPy."""
from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from foveate._extras import require_packages
from foveate._foveate import Outcome, event_columns

if TYPE_CHECKING:
    import pandas
    import pyarrow

#: The events of clocks by their numbers, and the columns of their table.
CLOCK_EVENTS = np.array(["decision", "pixels", "means", "loss"])
CLOCK_COLUMNS = np.dtype([
    ("event", CLOCK_EVENTS.dtype),
    ("frame", np.int64),
    ("region", np.int32),
    ("clock", np.int64),
    ("last_clock", np.int64),
    ("first_word", np.int32),
    ("words", np.int32),
    ("is_last", np.bool_),
    ("is_aborted", np.bool_),
])


@overload
def events(outcomes: Iterable[Outcome], *, only_active: bool = ..., kind: Literal["numpy"] = ...) -> np.ndarray[Any, Any]: ...
@overload
def events(outcomes: Iterable[Outcome], *, only_active: bool = ..., kind: Literal["pandas"]) -> pandas.DataFrame: ...
@overload
def events(outcomes: Iterable[Outcome], *, only_active: bool = ..., kind: Literal["pyarrow"]) -> pyarrow.Table: ...
def events(outcomes: Iterable[Outcome], *, only_active: bool = False, kind: str = "numpy") -> Any:
    """Make the table of region events, one row per region and frame.

    The columns are those of ``events.parquet`` of the command line, with the same values.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Outcomes of ``Camera.step`` or ``simulate``, all of one design. A generator is read to its end.
    only_active : bool, default False
        Keep only the rows of regions that send something: the pixels of an active region, or a summary.
    kind : {"numpy", "pandas", "pyarrow"}
        A structured array, a data frame, or a table of Arrow. Pandas and PyArrow must be installed.

    Returns
    -------
    numpy.ndarray, pandas.DataFrame or pyarrow.Table
        Columns ``frame``, ``t_us`` (int64, microseconds), ``x``, ``y`` (column and row of the region, int32), ``x0``, ``y0``
        (its first pixel), ``srs``, ``trs`` (bool), ``score_<feature>`` (int64), ``t_count`` (changed pixels, int32), with
        the feature ``flow`` also ``dx`` and ``dy`` (its displacement, int32), and ``action`` (``forward``, ``hold``, ``blank`` or
        ``summarize``). Rows are in the order of frame, y, x.

    Raises
    ------
    ValueError
        If there are no outcomes, or if they have different designs.
    """
    if kind not in ("numpy", "pandas", "pyarrow"):
        raise ValueError(f"kind = {kind!r}: expected 'numpy', 'pandas' or 'pyarrow'")
    columns = event_columns(outcomes, only_active)
    codes, texts = columns.pop("action")
    if kind == "pandas":
        require_packages("kind = 'pandas'", ["pandas"], "tables")
        import pandas

        action = pandas.Categorical.from_codes(codes.astype(np.int8), categories=list(texts))
        return pandas.DataFrame({**columns, "action": action})
    if kind == "pyarrow":
        require_packages("kind = 'pyarrow'", ["pyarrow"], "tables")
        import pyarrow

        action = pyarrow.DictionaryArray.from_arrays(codes.astype(np.int8), list(texts))
        return pyarrow.table({**columns, "action": action.dictionary_decode()})
    names = np.array(texts if texts else ("",), dtype="U7")
    dtype = [(name, values.dtype) for name, values in columns.items()] + [("action", "U7")]
    table = np.empty(len(codes), dtype=dtype)
    for name, values in columns.items():
        table[name] = values
    table["action"] = names[codes]
    return table


def clock_rows(numbers: NDArray[np.int64]) -> NDArray[np.void]:
    """Make the table of clocks of the numbers of its columns."""
    table = np.empty(len(numbers), dtype=CLOCK_COLUMNS)
    for name, values in zip(CLOCK_COLUMNS.names or (), numbers.T):
        table[name] = CLOCK_EVENTS[values] if name == "event" else values
    return table
