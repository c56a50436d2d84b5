# SPDX-License-Identifier: MIT OR Apache-2.0
"""A core on AXI between the sources, sinks and masters of cocotbext-axi, an independent model of the bus."""

import json
import os
import random
from pathlib import Path

from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, RisingEdge
from cocotbext.axi import AxiLiteBus, AxiLiteMaster, AxiStreamBus, AxiStreamFrame, AxiStreamSink, AxiStreamSource

# The properties of the core, from the runner: frame size, bits, pixels per clock, clocks of a line, registers.
CORE = json.loads(Path(os.environ["FOVEATE_CORE"]).read_text())
# The folder in which each test writes the frames that the array must receive, and the packets that the core sent.
OUT = Path(os.environ["FOVEATE_OUT"])
WIDTH, HEIGHT, BITS, LANES = (CORE[key] for key in ("width", "height", "bits", "lanes"))
WORDS = -(-WIDTH // LANES)
REGISTERS = CORE["registers"]


def pause_pattern(percent, seed):
    """Yields, for each clock, whether there is a pause."""
    generator = random.Random(seed)
    while True:
        yield generator.randrange(100) < percent


class Bench:
    """The core with its clock and everything that is connected to it."""

    def __init__(self, dut, name):
        self.dut = dut
        self.folder = OUT / name
        self.random = random.Random(name)
        self.expected = []  # the frames that the array must receive, after all repairs
        reset = {"reset": dut.aresetn, "reset_active_level": False}
        video = AxiStreamBus.from_prefix(dut, "s_axis_video")
        # A "byte" of the source is a word of the video.
        self.video = AxiStreamSource(video, dut.aclk, byte_lanes=1, **reset)
        self.packets = AxiStreamSink(AxiStreamBus.from_prefix(dut, "m_axis_packets"), dut.aclk, **reset)
        self.registers = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axi"), dut.aclk, **reset)
        Clock(dut.aclk, 10, unit="ns").start()

    async def reset(self):
        """Resets the core. A new run begins."""
        self.dut.aresetn.value = 0
        await ClockCycles(self.dut.aclk, 5)
        self.packets.clear()
        self.video.clear()
        self.expected.clear()
        self.dut.aresetn.value = 1
        await RisingEdge(self.dut.aclk)

    async def write(self, register, value):
        await self.registers.write_dword(REGISTERS[register], value)

    async def read(self, register):
        return await self.registers.read_dword(REGISTERS[register])

    def pace(self, gaps, stalls):
        """Makes source and sink pause at random, in percent of the clocks."""
        self.video.set_pause_generator(pause_pattern(gaps, 1))
        self.packets.set_pause_generator(pause_pattern(stalls, 2))

    def send(self, pixels, first=False):
        """Sends a line of any length; `first` says that it begins a frame."""
        self.send_words(pixel_words(pixels), [first] + [False] * (len(pixel_words(pixels)) - 1))

    def send_words(self, line, starts):
        frame = AxiStreamFrame(tdata=list(line), tuser=[int(start) for start in starts])
        self.video.send_nowait(frame)

    def send_frame(self, frame):
        for y, row in enumerate(frame):
            self.send(row, y == 0)
        self.expected.append(frame)

    async def drain(self):
        """Waits until all pixels have been taken, and no word has left for a while."""
        await self.video.wait()
        quiet = 0
        while quiet < CORE["quiet"]:
            await ClockCycles(self.dut.aclk, 50)
            quiet = 0 if self.dut.m_axis_packets_tvalid.value else quiet + 50

    def write_files(self):
        """Writes the packets that came and the frames that must be seen, for `foveate decode` and `foveate simulate`."""
        frames = self.folder / "frames"
        frames.mkdir(parents=True)
        largest = 2**BITS - 1
        size = 1 if largest < 256 else 2
        for number, frame in enumerate(self.expected):
            pixels = b"".join(pixel.to_bytes(size, "big") for row in frame for pixel in row)
            header = f"P5 {WIDTH} {HEIGHT} {largest}\n".encode()
            (frames / f"{number:04}.pgm").write_bytes(header + pixels)
        packets = b""
        while not self.packets.empty():
            packets += bytes(self.packets.recv_nowait(compact=False).tdata)
        (self.folder / "packets.bin").write_bytes(packets)
        return packets


def pixel_words(pixels):
    """Returns the words of a line, each with its left pixel in the lowest bits."""
    groups = [pixels[start : start + LANES] for start in range(0, len(pixels), LANES)]
    return [sum(pixel << (BITS * place) for place, pixel in enumerate(group)) for group in groups]


def make_frames(count, seed):
    """Makes frames in which a block of noise moves; every third is all noise."""
    generator = random.Random(seed)
    grey = 2**BITS - 1
    tiles = [[generator.randrange(grey) for _ in range(WIDTH // 4 + 1)] for _ in range(HEIGHT // 4 + 1)]
    frames = []
    for number in range(count):
        left, top = number * 5 % (WIDTH - 16), number * 3 % (HEIGHT - 16)

        def pixel(x, y, all_noise=number % 3 == 2, left=left, top=top):
            inside = left <= x < left + 16 and top <= y < top + 16
            return generator.randint(0, grey) if inside or all_noise else tiles[y // 4][x // 4]

        frames.append([[pixel(x, y) for x in range(WIDTH)] for y in range(HEIGHT)])
    return frames


def cut_line(row, count):
    """Cuts a line after some words. Returns its words and the line that the core makes of it, filled with its last pixel."""
    pixels = row[: count * LANES]
    return pixels, pixels + [pixels[-1]] * (len(row) - len(pixels))


def repeat_last_line(frame, lines):
    """Returns the frame that the core makes if only some lines come: it repeats the last one."""
    return frame[:lines] + [frame[lines - 1]] * (len(frame) - lines)
