# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of docs/axi.md with cocotbext-axi. The runner decodes the packets of each test, and compares the screen of a receiver
with that of `simulate` for the frames that each test expects."""

import cocotb
from bench import HEIGHT, LANES, REGISTERS, WIDTH, WORDS, Bench, cut_line, make_frames, pixel_words, repeat_last_line
from cocotb.triggers import ClockCycles, Combine

ENABLE, WAIT, RESTART = 1, 2, 4
EOL_EARLY, EOL_LATE, SOF_EARLY, SOF_LATE, SKIPPED, REGION, ROW, DONE = (1 << bit for bit in range(8))


async def start_bench(dut, name, gaps=40, stalls=0):
    """Returns a core that was reset and is set up so that its source waits."""
    bench = Bench(dut, name)
    await bench.reset()
    await bench.write("control", ENABLE | WAIT)
    bench.pace(gaps, stalls)
    return bench


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def clean_video(dut):
    """With pauses on both sides, no pixel or packet is lost."""
    bench = await start_bench(dut, "clean_video", gaps=50, stalls=15)
    for frame in make_frames(5, 1):
        bench.send_frame(frame)
    await bench.drain()
    assert await bench.read("frames") == 5
    assert await bench.read("events") == DONE
    bench.write_files()


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def damaged_video(dut):
    """Every kind of damage is repaired, each before a whole frame."""
    bench = await start_bench(dut, "damaged_video", gaps=60)
    frames = iter(make_frames(16, 2))

    # Lines that are too short.
    frame = [list(row) for row in next(frames)]
    for y, row in enumerate(frame):
        sent_pixels, frame[y] = cut_line(row, (y * 7) % (WORDS - 1) + 1) if y % 5 == 0 else (row, row)
        bench.send(sent_pixels, y == 0)
    bench.expected.append(frame)
    bench.send_frame(next(frames))

    # Lines that are too long, the last line among them.
    frame = next(frames)
    for y, row in enumerate(frame):
        bench.send(row + [1] * (LANES * (y % 4)) if WIDTH % LANES == 0 else row, y == 0)
    bench.expected.append(frame)
    bench.send_frame(next(frames))

    # A frame that ends between two lines.
    frame = repeat_last_line(next(frames), HEIGHT // 2)
    for y, row in enumerate(frame[: HEIGHT // 2]):
        bench.send(row, y == 0)
    bench.expected.append(frame)
    bench.send_frame(next(frames))

    # A frame that ends within a line: the start of the next frame comes without an end of that line.
    frame, following = next(frames), next(frames)
    for y, row in enumerate(frame[:3]):
        bench.send(row, y == 0)
    sent_pixels, last = cut_line(frame[3], WORDS // 3)
    line, start = pixel_words(sent_pixels), pixel_words(following[0])
    bench.send_words(line + start, [False] * len(line) + [True] + [False] * (len(start) - 1))
    for row in following[1:]:
        bench.send(row)
    bench.expected += [repeat_last_line(frame[:3] + [last] + frame[4:], 4), following]

    # Words after a whole frame, and a frame without a start.
    bench.send_frame(next(frames))
    bench.send(next(frames)[0])
    bench.send_frame(next(frames))
    for row in next(frames):
        bench.send(row)
    bench.send_frame(next(frames))

    await bench.drain()
    repaired = 4 if WIDTH % LANES == 0 else 3
    assert await bench.read("repaired") == repaired
    eol_late = EOL_LATE if WIDTH % LANES == 0 else 0
    assert await bench.read("events") == EOL_EARLY | eol_late | SOF_EARLY | SOF_LATE | DONE
    assert await bench.read("skipped") == 0
    bench.write_files()


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def sink_that_stops(dut):
    """A sink takes no word for several frames: with `wait` the source waits, and all packets are whole."""
    bench = await start_bench(dut, "sink_that_stops", gaps=20)
    frames = make_frames(6, 3)
    for frame in frames:
        bench.send_frame(frame)
    for _ in range(3):
        await ClockCycles(dut.aclk, WORDS * HEIGHT)
        bench.packets.pause = True
        bench.packets.clear_pause_generator()
        await ClockCycles(dut.aclk, 2 * WORDS * HEIGHT)
        bench.packets.pause = False
    await bench.drain()
    assert await bench.read("skipped") == 0
    assert await bench.read("frames") == len(frames)
    assert bool(await bench.read("dropped")) == bool(await bench.read("events") & REGION)
    bench.write_files()


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def register_storm(dut):
    """Reads and writes of single bytes and incoming video do not disturb each other."""
    bench = await start_bench(dut, "register_storm", gaps=40)
    for frame in make_frames(3, 4):
        bench.send_frame(frame)

    async def reads():
        for _ in range(300):
            assert await bench.registers.read(REGISTERS["identity"], 4) is not None
            assert await bench.read("identity") == int.from_bytes(b"FOVE", "little")

    async def writes():
        address = REGISTERS["interrupt_enable"]
        for number in range(300):
            await bench.registers.write(address + number % 4, bytes([number % 256]))
        await bench.write("interrupt_enable", 0xA5)
        # A write to the other bytes of the register does not touch the events.
        await bench.registers.write(address + 1, bytes([0x5A] * 3))

    await Combine(cocotb.start_soon(reads()), cocotb.start_soon(writes()))
    assert await bench.read("interrupt_enable") == 0xA5
    await bench.drain()
    assert await bench.read("events") == DONE
    assert dut.interrupt_o.value == 1
    await bench.write("events", DONE)
    assert await bench.read("events") == 0
    assert dut.interrupt_o.value == 0
    await bench.write("interrupt_test", REGION | DONE)
    assert await bench.read("events") == REGION | DONE
    bench.write_files()


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def reset_in_the_middle(dut):
    """After a reset while pixels come and packets leave, the core behaves as at the start."""
    bench = await start_bench(dut, "reset_in_the_middle", gaps=0, stalls=60)
    for frame in make_frames(3, 5):
        bench.send_frame(frame)
    await ClockCycles(dut.aclk, 2 * WORDS * HEIGHT + 331)
    await bench.reset()
    await bench.write("control", ENABLE | WAIT)
    bench.pace(40, 0)
    for frame in make_frames(3, 6):
        bench.send_frame(frame)
    await bench.drain()
    assert await bench.read("frames") == 3
    assert await bench.read("dropped") == 0
    bench.write_files()


@cocotb.test(timeout_time=5, timeout_unit="ms")
async def not_enabled(dut):
    """Frames that come while `enable` is 0 are left out, and `restart` clears what was known of earlier frames."""
    bench = await start_bench(dut, "not_enabled")
    frames = make_frames(5, 7)
    bench.send_frame(frames[0])
    await bench.drain()
    bench.packets.clear()
    bench.expected.clear()
    await bench.write("control", WAIT)
    for y, row in enumerate(frames[1]):
        bench.send(row, y == 0)
    await bench.video.wait()
    await ClockCycles(dut.aclk, 20)
    await bench.write("control", ENABLE | WAIT | RESTART)
    for frame in frames[2:]:
        bench.send_frame(frame)
    await bench.drain()
    assert await bench.read("skipped") == 0
    assert await bench.read("frames") == 5
    bench.write_files()
