# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the driver of a core on AXI, over a register file and a serial line that are written here from docs/axi.md, docs/packets.md,
docs/boards.md and a core's REGISTERS.md."""
import re
import struct
import zlib

import numpy as np
import pytest
import tomllib

import foveate as fv

SETTINGS = {"hardware": {"interface": "axi"}, "frame": {"width": 64, "height": 40}}


@pytest.fixture(scope="module")
def design():
    return fv.Design("raster", **SETTINGS)


@pytest.fixture(scope="module")
def page(design, tmp_path_factory):
    """Returns address, name, doc and fields of each register in REGISTERS.md."""
    folder = tmp_path_factory.mktemp("core") / "core"
    design.generate(folder)
    registers = []
    for line in (folder / "REGISTERS.md").read_text().splitlines():
        if not (row := re.fullmatch(r"\| (.*) \| (.*) \| \[(\d+):(\d+)\] \| `(\w+)` \| (.*) \| (.*) \| (.*) \|", line)):
            continue
        address, name, high, low, field, access, reset, doc = row.groups()
        if address.strip():
            registers.append((int(address, 16), name.strip("`"), []))
        width, reset = int(high) - int(low) + 1, int(reset, 16) if reset.strip() else None
        registers[-1][2].append((field, int(low), width, access, reset, doc))
    return registers


class Core:
    """A register file by docs/axi.md."""

    def __init__(self, page):
        self.reset = {address: sum((field[4] or 0) << field[1] for field in fields) for address, _, fields in page}
        self.at = {name: address for address, name, _ in page}
        self.values = dict(self.reset)
        #: The commands, all writes, and the thresholds of each frame that began.
        self.restarts, self.written, self.frames = 0, [], []

    def read(self, address):
        return self.values.get(address, 0)

    def write(self, address, value):
        self.written.append((address, value))
        if address == self.at["control"]:
            self.restarts += value >> 2 & 1
            self.values[address] = value & 3
        elif address == self.at["events"]:
            self.values[address] &= ~value
        elif address == self.at["interrupt_test"]:
            self.values[self.at["events"]] |= value & 0xFF
        elif address == self.at["interrupt_enable"] or address in self.reset and address >= 0x100:
            self.values[address] = value
        # A frame might begin at any time.
        if self.values[self.at["control"]] & 1:
            self.frames.append((self.values[self.at["edge_level"]], self.values[self.at["edge_min"]]))


@pytest.fixture
def core(page):
    return Core(page)


@pytest.fixture
def driver(design, core):
    return fv.Registers(design, core.read, core.write)


def test_a_design_has_the_registers_of_its_page(design, page):
    table = design.registers()
    assert [(one.address, one.name) for one in table] == [(address, name) for address, name, _ in page]
    assert len(page) > 20 and sum(len(fields) for *_, fields in page) > 40
    for register, (_, _, fields) in zip(table, page, strict=True):
        # If a field is all of a register, the page has the doc of the register, too.
        docs = [f"{register.doc}: {field.doc}" if field.name == "value" else field.doc for field in register.fields]
        fields_of_register = [(*field[:5], doc) for field, doc in zip(register.fields, docs, strict=True)]
        assert fields_of_register == fields, register.name
    assert fv.Camera(design).registers() == table
    # A camera has the size of its frames, and its registers have that size, too.
    camera = fv.Camera({"hardware": {"organization": "raster", "interface": "axi"}})
    camera.step(np.zeros((40, 64), np.uint8))
    assert [field.reset for one in camera.registers() if one.name == "frame" for field in one.fields] == [64, 40]
    with pytest.raises(ValueError, match="not on AXI.*pipelined.*ports.*interface = 'axi'"):
        fv.Design("paper").registers()


