# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by event_readers.sh: compares events in EVT 2.0, EVT 3.0 and AEDAT4 with what other programs read from the files."""
import os
import pathlib
import subprocess
import sys
import tempfile

import aedat
import dv_processing
import evlib
import evt3
import expelliarmus
import faery
import numpy

# Recordings with several events per pixel, and with pauses of several loops of the times: the high part of a time begins anew after 16.8 s
# in EVT 3.0, and after 4.8 hours in EVT 2.0.
RECORDINGS = [
    ("street", ["scene:street", "--frames", "20"]),
    ("pauses of 9 s", ["scene:street", "--frames", "12", "--rate", "1/9"]),
    ("pauses of an hour", ["scene:shake", "--frames", "9", "--rate", "1/3600"]),
]
FORMATS = ["evt2", "evt3"]
# The compressions of AEDAT4, in the names of faery and of dv-processing.
COMPRESSIONS = [
    ("uncompressed", None, dv_processing.CompressionType.NONE),
    ("LZ4", ("lz4", 1), dv_processing.CompressionType.LZ4), ("LZ4, high", ("lz4", 9), dv_processing.CompressionType.LZ4_HIGH),
    ("ZSTD", ("zstd", 3), dv_processing.CompressionType.ZSTD), ("ZSTD, high", ("zstd", 19), dv_processing.CompressionType.ZSTD_HIGH),
]


def columns(events, names):
    """Returns a row (x, y, t, p) of whole numbers for each event."""
    return numpy.stack([numpy.asarray(events[name]).astype(numpy.int64) for name in names], axis=1)


def read_faery(path):
    return columns(faery.events_stream_from_file(path).to_array(), ["x", "y", "t", faery.EVENTS_DTYPE.names[-1]])


def read_evlib(path):
    events = evlib.load_events(str(path)).collect()
    times, polarities = events["t"].dt.total_microseconds().to_numpy(), events["polarity"].to_numpy() > 0
    return columns({"x": events["x"], "y": events["y"], "t": times, "p": polarities}, "xytp")


def read_evt3(path):
    events = evt3.decode_file(str(path))
    return columns({name: getattr(events, name) for name in "xytp"}, "xytp")


def read_expelliarmus(encoding):
    def read(path):
        wizard = expelliarmus.Wizard(encoding=encoding)
        wizard.set_file(str(path))
        return columns(wizard.read(), "xytp")
    return read


def read_aedat(path):
    packets = [packet["events"] for packet in aedat.Decoder(path) if "events" in packet]
    events = numpy.concatenate(packets)
    return columns(events, ["t", "x", "y", events.dtype.names[-1]])[:, [1, 2, 0, 3]]


def read_dv(path):
    recording = dv_processing.io.MonoCameraRecording(str(path))
    batches = [batch.numpy() for batch in iter(recording.getNextEventBatch, None)]
    return columns(numpy.concatenate(batches), ["x", "y", "timestamp", "polarity"])


def write_dv(path, rows, size, compression):
    """Writes events with those of dv-processing, and a frame and a trigger between them."""
    config = dv_processing.io.MonoCameraWriter.Config("foveate", compression)
    config.addEventStream(size)
    config.addFrameStream(size)
    config.addTriggerStream()
    writer = dv_processing.io.MonoCameraWriter(str(path), config)
    for part in numpy.array_split(rows, 3):
        store = dv_processing.EventStore()
        for x, y, time, polarity in part.tolist():
            store.push_back(time, x, y, bool(polarity))
        writer.writeEvents(store)
        time = int(part[-1, 2])
        writer.writeFrame(dv_processing.Frame(time, numpy.zeros(size[::-1], numpy.uint8)))
        writer.writeTrigger(dv_processing.Trigger(time, dv_processing.TriggerType.EXTERNAL_SIGNAL_RISING_EDGE))


def read_own(path):
    """Returns the events that the library of the project reads."""
    text = subprocess.run([os.environ["READER"], path], check=True, capture_output=True, text=True).stdout
    return numpy.array([line.split(",") for line in text.splitlines()[1:]], numpy.int64).reshape(-1, 4)


