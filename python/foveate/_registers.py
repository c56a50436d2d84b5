# SPDX-License-Identifier: MIT OR Apache-2.0
"""The registers of a core on AXI, by their names: over whatever reads and writes one, or over a serial line."""
from __future__ import annotations

import difflib
import operator
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from foveate._foveate import Camera, Design
from foveate._line import Line, Port

#: The register of a board around a core, above those of the core: name, lowest bit and width of its fields.
BOARD, BOARD_FIELDS = 0x1000, (("done", 0, 1), ("failed", 1, 1), ("lost", 16, 16))


class RegisterField(NamedTuple):
    """Some bits of a register that say one thing. ``reset`` is None where the core says."""

    name: str
    low: int
    width: int
    access: str
    reset: int | None
    doc: str


class Register(NamedTuple):
    """A register of 32 bits, at its address in bytes."""

    name: str
    address: int
    doc: str
    fields: tuple[RegisterField, ...]


for _tuple, _docs in (
    (RegisterField, {
        "name": "Its name.",
        "low": "Its lowest bit.",
        "width": "How many bits it has.",
        "access": 'What a program may do: "read", "read, write", "write 1" or "read, write 1 to clear".',
        "reset": "Its value after a reset; None where the core says.",
        "doc": "What it says.",
    }),
    (Register, {
        "name": "Its name.",
        "address": "Its address in bytes.",
        "doc": "What it is.",
        "fields": "Its fields, from the lowest bit on: a tuple of RegisterField.",
    }),
):
    for _name, _doc in _docs.items():
        getattr(_tuple, _name).__doc__ = _doc


def table(rows: Iterable[tuple[str, int, str, Iterable[Any]]]) -> tuple[Register, ...]:
    """What the compiled part says of a design."""
    return tuple(Register(name, address, doc, tuple(RegisterField(*field) for field in fields)) for name, address, doc, fields in rows)