def test_registers_are_read_and_written_by_name(core, driver):
    assert core.written == []
    assert (driver["edge_level"], driver["edge_min"], driver["frame.height"], driver["control"]) == (100, 5, 40, 1)
    driver["edge_level"] = np.int64(120)
    assert core.written == [(0x100, 120)] and type(core.written[0][1]) is int
    driver["control.wait"] = True
    assert core.values[0x20] == 3
    driver["control.enable"] = 0
    assert core.values[0x20] == 2 and core.restarts == 0
    driver["interrupt_enable"] = 0x81
    driver["interrupt_enable.frame_done"] = 0
    assert core.values[0x2C] == 1
    core.values[0x24] = 2
    assert (driver["status.busy"], driver["status.restarting"], driver["status"]) == (0, 1, 2)
    core.values.update({0x34: 1 << 31, 0x38: 1, 0x3C: 2, 0x40: 0xFFFF})
    assert driver.counters() == {"frames": 1 << 31, "repaired": 1, "skipped": 2, "dropped": 0xFFFF}
    driver.restart()
    assert core.restarts == 1 and core.values[0x20] == 2
    assert driver.received() == b""
    assert "status.busy" in driver and "status.bsy" not in driver and len(set(driver)) == len(list(driver)) > 60
    with pytest.raises(RuntimeError, match="over_serial"):
        driver.board()


def test_events_are_cleared_by_name(core, driver):
    driver["interrupt_test"] = 0b1010_0001
    assert driver.events() == ["eol_early", "region_dropped", "frame_done"]
    driver.clear("frame_done", "eol_early", "frame_done")
    assert driver.events() == ["region_dropped"]
    before = list(core.written)
    driver.clear()
    assert driver.events() == ["region_dropped"] and core.written == before
    # A field can clear one of two events, too.
    driver["interrupt_test.sof_late"] = 1
    driver["events.sof_late"] = 1
    assert driver.events() == ["region_dropped"]
    driver.clear(*driver.events())
    assert core.read(0x28) == 0


def test_several_thresholds_hold_together(core, driver):
    driver["control.wait"] = 1
    core.frames.clear()
    driver.set(edge_level=7, edge_min=3, temporal_level=1)
    assert core.frames == [(7, 3)]
    assert (core.values[0x20], driver["temporal_level"]) == (3, 1)
    # A single threshold does not stop the core, and a stopped core stays stopped.
    del core.written[:]
    driver.set(edge_level=9)
    assert core.written == [(0x100, 9)]
    driver["control.enable"] = 0
    driver.set(edge_level=8, edge_min=2)
    assert core.values[0x20] == 2
    driver.set()


def test_a_core_runs_on_where_a_write_fails(design, core):
    def write(address, value):
        if address == 0x104:
            raise OSError("no bus")
        core.write(address, value)

    driver = fv.Registers(design, core.read, write)
    with pytest.raises(OSError, match="no bus"):
        driver.set(edge_level=7, edge_min=3)
    assert core.values[0x20] == 1


WRONG = [
    (lambda driver: driver["edge_levl"], KeyError, "no register `edge_levl`; the nearest is `edge_level`"),
    (lambda driver: driver["q"], KeyError, "the nearest is"),
    (lambda driver: driver["status.bsy"], KeyError, "nearest is `status.busy`"),
    (lambda driver: driver.set(edge_level=1, egde_min=2), KeyError, "nearest is `edge_min`"),
    (lambda driver: driver.clear("frame_dune"), KeyError, "nearest is `events.frame_done`"),
    (lambda driver: driver.__setitem__("edge_level", 2048), ValueError, "edge_level = 2048: expected 0 to 2047"),
    (lambda driver: driver.set(edge_level=1, edge_min=-1), ValueError, "edge_min = -1: expected 0 to 127"),
    (lambda driver: driver.__setitem__("control", 8), ValueError, "control = 8: expected 0 to 7"),
    (lambda driver: driver.__setitem__("control.wait", 2), ValueError, "control.wait = 2: expected 0 to 1"),
    (lambda driver: driver.__setitem__("status", 1), ValueError, "`status` can only be read"),
    (lambda driver: driver.__setitem__("region.size", 8), ValueError, "`region.size` can only be read"),
    (lambda driver: driver.set(edge_level=1, control=3), ValueError, "by itself"),
    (lambda driver: driver.set(**{"edge_level": 1, "control.wait": 1}), ValueError, "by itself"),
    (lambda driver: driver.__setitem__("edge_level", 1.5), TypeError, "integer"),
]


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_what_is_wrong_is_said_and_not_written(number, core, driver):
    call, kind, message = WRONG[number]
    with pytest.raises(kind, match=re.escape(message)):
        call(driver)
    assert core.written == []


