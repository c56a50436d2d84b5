# SPDX-License-Identifier: MIT OR Apache-2.0
"""The readers of the program: a valid file for each, and the command that reads it.

A reader is one format of a file that the program reads; such a file may come from a stranger. A new reader is a row in READERS.
"""
import dataclasses
import gzip
import io
import pathlib
import shutil
import struct
import subprocess
import zipfile
from collections.abc import Callable

from .answer import Answer

SOURCES = pathlib.Path(__file__).resolve().parents[3]
NETWORK = SOURCES / "crates/network/tests/network/golden/lenet.onnx"
# The folder of a finished exploration, next to the samples.
EXPLORED = "explored"
WIDTH, HEIGHT, FRAMES = 64, 48, 6
CLIP = ["--frames", "3", "--set", f"frame={{width={WIDTH},height={HEIGHT}}}"]
NO_PICTURES = ["--no-rendered", "--quiet"]


def simulate(_bench, _folder, path):
    return ["simulate", path, "-o", "out", *NO_PICTURES, "--max-frames", "8"]


def simulate_stream(_bench, _folder, _path):
    return ["simulate", "-", "-o", "out", *NO_PICTURES, "--max-frames", "8"]


def simulate_set(_bench, folder, path):
    """Makes images of one size and their labels, one of which is mutated."""
    images = folder / "images-idx3-ubyte"
    images.write_bytes(idx_images())
    return ["simulate", images, "--labels", path, "-o", "out", *NO_PICTURES]


def simulate_classes(_bench, _folder, path):
    return ["simulate", path, "-o", "out", *NO_PICTURES, "--images", "set"]


def simulate_raw(_bench, _folder, path):
    return ["simulate", path, "-o", "out", *NO_PICTURES, "--raw", f"{WIDTH}x{HEIGHT},gray16le", "--bayer", "rggb"]


def simulate_upright(_bench, _folder, path):
    return ["simulate", path, "-o", "out", *NO_PICTURES, "--orientation", "upright"]


def timestamps(_bench, folder, path):
    """Makes images whose times are the mutated file."""
    return ["simulate", images_in(folder), "--timestamps", path, "--timestamp-unit", "ns", "-o", "out", *NO_PICTURES]


def stalls(_bench, _folder, path):
    return ["simulate", "scene:street", *CLIP, "--clocks", "--sink-stalls", path, "-o", "out", *NO_PICTURES]


def zones(_bench, _folder, path):
    return ["check", "--quiet", "--set", f"frame={{width={WIDTH},height={HEIGHT}}}", "--set", f'zones.map="{path}"']


def cells(_bench, _folder, path):
    return ["estimate", "--preset", "bare", "--liberty", path]


def images_in(folder):
    """Makes the images 000001.pgm to 000003.pgm in a folder, and returns it."""
    frames = folder / "frames"
    frames.mkdir()
    for number in range(1, 4):
        (frames / f"{number:06}.pgm").write_bytes(pgm())
    return frames


def boxes(_bench, folder, path):
    """Makes frames with the names 000001.pgm and so on, to which boxes belong."""
    frames = images_in(folder)
    if path.suffix == ".txt" and path.name == "000002.txt":
        # The folder of a YOLO set.
        path = path.parent
    return ["analyze", "recall", frames, "--boxes", path, "-o", "out", "--quiet"]


def sensor(_bench, _folder, path):
    return ["analyze", "sensor", "scene:street", *CLIP, "--sensor-events", path, "-o", "out", "--quiet"]


def network(_bench, _folder, path):
    return ["infer", path, "scene:street", *CLIP, "--framing", "stretch", "-o", "out", "--quiet"]


def array(_bench, folder, path):
    """Returns the command for the denoiser, which takes frames of any size."""
    shutil.copy(SOURCES / "networks/denoiser.onnx", folder / "denoiser.onnx")
    return ["infer", folder / "denoiser.onnx", path, "-o", "out", "--quiet"]


def accelerator(_bench, _folder, path):
    return ["infer", NETWORK, "scene:street", *CLIP, "--framing", "stretch", "--accelerator", path, "-o", "out", "--quiet"]


def configuration(_bench, _folder, path):
    return ["check", path]


def space(_bench, _folder, path):
    return ["explore", path, "scene:street", "--frames", "2", "--no-area", "--plan", "-o", "out", "--quiet"]


def board(_bench, _folder, path):
    return ["build", "--board", path, "--project", "-o", "out", "--quiet"]


def sensor_of_board(_bench, folder, path):
    text = (SOURCES / "crates/boards/boards/icebreaker.toml").read_text(encoding="utf-8")
    name = next(line for line in text.splitlines() if line.startswith("sensor"))
    (folder / "board.toml").write_text(text.replace(name, f'sensor = "{path.name}"'), encoding="utf-8")
    return ["build", "--board", folder / "board.toml", "--project", "-o", "out", "--quiet"]


