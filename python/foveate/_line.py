# SPDX-License-Identifier: MIT OR Apache-2.0
"""A serial line to a board: sends commands, and finds the answers among the received packets."""
from __future__ import annotations

import struct
import time
import zlib
from typing import Any, Protocol

#: Address of a register whose value is constant in every core.
IDENTITY = 0
#: Number of bytes of the head of a packet, and of a whole REGISTER packet.
HEAD_BYTES, PACKET_BYTES = 8, 24


class Port(Protocol):
    """The methods of pyserial's ``serial.Serial`` that are used here; other objects may have them."""

    def read(self, size: int, /) -> bytes | None:
        """Return up to ``size`` bytes; fewer after a timeout."""

    def write(self, data: bytes, /) -> Any:
        """Send all bytes."""


def register_packet(address: int, value: int, is_written: bool) -> bytes:
    """Return a REGISTER packet: head, payload and tail."""
    body = struct.pack("<BBHHHIII", 0xFA, 6 | is_written << 4, PACKET_BYTES // 8, address, 0, value, 0, 0)
    return body + struct.pack("<I", zlib.crc32(body))


class SerialLine:
    """Reads and writes registers over a port, and keeps all other received bytes."""

    def __init__(self, port: Port, timeout: float, attempts: int) -> None:
        self._port, self._timeout, self._attempts = port, timeout, attempts
        self._bytes = bytearray()
        #: True after a command was sent again, because a second answer to it may still come.
        self._may_have_old_answer = False

    def read(self, address: int) -> int:
        """Return the value of a register."""
        return self._run_command(address, 0, False)

    def write(self, address: int, value: int) -> None:
        """Write a register."""
        self._run_command(address, value, True)

    def received(self) -> bytes:
        """Return the bytes of other packets since the last call."""
        other_packets = bytes(self._bytes)
        self._bytes.clear()
        return other_packets

    def _run_command(self, address: int, value: int, is_written: bool) -> int:
        if self._may_have_old_answer and address != IDENTITY:
            # Answers come in the order of commands, so no old answer can follow this one and be mistaken for the next.
            self._run_command(IDENTITY, 0, False)
            self._may_have_old_answer = False
        command, start = register_packet(address, value, is_written), len(self._bytes)
        for attempt in range(self._attempts):
            self._may_have_old_answer |= attempt > 0
            self._port.write(command)
            deadline = time.monotonic() + self._timeout
            while True:
                self._receive()
                answer, start = self._take_answer(command, start)
                # An answer with another value belongs to an older command.
                if answer is not None and (answer == value or not is_written):
                    return answer
                if answer is None and time.monotonic() > deadline:
                    break
        self._may_have_old_answer = True
        action = f"write {value:#x} to" if is_written else "read"
        raise TimeoutError(
            f"the board did not answer: it was asked {self._attempts} times to {action} register {address:#x}, and had {self._timeout} s "
            "each time; check the port and its rate, and that the board is configured"
        )

    def _receive(self) -> None:
        """Take the bytes that have come."""
        # A port that is asked for more bytes than have come would wait for them.
        received = self._port.read(max(1, getattr(self._port, "in_waiting", 1)))
        if received:
            self._bytes += received
        else:
            time.sleep(0.001)

    def _take_answer(self, command: bytes, start: int) -> tuple[int | None, int]:
        """Remove the first answer from a position on. Return its value, and the position at which to search next."""
        address, is_written = struct.unpack_from("<H", command, 4)[0], command[1] >> 4 == 1
        while (position := self._bytes.find(command[:HEAD_BYTES], start)) >= 0:
            answer = bytes(self._bytes[position : position + PACKET_BYTES])
            if len(answer) < PACKET_BYTES:
                return None, position
            (value,) = struct.unpack_from("<I", answer, HEAD_BYTES)
            if answer == register_packet(address, value, is_written):
                del self._bytes[position : position + PACKET_BYTES]
                return value, position
            start = position + 1
        return None, max(start, len(self._bytes) - HEAD_BYTES + 1)