def test_another_core_is_refused(design, core):
    def refused(design, values, *messages):
        core.values = {**core.reset, **values}
        with pytest.raises(RuntimeError) as error:
            fv.Registers(design, core.read, core.write)
        for message in messages:
            assert message in str(error.value)
        assert core.written == []

    refused(design, {0: 0xFFFFFFFF}, "no Foveate core", "0xffffffff, not 0x45564f46")
    refused(design, {4: 2}, "another map", "`version` reads 0x2, not 0x1")
    digits = design.fingerprint
    refused(design, {8: 0x123}, f"{digits[:8]}00000123, not {digits}")
    refused(design, {12: 0x123}, f"00000123{digits[8:]}, not {digits}")
    other = fv.Design(design, region={"size": 16})
    refused(other, {}, f"{digits}, not {other.fingerprint}", "`region.size` is 8, not 16", "`grid.columns` is 8, not 4")
    with pytest.raises(ValueError, match="not on AXI"):
        fv.Registers("paper", core.read, core.write)


def test_a_core_may_be_that_of_a_camera(design, core):
    camera = fv.Camera({key: value for key, value in tomllib.loads(design.toml()).items() if key != "frame"})
    refused = "`frame.width` is 64, not 224"
    with pytest.raises(RuntimeError, match=refused):
        fv.Registers(camera, core.read, core.write)
    # After its first frame the camera has a size.
    camera.step(np.zeros((40, 64), np.uint8))
    assert fv.Registers(camera, core.read, core.write)["frame.width"] == 64


def register_packet(address, value, written, frame=0):
    """Makes a REGISTER packet by docs/packets.md."""
    words = 0xFA | 6 << 8 | written << 12 | 3 << 16 | address << 32, value
    body = struct.pack("<QQI", *words, frame)
    return body + struct.pack("<I", zlib.crc32(body))


def split_packets(packets):
    """Returns the packets of a stream without damage."""
    packets_found, start = [], 0
    while start < len(packets):
        size = 8 * struct.unpack_from("<H", packets, start + 2)[0]
        packets_found.append(packets[start : start + size])
        start += size
    return packets_found


class Port:
    """A board on a serial line by docs/boards.md: packets come byte by byte, and answers come between two of them."""

    def __init__(self, core, packets=b"", piece=7):
        self.core, self.board, self.piece = core, 0x0005_0001, piece
        #: The bytes of the current packet that have not come yet; the bytes that have left the core, answers included; and those that have not.
        self.unread_bytes, self.queue, self.packets = b"", [], split_packets(packets)
        self.commands, self.held_answers = [], []
        #: For numbers of commands: a function from an answer to the packets that are sent in its place, or None if the command is not received.
        self.answer_filters = {}

    def write(self, data):
        number = len(self.commands)
        self.commands.append(data)
        head, value, _ = struct.unpack("<QQQ", data)
        address, written = head >> 32 & 0xFFFF, head >> 12 & 1
        assert data == register_packet(address, value, written)
        answer_filter = self.answer_filters.get(number, lambda answer: [answer])
        if answer_filter is None:
            return
        if written:
            self.core.write(address, value)
        else:
            value = self.board if address == 0x1000 else self.core.read(address)
        self.queue += [*self.packets[:2], *answer_filter(register_packet(address, value, written))]
        del self.packets[:2]

    def hold_answer(self, answer):
        """Holds an answer until send_held_answers is called. An answer filter."""
        self.held_answers.append(answer)
        return []

    def send_held_answers(self, answer):
        """Sends the held answers, and then this one. An answer filter."""
        earlier_answers, self.held_answers = self.held_answers, []
        return [*earlier_answers, answer]

    def read(self, size):
        if not self.unread_bytes:
            packets = self.queue or self.packets
            self.unread_bytes = packets.pop(0) if packets else b""
        size = min(size, self.piece)
        piece, self.unread_bytes = self.unread_bytes[:size], self.unread_bytes[size:]
        return piece

    def unread(self):
        """Returns all bytes that have not come yet."""
        return self.unread_bytes + b"".join([*self.queue, *self.packets])