def decode(_bench, _folder, path):
    return ["decode", path, "-o", "out", *NO_PICTURES, "--set", f"frame={{width={WIDTH},height={HEIGHT}}}"]


def decode_stream(_bench, _folder, _path):
    return ["decode", "-", "-o", "out", *NO_PICTURES, "--set", f"frame={{width={WIDTH},height={HEIGHT}}}"]


def continue_exploration(bench, folder, path):
    """Returns the command that continues an exploration, one of whose measurements is the mutated file."""
    shutil.copytree(bench / EXPLORED, folder / "out")
    measurements = sorted((folder / "out/measured").iterdir())
    shutil.copyfile(path, measurements[0])
    return ["explore", "approximations", "scene:street", "--frames", "2", "--no-area", "-o", "out", "--quiet"]


def verilog(_bench, folder, path):
    """Returns the command that parses Verilog. A module is missing from every folder, so no simulation starts."""
    (folder / "rtl").mkdir()
    shutil.copyfile(path, folder / "rtl/decision.v")
    return ["cosim", "--preset", "bare", "--rtl", folder / "rtl", "--rounds", "1", "--quiet"]


def pgm(offset=0):
    pixels = bytes((x * 5 + y * 3 + offset) % 256 for y in range(HEIGHT) for x in range(WIDTH))
    return b"P5\n%d %d\n255\n" % (WIDTH, HEIGHT) + pixels