# The name of a reader, its format, the reader, and the columns that are compared. Expelliarmus 1.1.12 adds a carry to the times of EVT 3.0
# whenever their low part becomes smaller, though the high part has it. The readers of LOOPLESS have no times after a loop of
# EVT 2.0, of 4.8 hours.
LOOP_US = 1 << 34
LOOPLESS = [("evlib", "evt2"), ("expelliarmus", "evt2")]
READERS = [
    ("faery", "evt2", read_faery, 4), ("faery", "evt3", read_faery, 4),
    ("evlib", "evt2", read_evlib, 4), ("evlib", "evt3", read_evlib, 4),
    ("evt3", "evt3", read_evt3, 4),
    ("expelliarmus", "evt2", read_expelliarmus("evt2"), 4), ("expelliarmus, without times", "evt3", read_expelliarmus("evt3"), 2),
    ("faery", "aedat4", read_faery, 4), ("aedat", "aedat4", read_aedat, 4), ("dv-processing", "aedat4", read_dv, 4),
    ("foveate-media", "evt2", read_own, 4), ("foveate-media", "evt3", read_own, 4), ("foveate-media", "aedat4", read_own, 4),
]


def event_file(folder, encoding):
    """Returns the file that the command writes in a format."""
    return folder / ("pixel_events.aedat4" if encoding == "aedat4" else f"pixel_events_{encoding}.raw")


def compare(label, found, expected):
    """Prints whether the events are the same. Returns 1 if not."""
    same = found.shape == expected.shape and (found == expected).all()
    print(f"{label}: {len(found)} events, {'the same' if same else 'NOT the same'}")
    return int(not same)


def made_recordings(folder):
    """Writes recordings. Returns the number of readers that read something else than what was written."""
    wrong = 0
    for number, (name, inputs) in enumerate(RECORDINGS):
        output = folder / str(number)
        command = [os.environ["FOVEATE"], "simulate", *inputs, "-o", output, "--quiet", "--pixel-events=npz,evt2,evt3,aedat4"]
        subprocess.run(command, check=True)
        with numpy.load(output / "pixel_events.npz") as file:
            events = file["events"]
        expected = columns(events, "xytp")
        assert len(expected) > 1000, f"{name} has {len(expected)} events"
        for reader, encoding, read, count in READERS:
            found, length = read(event_file(output, encoding)), len(expected)
            if (reader, encoding) in LOOPLESS:
                length = int((expected[:, 2] < LOOP_US).sum())
            wrong += compare(f"{name}, {encoding}, {reader}", found[:length, :count], expected[:length, :count])
        for encoding in FORMATS:
            other = folder / f"faery_{number}_{encoding}.raw"
            stream = faery.events_stream_from_file(event_file(output, encoding))
            stream.to_file(other, version=encoding, zero_t0=False)
            wrong += compare(f"{name}, {encoding} of faery, foveate-media", read_own(other), expected)
        wrong += aedat4_of_others(folder, name, event_file(output, "aedat4"), expected)
    return wrong


def aedat4_of_others(folder, name, path, expected):
    """Returns the number of files of other programs that the library of the project reads otherwise."""
    wrong = 0
    size = faery.events_stream_from_file(path).dimensions()
    for label, faery_compression, dv_compression in COMPRESSIONS:
        other = folder / "faery.aedat4"
        faery.events_stream_from_file(path).to_file(other, compression=faery_compression, zero_t0=False)
        wrong += compare(f"{name}, AEDAT4 of faery, {label}, foveate-media", read_own(other), expected)
        other = folder / "dv.aedat4"
        write_dv(other, expected, size, dv_compression)
        wrong += compare(f"{name}, AEDAT4 of dv-processing, {label}, foveate-media", read_own(other), expected)
    return wrong


def given_recordings(paths):
    """Returns the number of recordings that the library of the project refuses, or reads otherwise than another reader."""
    wrong = 0
    for path in paths:
        try:
            own = read_own(path)
        except subprocess.CalledProcessError as error:
            print(f"{path}: refused: {error.stderr.strip()}")
            wrong += 1
            continue
        if path.endswith(".aedat4"):
            wrong += compare(f"{path}, dv-processing", read_dv(path), own)
            continue
        # A loop of EVT 2.0 is where evlib has no times any more.
        length = int((own[:, 2] < LOOP_US).sum())
        wrong += compare(f"{path}, evlib", read_evlib(path)[:length], own[:length])
    return wrong


def main():
    with tempfile.TemporaryDirectory() as folder:
        wrong = made_recordings(pathlib.Path(folder))
    wrong += given_recordings(sys.argv[1:])
    if wrong:
        sys.exit(f"event_readers: {wrong} comparisons differ")


if __name__ == "__main__":
    main()