class Registers:
    """Drive a core on AXI: ``core["edge_level"] = 120``.

    A name is that of a register, or of a field behind it: ``core["status.busy"]``. A name that is not there is a KeyError that
    says the nearest one, and a value that does not fit a ValueError; nothing is written then. One thread at a time.

    Parameters
    ----------
    design : Camera, Design, preset, file or dict
        The design of the core.
    read : callable
        Takes an address in bytes, below the base of the core, and returns what is read there: ``read`` of PYNQ's ``MMIO``.
    write : callable
        Takes an address and a value: ``write`` of PYNQ's ``MMIO``.

    Raises
    ------
    ValueError
        If the design is not on AXI.
    RuntimeError
        If there is no core, or its registers or its design are others. The message says both values. Nothing is written.
    """

    def __init__(self, design: Any, read: Callable[[int], int], write: Callable[[int, int], object]) -> None:
        self._read, self._write = read, write
        self._line: Line | None = None
        self._names: dict[str, tuple[Register, RegisterField | None]] = {}
        design = design.design if isinstance(design, Camera) else Design(design)
        self._fingerprint = design.fingerprint
        for register in design.registers():
            self._names[register.name] = register, register.fields[0] if len(register.fields) == 1 else None
            self._names.update({f"{register.name}.{field.name}": (register, field) for field in register.fields})
        self._check()

    @classmethod
    def over_serial(cls, design: Any, port: Port, *, timeout: float = 0.3, attempts: int = 3) -> Registers:
        """Drive a core on a board over its serial line.

        Parameters
        ----------
        design : Camera, Design, preset, file or dict
            The design of the core.
        port : object with read(n) and write(bytes)
            ``serial.Serial`` of pyserial, with a ``timeout`` of its own: without one its ``read`` may wait for ever.
        timeout : float, default 0.3
            Seconds to wait for an answer, before the command is sent again.
        attempts : int, default 3
            How often a command is sent, before a TimeoutError.
        """
        line = Line(port, timeout, attempts)
        core = cls(design, line.read, line.write)
        core._line = line
        return core

    def _check(self) -> None:
        """Compares what a core always says with the design, and writes nothing."""
        for name, problem in (("identity", "there is no Foveate core"), ("version", "the core has another map of registers")):
            for _, found, right in self._differing(name):
                raise RuntimeError(f"{problem}: `{name}` reads {found:#x}, not {right:#x}")
        fingerprint = f"{self['fingerprint_high']:08x}{self['fingerprint_low']:08x}"
        if fingerprint != self._fingerprint:
            also = "".join(f"; `{name}` is {own}, not {other}" for name, own, other in self._differing("frame", "grid", "region"))
            raise RuntimeError(f"the core has another design than expected: its fingerprint is {fingerprint}, not {self._fingerprint}{also}")

    def _differing(self, *names: str) -> Iterator[tuple[str, int, int]]:
        """Constant fields of these registers that read otherwise than in this design: name, what is read, and what is right."""
        for name in names:
            register, _ = self._find(name)
            value = int(self._read(register.address))
            for field in register.fields:
                if field.reset is not None and _part(value, field) != field.reset:
                    yield f"{name}.{field.name}", _part(value, field), field.reset

    def _find(self, name: str) -> tuple[Register, RegisterField | None]:
        """A register, and its field if it has one of that name or only one."""
        if name not in self._names:
            near = difflib.get_close_matches(str(name), self._names, 1, 0)
            raise KeyError(f"this core has no register `{name}`; the nearest is `{near[0]}`")
        return self._names[name]

    def __iter__(self) -> Iterator[str]:
        """All names, of registers and of fields."""
        return iter(self._names)

    def __getitem__(self, name: str) -> int:
        register, field = self._find(name)
        value = int(self._read(register.address))
        return value if field is None else _part(value, field)

    def __setitem__(self, name: str, value: int) -> None:
        self._put([self._ready(name, value)])

    def _ready(self, name: str, value: int) -> tuple[int, int, int]:
        """Address of what is to be written, the bits that stay as they are, and the others."""
        register, field = self._find(name)
        meant = [one for one in ([field] if field else register.fields) if one.access != "read"]
        if not meant:
            raise ValueError(f"`{name}` can only be read")
        low, value = field.low if field else 0, operator.index(value)
        width = max(one.low + one.width for one in meant) - low
        if not 0 <= value < 1 << width:
            raise ValueError(f"{name} = {value}: expected 0 to {(1 << width) - 1}")
        # A 1 that is read of an event and written again would clear it.
        others = (one for one in register.fields if field not in (None, one) and one.access == "read, write")
        return register.address, sum(_mask(one) for one in others), value << low

    def _put(self, ready: Iterable[tuple[int, int, int]]) -> None:
        for address, kept, value in ready:
            self._write(address, (int(self._read(address)) & kept if kept else 0) | value)

    def set(self, **values: int) -> None:
        """Write several thresholds that the core takes over together when the next frame begins.

        ``control.enable`` is 0 meanwhile, and set back even if a write fails. So frames that begin in this time are left out: some
        microseconds on a bus, some milliseconds on a serial line. Nothing is left out for one threshold alone.
        """
        ready = [self._ready(name, value) for name, value in values.items()]
        if any(name.split(".")[0] == "control" for name in values):
            raise ValueError("`control` stops the core while others are written; write it by itself")
        if len(ready) < 2:
            return self._put(ready)
        before = self["control"]
        try:
            self["control.enable"] = 0
            self._put(ready)
        finally:
            self["control"] = before

    def events(self) -> list[str]:
        """Names of what has happened since it was cleared."""
        value = self["events"]
        return [field.name for field in self._names["events"][0].fields if _part(value, field)]

    def clear(self, *names: str) -> None:
        """Clear these events: ``core.clear(*core.events())``. Those that came since stay, and without names all do."""
        ready = [self._ready(f"events.{name}", 1) for name in names]
        if ready:
            self._put([(ready[0][0], 0, sum({value for _, _, value in ready}))])

    def counters(self) -> dict[str, int]:
        """Frames that came (modulo 2^32), frames repaired and skipped, and regions dropped (modulo 2^16)."""
        return {name: self[name] for name in ("frames", "repaired", "skipped", "dropped")}

    def restart(self) -> None:
        """Let the core forget its references once no frame is under way. ``status.restarting`` is 1 until then."""
        self["control.restart"] = 1

    def board(self) -> dict[str, int]:
        """What the board around a core on a serial line says: sensor ``done`` and ``failed``, pixels ``lost`` (modulo 2^16)."""
        if self._line is None:
            raise RuntimeError("only a core on a serial line has a board; see Registers.over_serial")
        value = self._line.read(BOARD)
        return {name: value >> low & (1 << width) - 1 for name, low, width in BOARD_FIELDS}

    def received(self) -> bytes:
        """All bytes but answers that came over the serial line while commands waited, once: a part of a recording.

        They stand before what is read from the port next.
        """
        return b"" if self._line is None else self._line.received()


def _mask(field: RegisterField) -> int:
    return (1 << field.width) - 1 << field.low


def _part(value: int, field: RegisterField) -> int:
    return (value & _mask(field)) >> field.low