class PySerial(Port):
    """A board whose port reports the number of received bytes, as pyserial does, and would wait for more."""

    @property
    def in_waiting(self):
        return min(len(self.unread()), 100)

    def read(self, size):
        assert size <= max(1, self.in_waiting)
        return super().read(size)


class Clock:
    """A clock that does not depend on the load of this machine: it advances at each call."""

    def __init__(self):
        self.now = 0.0

    def monotonic(self):
        self.now += 1e-4
        return self.now

    def sleep(self, seconds):
        self.now += seconds


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    monkeypatch.setattr("foveate._line.time", clock := Clock())
    return clock


over_serial = fv.Registers.over_serial


@pytest.fixture(scope="module")
def packets(design, tmp_path_factory, command):
    folder = tmp_path_factory.mktemp("clip")
    (folder / "design.toml").write_text(design.toml())
    command("simulate", "scene:street", "--frames", "12", "--packets", "--config", folder / "design.toml", "-o", folder / "out")
    recording = (folder / "out/packets.bin").read_bytes()
    assert len(split_packets(recording)) > 100
    return recording


@pytest.mark.parametrize("kind, piece", [(Port, 1), (Port, 7), (Port, 1000), (PySerial, 1000)])
def test_a_core_is_driven_between_packets_and_none_is_lost(kind, piece, design, core, packets):
    port = kind(core, packets, piece)
    driver = over_serial(design, port)
    driver.set(edge_level=120, edge_min=4)
    other_packets = driver.received()
    assert core.frames[-1] == (120, 4)
    assert (driver["edge_level"], driver["status.busy"], driver.events()) == (120, 0, [])
    assert driver.board() == {"done": 1, "failed": 0, "lost": 5}
    assert 0 < len(other_packets) < len(packets) / 2
    assert other_packets + driver.received() + port.unread() == packets
    assert driver.received() == b""
    # Every answer was found: 4 reads of a new driver, 6 commands of `set`, and 4 reads.
    assert len(port.commands) == 14


def test_a_recording_while_a_core_is_driven_can_be_decoded(design, core, packets, command, tmp_path):
    port = Port(core, packets)
    driver = over_serial(design, port)
    (tmp_path / "recording.bin").write_bytes(driver.received() + port.unread())
    (tmp_path / "design.toml").write_text(design.toml())
    command("decode", tmp_path / "recording.bin", "--config", tmp_path / "design.toml", "-o", tmp_path / "seen")
    assert '"complete": true' in (tmp_path / "seen/summary.json").read_text()


def test_a_command_or_an_answer_that_is_lost_is_sent_again(design, core, packets):
    port = Port(core, packets)
    port.answer_filters = {0: None, 5: lambda answer: []}
    driver = over_serial(design, port)
    assert driver["edge_min"] == 5
    assert port.commands[0] == port.commands[1] == register_packet(0, 0, 0)
    assert driver.received() + port.unread() == packets


@pytest.mark.parametrize("bit", [*range(64), *range(96, 192)])
def test_an_answer_with_a_wrong_bit_is_none(bit, design, core):
    port = Port(core)
    driver = over_serial(design, port)
    flipped = []

    def flip(answer):
        flipped.append((int.from_bytes(answer, "little") ^ 1 << bit).to_bytes(24, "little"))
        return flipped

    port.answer_filters[len(port.commands)] = flip
    assert driver["edge_level"] == 100
    # Such a packet may be part of a recording.
    assert driver.received() == flipped[0]


