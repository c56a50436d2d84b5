# SPDX-License-Identifier: MIT OR Apache-2.0
"""The registers of a core on AXI, by their names: over functions that read and write one, or over a serial line."""
from __future__ import annotations

import difflib
import operator
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from foveate._foveate import Camera, Design
from foveate._line import Port, SerialLine

#: The register of a board, above those of its core: name, lowest bit and width of each field.
BOARD, BOARD_FIELDS = 0x1000, (("done", 0, 1), ("failed", 1, 1), ("lost", 16, 16))


class RegisterField(NamedTuple):
    """A field of a register: adjacent bits with one meaning. ``reset`` is None if it depends on the state of the core."""

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
        "name": "Name.",
        "low": "Lowest bit.",
        "width": "Number of bits.",
        "access": 'Access of a program: "read", "read, write", "write 1" or "read, write 1 to clear".',
        "reset": "Value after a reset; None if it depends on the state of the core.",
        "doc": "Meaning.",
    }),
    (Register, {
        "name": "Name.",
        "address": "Address in bytes.",
        "doc": "Purpose.",
        "fields": "Fields, from the lowest bit on: a tuple of RegisterField.",
    }),
):
    for _name, _doc in _docs.items():
        getattr(_tuple, _name).__doc__ = _doc


def table(rows: Iterable[tuple[str, int, str, Iterable[Any]]]) -> tuple[Register, ...]:
    """Return the registers of a design from the table of the compiled part."""
    return tuple(Register(name, address, doc, tuple(RegisterField(*field) for field in fields)) for name, address, doc, fields in rows)