def archive(folders=("",)):
    """Returns a ZIP archive with a stored and a compressed image in each of its folders."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as file:
        for place in folders:
            for number, method in enumerate([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED]):
                file.writestr(zipfile.ZipInfo(f"{place}f{number}.pgm"), pgm(number), method)
    return data.getvalue()


def oriented_jpeg(program, folder):
    """Makes a JPEG with an EXIF block that says that the image was turned."""
    data = picture(container="jpg")(program, folder)
    tags = struct.pack("<2sHIHHHIHHI", b"II", 42, 8, 1, 0x0112, 3, 1, 6, 0, 0)
    block = b"Exif\0\0" + tags
    return data[:2] + b"\xff\xe1" + struct.pack(">H", len(block) + 2) + block + data[2:]


def class_map():
    """Returns an image of classes for regions of 8x8 pixels."""
    columns, rows = WIDTH // 8, HEIGHT // 8
    return b"P5\n%d %d\n255\n" % (columns, rows) + bytes(i % 4 for i in range(columns * rows))


def library():
    """Returns a liberty file without a flip-flop, which is refused before Yosys starts."""
    return b"""library (small) {
  time_unit : "1ns"; voltage_unit : "1V"; capacitive_load_unit (1, pf); leakage_power_unit : "1nW"; nom_voltage : 1.8;
  lu_table_template (slew_load) {
    variable_1 : input_net_transition; variable_2 : total_output_net_capacitance; index_1 ("0.1, 1"); index_2 ("0.01, 0.1"); }
  cell (NAND2) { area : 4; cell_leakage_power : 0.1;
    pin (A) { direction : input; capacitance : 0.01; }
    pin (B) { direction : input; capacitance : 0.01; }
    pin (Y) { direction : output; function : "!(A&B)";
      timing () { related_pin : "A"; timing_sense : negative_unate;
        cell_rise (slew_load) { values ("0.1, 0.2", "0.3, 0.4"); }
        cell_fall (slew_load) { values ("0.1, 0.2", \\
          "0.3, 0.4"); } } } } /* the end */
}
"""


def npy():
    words = f"{{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, {HEIGHT}, {WIDTH}), }}"
    words = f"{words:<117}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(words)) + words + bytes(4 * WIDTH * HEIGHT)


def idx_images(count=5, side=28):
    return struct.pack(">4I", 0x803, count, side, side) + bytes((i * 7) % 256 for i in range(count * side * side))


def idx_labels(count=5):
    return struct.pack(">2I", 0x801, count) + bytes(i % 10 for i in range(count))


def text_of(*path):
    return lambda _program, _folder: SOURCES.joinpath(*path).read_bytes()


def coco():
    annotations = ",".join(f'{{"image_id":1,"bbox":[{i},{i},9,8],"iscrowd":0,"segmentation":[[1,2,[3]]]}}' for i in range(4))
    return f'{{"info":{{"year":2024}},"images":[{{"id":1,"file_name":"000002.pgm","width":64}}],"annotations":[{annotations}]}}'.encode()


def events():
    return b"t_us,x,y,p\n" + b"".join(b"%d,%d,%d,1\n" % (100 * i, i * 7 % WIDTH, i * 5 % HEIGHT) for i in range(600))


def encoded(*options, container):
    """Makes a file with frames of a scene, encoded by ffmpeg."""

    def make(_program, folder):
        path = folder / f"encoded.{container}"
        source = f"testsrc2=size={WIDTH}x{HEIGHT}:rate=10"
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", source, "-frames:v", str(FRAMES), *options, path], check=True)
        return path.read_bytes()

    return make


def picture(*options, container):
    return encoded("-frames:v", "1", "-update", "1", *options, container=container)


def packets(content):
    def make(program, folder):
        out = folder / f"packets-{content}"
        subprocess.run([program, "simulate", "scene:street", *CLIP, f"--packets={content}", *NO_PICTURES, "-o", out], check=True)
        return (out / "packets.bin").read_bytes()

    return make


def pixel_events(encoding, name):
    def make(program, folder):
        out = folder / f"pixel-events-{encoding}"
        subprocess.run([program, "simulate", "scene:street", *CLIP, f"--pixel-events={encoding}", *NO_PICTURES, "-o", out], check=True)
        return (out / name).read_bytes()

    return make


def aedat4_events(count=600):
    """Returns a file in AEDAT4 without compression, so that changes reach the tables inside of its packets."""
    packet = struct.pack("<I4sHHHHIII", 16, b"EVTS", 0, 6, 8, 4, 6, 4, count)
    packet += b"".join(struct.pack("<qhhB3x", 100 * i, i * 7 % WIDTH, i * 5 % HEIGHT, i % 2) for i in range(count))
    packet = struct.pack("<I", len(packet)) + packet
    streams = ('<dv version="2.0"><node name="outInfo" path="/outInfo/"><node name="0" path="/outInfo/0/">'
               '<attr key="typeIdentifier" type="string">EVTS</attr><node name="info" path="/outInfo/0/info/">'
               f'<attr key="sizeX" type="int">{WIDTH}</attr><attr key="sizeY" type="int">{HEIGHT}</attr></node></node></node></dv>').encode()
    # No compression and no table of packets, as the defaults of the format say.
    table = struct.pack("<I4sHHHHHHIII", 20, b"IOHE", 0, 10, 8, 0, 0, 4, 10, 4, len(streams)) + streams + bytes(4 - len(streams) % 4)
    return b"#!AER-DAT4.0\r\n" + struct.pack("<I", len(table)) + table + struct.pack("<ii", 0, len(packet)) + packet


def make_measurement(program, folder):
    """Makes a measurement of an exploration, whose folder the reader copies for every case."""
    command = [program, "explore", "approximations", "scene:street", "--frames", "2", "--no-area", "-o", folder / EXPLORED, "--quiet"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return sorted((folder / EXPLORED / "measured").iterdir())[0].read_bytes()


def constant_sample(data):
    return lambda _program, _folder: data


@dataclasses.dataclass(frozen=True)
class Reader:
    """A reader: the name of the format, the name of its file, the command that reads it, and the maker of a valid file."""

    name: str
    file: str
    command: Callable
    sample: Callable
    is_text: bool = False
    is_piped: bool = False
    sample_answer: Answer = Answer.ACCEPTED


READERS = [
    Reader("configuration", "camera.toml", configuration, lambda program, _: subprocess.run(
        [program, "presets", "fovea"], check=True, capture_output=True).stdout, is_text=True),
    Reader("space", "space.toml", space, text_of("crates/explore/spaces/approximations.toml"), is_text=True),
    Reader("board", "board.toml", board, text_of("crates/boards/boards/icebreaker.toml"), is_text=True),
    Reader("board-sensor", "sensor.toml", sensor_of_board, text_of("crates/boards/sensors/ov7670-qvga.toml"), is_text=True),
    Reader("accelerator", "accelerator.toml", accelerator, text_of("crates/network/presets/eyeriss.toml"), is_text=True),
    Reader("liberty", "cells.lib", cells, constant_sample(library()), is_text=True, sample_answer=Answer.REFUSED),
    Reader("zone-map", "map.pgm", zones, constant_sample(class_map())),
    Reader("png", "picture.png", simulate, picture(container="png")),
    Reader("png-16-bit", "picture.png", simulate, picture("-pix_fmt", "gray16be", container="png")),
    Reader("apng", "picture.apng", simulate, encoded("-f", "apng", container="apng")),
    Reader("jpeg", "picture.jpg", simulate, picture(container="jpg")),
    Reader("jpeg-upright", "picture.jpg", simulate_upright, oriented_jpeg),
    Reader("bmp", "picture.bmp", simulate, picture(container="bmp")),
    Reader("pgm", "picture.pgm", simulate, constant_sample(pgm())),
    Reader("pgm-text", "picture.pgm", simulate, constant_sample(b"P2\n4 4\n15\n" + b"1 2 3 4\n" * 4), is_text=True),
    Reader("pam", "picture.pam", simulate, picture("-pix_fmt", "rgb24", container="pam")),
    Reader("zip", "pictures.zip", simulate, constant_sample(archive())),
    Reader("zip-set", "pictures.zip", simulate_classes, constant_sample(archive(["cat/", "dog/"]))),
    Reader("timestamps", "times.csv", timestamps, constant_sample(b"#timestamp [ns],filename\n" + b"".join(
        b"%d,%06d.pgm\n" % (1_403_636_579_763_555_584 + 50_000_000 * number, number) for number in range(1, 4))), is_text=True),
    Reader("raw", "clip.raw", simulate_raw, constant_sample(bytes(i * 7 % 256 for i in range(2 * WIDTH * HEIGHT * 3)))),
    Reader("stalls", "stalls.csv", stalls, constant_sample(
        b"clock,clocks\n" + b"".join(b"%d,%d\n" % (500 * i, 20 + i) for i in range(8))), is_text=True),
    Reader("mp4", "clip.mp4", simulate, encoded("-c:v", "libx264", "-pix_fmt", "yuv420p", container="mp4")),
    Reader("mkv", "clip.mkv", simulate, encoded("-c:v", "ffv1", container="mkv")),
    Reader("avi", "clip.avi", simulate, encoded("-c:v", "mjpeg", container="avi")),
    Reader("ts", "clip.ts", simulate, encoded("-c:v", "mpeg2video", container="ts")),
    Reader("gif", "clip.gif", simulate, encoded(container="gif")),
    Reader("webm", "clip.webm", simulate, encoded("-c:v", "libvpx", container="webm")),
    Reader("y4m", "clip.y4m", simulate, encoded("-pix_fmt", "yuv420p", container="y4m")),
    Reader("y4m-stream", "clip.y4m", simulate_stream, encoded("-pix_fmt", "gray", container="y4m"), is_piped=True),
    Reader("idx", "images-idx3-ubyte", simulate, constant_sample(idx_images())),
    Reader("idx-packed", "images-idx3-ubyte.gz", simulate, constant_sample(gzip.compress(idx_images(), mtime=0))),
    Reader("idx-labels", "labels-idx1-ubyte", simulate_set, constant_sample(idx_labels())),
    Reader("cifar", "batch.bin", simulate, constant_sample(b"".join(bytes([i]) + bytes(j % 251 for j in range(3072)) for i in range(3)))),
    Reader("boxes-mot", "gt.txt", boxes, constant_sample(b"".join(
        b"%d,%d,5,6,20,15,1,1,1\n" % (frame, track) for frame in range(1, 4) for track in range(5))), is_text=True),
    Reader("boxes-coco", "boxes.json", boxes, constant_sample(coco()), is_text=True),
    Reader("boxes-yolo", "000002.txt", boxes, constant_sample(b"0 0.5 0.5 0.25 0.25\n1 0.1 0.2 0.1 0.1\n"), is_text=True),
    Reader("boxes-csv", "boxes.csv", boxes, constant_sample(b"file,x0,y0,x1,y1\n000001.pgm,1,2,30,40\n\"000002.pgm\",3,4,20,20\n"), is_text=True),
    Reader("events", "events.csv", sensor, constant_sample(events()), is_text=True),
    Reader("events-packed", "events.csv.gz", sensor, constant_sample(gzip.compress(events(), mtime=0))),
    Reader("events-evt2", "events.raw", sensor, pixel_events("evt2", "pixel_events_evt2.raw")),
    Reader("events-evt3", "events.raw", sensor, pixel_events("evt3", "pixel_events_evt3.raw")),
    Reader("events-aedat4", "events.aedat4", sensor, pixel_events("aedat4", "pixel_events.aedat4")),
    Reader("events-aedat4-plain", "events.aedat4", sensor, constant_sample(aedat4_events())),
    Reader("onnx", "network.onnx", network, text_of("crates/network/tests/network/golden/lenet.onnx")),
    Reader("npy", "picture.npy", array, constant_sample(npy())),
    Reader("packets", "packets.bin", decode, packets("scores")),
    Reader("packets-stream", "packets.bin", decode_stream, packets("plain"), is_piped=True),
    Reader("measurement", "measured.json", continue_exploration, make_measurement, is_text=True),
    Reader("verilog", "decision.v", verilog, text_of("rtl/decision.v"), is_text=True, sample_answer=Answer.REFUSED),
]


def samples(program, folder, readers):
    """Makes a valid file for each chosen reader. Some have other files in the same folder."""
    return {reader.name: reader.sample(program, folder) for reader in readers}