def test_an_answer_with_a_wrong_value_has_a_wrong_crc(design, core):
    port = Port(core)
    driver = over_serial(design, port)
    port.answer_filters[len(port.commands)] = lambda answer: [answer[:8] + b"\x63" + answer[9:]]
    assert driver["edge_level"] == 100


def test_an_answer_is_found_in_noise(design, core):
    port = Port(core)
    driver = over_serial(design, port)
    driver.received()
    # Beginnings of an answer, the last of them before a whole one; answers of another register; and the answer to a write.
    head = register_packet(0x100, 77, 0)
    others = [register_packet(0x104, 3, 0), register_packet(0x100, 3, 1), register_packet(0x100, 3, 0, frame=1)]
    noise = [b"\xfa\xfa", head[:9], head[:23], *others, head[:9]]
    port.answer_filters[len(port.commands)] = lambda answer: [*noise, answer, b"\xfa\x06\x03"]
    count = len(port.commands)
    assert (driver["edge_level"], driver["edge_min"]) == (100, 5)
    assert len(port.commands) == count + 2
    assert driver.received() == b"".join(noise) + b"\xfa\x06\x03"


def test_an_old_answer_is_not_taken_for_a_new_one(design, core):
    port = Port(core)
    driver = over_serial(design, port)
    number = len(port.commands)
    # The first answer is late. The second one comes in time; the first comes with the next command.
    port.answer_filters = {number: port.hold_answer, number + 2: port.send_held_answers}
    assert driver["edge_level"] == 100
    core.values[0x100] = 44
    assert driver["edge_level"] == 44
    number = len(port.commands)
    port.answer_filters = {number: port.hold_answer, number + 2: port.send_held_answers}
    driver["edge_level"] = 50
    driver["edge_level"] = 50
    assert port.commands.count(register_packet(0x100, 50, 1)) == 3
    # The answer may also come after a time without any byte.
    driver = over_serial(design, port, attempts=1)
    number = len(port.commands)
    port.answer_filters = {number: port.hold_answer, number + 1: port.send_held_answers}
    with pytest.raises(TimeoutError):
        driver["edge_level"]
    core.values[0x100] = 45
    assert driver["edge_level"] == 45


def test_a_write_is_answered_by_what_was_written(design, core):
    port = Port(core)
    driver = over_serial(design, port)
    port.answer_filters[len(port.commands)] = lambda answer: [register_packet(0x100, 51, 1)]
    driver["edge_level"] = 50
    assert port.commands[-2:] == 2 * [register_packet(0x100, 50, 1)]


class Silent:
    """A port on which no byte comes, or only bytes of other packets."""

    def __init__(self, content):
        self.content, self.commands, self.reads = content, [], 0

    def write(self, data):
        self.commands.append(data)

    def read(self, size):
        self.reads += 1
        return self.content and self.content[:size]


@pytest.mark.parametrize("content", [b"", None, b"\xfa"])
def test_a_board_that_does_not_answer_is_a_timeout(content, design, clock):
    port = Silent(content)
    with pytest.raises(TimeoutError, match="asked 3 times to read register 0x0, and had 0.3 s each time"):
        over_serial(design, port)
    assert port.commands == 3 * [register_packet(0, 0, 0)] and 0.9 < clock.now < 1
    # The processor is idle while no byte comes.
    assert content or port.reads < 1000
    port = Silent(content)
    with pytest.raises(TimeoutError, match="asked 2 times to read register 0x0, and had 2 s each time"):
        over_serial(design, port, timeout=2, attempts=2)
    assert len(port.commands) == 2


def test_a_write_without_an_answer_says_so(design, core):
    port = Port(core)
    driver = over_serial(design, port)
    port.answer_filters = dict.fromkeys(range(len(port.commands), 100))
    with pytest.raises(TimeoutError, match="write 0x5 to register 0x100"):
        driver["edge_level"] = 5


def test_a_board_with_another_core_is_refused(design, core):
    with pytest.raises(RuntimeError, match="another design"):
        over_serial(fv.Design(design, frame={"width": 72}), Port(core))