class Registers:
    """Drive a core on AXI: ``core["edge_level"] = 120``.

    A name is that of a register, or of a register and a field: ``core["status.busy"]``. An unknown name raises a KeyError with
    the nearest known name, and a value that does not fit raises a ValueError; nothing is written then. Only one thread may use
    an object at a time.

    Parameters
    ----------
    design : Camera, Design, preset, file or dict
        The design of the core.
    read : callable
        Takes an address in bytes, relative to the base of the core, and returns the value there, such as ``read`` of PYNQ's ``MMIO``.
    write : callable
        Takes an address and a value, and writes it, such as ``write`` of PYNQ's ``MMIO``.

    Raises
    ------
    ValueError
        If the design is not on AXI.
    RuntimeError
        If there is no core, or the core has other registers or another design. The message has both values. Nothing is written.
    """

    def __init__(self, design: Any, read: Callable[[int], int], write: Callable[[int, int], object]) -> None:
        self._read, self._write = read, write
        self._line: SerialLine | None = None
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
            pyserial's ``serial.Serial`` with its own ``timeout``: without one its ``read`` may wait for ever.
        timeout : float, default 0.3
            Seconds to wait for an answer, before the command is sent again.
        attempts : int, default 3
            Number of times that a command is sent before a TimeoutError is raised.
        """
        line = SerialLine(port, timeout, attempts)
        core = cls(design, line.read, line.write)
        core._line = line
        return core

    def _check(self) -> None:
        """Compare the constant registers of the core with the design, without writing one."""
        for name, problem in (("identity", "there is no Foveate core"), ("version", "the core has another map of registers")):
            for _, value, expected in self._differences(name):
                raise RuntimeError(f"{problem}: `{name}` reads {value:#x}, not {expected:#x}")
        fingerprint = f"{self['fingerprint_high']:08x}{self['fingerprint_low']:08x}"
        if fingerprint != self._fingerprint:
            details = "".join(f"; `{name}` is {value}, not {expected}" for name, value, expected in self._differences("frame", "grid", "region"))
            raise RuntimeError(f"the core has another design than expected: its fingerprint is {fingerprint}, not {self._fingerprint}{details}")

    def _differences(self, *names: str) -> Iterator[tuple[str, int, int]]:
        """Yield the constant fields of these registers that differ from the design: name, value read, and right value."""
        for name in names:
            register, _ = self._find(name)
            value = int(self._read(register.address))
            for field in register.fields:
                if field.reset is not None and _field_value(value, field) != field.reset:
                    yield f"{name}.{field.name}", _field_value(value, field), field.reset

    def _find(self, name: str) -> tuple[Register, RegisterField | None]:
        """Return a register, and the field of that name or its only field."""
        if name not in self._names:
            nearest = difflib.get_close_matches(str(name), self._names, 1, 0)
            raise KeyError(f"this core has no register `{name}`; the nearest is `{nearest[0]}`")
        return self._names[name]

    def __iter__(self) -> Iterator[str]:
        """Return the names of all registers and fields."""
        return iter(self._names)

    def __getitem__(self, name: str) -> int:
        register, field = self._find(name)
        value = int(self._read(register.address))
        return value if field is None else _field_value(value, field)

    def __setitem__(self, name: str, value: int) -> None:
        self._write_all([self._prepare_write(name, value)])

    def _prepare_write(self, name: str, value: int) -> tuple[int, int, int]:
        """Return the address of a write, a mask of the bits that are kept, and the value of the other bits."""
        register, field = self._find(name)
        writable_fields = [written for written in ([field] if field else register.fields) if written.access != "read"]
        if not writable_fields:
            raise ValueError(f"`{name}` can only be read")
        low, value = field.low if field else 0, operator.index(value)
        width = max(written.low + written.width for written in writable_fields) - low
        if not 0 <= value < 1 << width:
            raise ValueError(f"{name} = {value}: expected 0 to {(1 << width) - 1}")
        # Only fields that keep their value are written back: an event that reads as 1 would be cleared by a written 1.
        kept_fields = (other for other in register.fields if field not in (None, other) and other.access == "read, write")
        return register.address, sum(_field_mask(other) for other in kept_fields), value << low

    def _write_all(self, writes: Iterable[tuple[int, int, int]]) -> None:
        for address, kept_bits, value in writes:
            self._write(address, (int(self._read(address)) & kept_bits if kept_bits else 0) | value)

    def set(self, **values: int) -> None:
        """Write several thresholds that the core takes over together when the next frame begins.

        ``control.enable`` is 0 meanwhile, and is restored even if a write fails. So frames that begin in this time are left out: some
        microseconds on a bus, some milliseconds on a serial line. For a single threshold no frame is left out.
        """
        writes = [self._prepare_write(name, value) for name, value in values.items()]
        if any(name.split(".")[0] == "control" for name in values):
            raise ValueError("`control` stops the core while others are written; write it by itself")
        if len(writes) < 2:
            return self._write_all(writes)
        control = self["control"]
        try:
            self["control.enable"] = 0
            self._write_all(writes)
        finally:
            self["control"] = control

    def events(self) -> list[str]:
        """Return the names of the events that have happened since they were cleared."""
        value = self["events"]
        return [field.name for field in self._names["events"][0].fields if _field_value(value, field)]

    def clear(self, *names: str) -> None:
        """Clear these events: ``core.clear(*core.events())``. Other events stay; without names all events stay."""
        writes = [self._prepare_write(f"events.{name}", 1) for name in names]
        if writes:
            self._write_all([(writes[0][0], 0, sum({value for _, _, value in writes}))])

    def counters(self) -> dict[str, int]:
        """Return the counters: frames that came (modulo 2^32), repaired and skipped frames, and dropped regions (modulo 2^16)."""
        return {name: self[name] for name in ("frames", "repaired", "skipped", "dropped")}

    def restart(self) -> None:
        """Make all references of the core invalid as soon as no frame is under way. ``status.restarting`` is 1 until then."""
        self["control.restart"] = 1

    def board(self) -> dict[str, int]:
        """Return the state of the board of a core on a serial line: sensor ``done`` and ``failed``, pixels ``lost`` (modulo 2^16)."""
        if self._line is None:
            raise RuntimeError("only a core on a serial line has a board; see Registers.over_serial")
        value = self._line.read(BOARD)
        return {name: value >> low & (1 << width) - 1 for name, low, width in BOARD_FIELDS}

    def received(self) -> bytes:
        """Return the bytes other than answers that came over the serial line while commands waited. Each byte is returned once.

        They are part of a recording, and come before the bytes that are read from the port next.
        """
        return b"" if self._line is None else self._line.received()


def _field_mask(field: RegisterField) -> int:
    return (1 << field.width) - 1 << field.low


def _field_value(value: int, field: RegisterField) -> int:
    return (value & _field_mask(field)) >> field.low
