# SPDX-License-Identifier: MIT OR Apache-2.0
"""The engine in the browser is the native one: the same frames lead to the same bits, in Chromium and in `foveate simulate`."""

import base64
import json

import film
from compare import same
from PIL import Image

FOUR = """[[spatial]]
feature = "edge"
level = 40
[[spatial]]
feature = "corner"
level = 10
[[spatial]]
feature = "mad"
min_score = 4
mean_fraction_bits = 2
[[spatial]]
feature = "variance"
min_score = 90
"""
SHOWN = {
    "zero": "",
    "hold": '[render]\nirrelevant = "hold"\n',
    "mean": '[render]\nirrelevant = "mean"\npayload = "raw"\n',
}
# Sizes that leave padding to the right, below, and both; one region; more than a block of lanes.
SIZES = [(97, 61), (64, 50), (50, 64), (5, 7), (131, 33)]


def at_depth(toml, bits):
    """A configuration of that depth; thresholds of 8 bits that it may not have are left out."""
    lines = toml.splitlines() if bits >= 8 else [line for line in toml.splitlines() if not line.startswith(("level", "min_score"))]
    return "\n".join([f"[frame]\npixel_bits = {bits}", *lines, ""])


def cameras():
    """Name, TOML, size: every preset, then features x references x what is shown x depths x sides of a region x sizes, each
    value with many of the others."""
    one = [f'[[spatial]]\nfeature = "{feature}"\n' for feature in ["edge", "corner", "mad", "variance"]]
    features = [*one, FOUR, FOUR + '[decision]\ncombine = "all"\n']
    depths = [8, 10, 8, 5, 8, 16, 8, 1, 12]
    sides = [8, 16, 5, 4, 12, 64]
    number = 0
    for feature in features:
        for reference in ["previous", "last-sent"]:
            for shown in SHOWN.values():
                bits = depths[number % len(depths)]
                toml = at_depth(feature, bits) + shown
                toml += f'[temporal]\nreference = "{reference}"\n'
                toml += f'[region]\nsize = {sides[number % len(sides)]}\nneighborhood = "{["isolated", "shared"][number // 2 % 2]}"\n'
                toml += f'[denoise]\nfilter = "{["none", "median3x3"][number // 3 % 2]}"\n'
                yield f"camera {number}", toml, SIZES[number % len(SIZES)]
                number += 1


def scene(page, name, size, count, side=8):
    """Frames of a scene as the page makes them."""
    return page.evaluate("(a) => scene(...a)", [name, *size, count, side])


def run(page, toml, size, frames, **more):
    """What the page says of frames."""
    return page.evaluate("(a) => run(a)", {"toml": toml, "width": size[0], "height": size[1], "frames": frames, **more})


def decoded(frames):
    return [base64.b64decode(frame) for frame in frames]


def test_presets(page, native):
    """Every preset, on frames that the native program makes itself: scenes are the same, too."""
    for preset in page.evaluate("engine.describe().presets"):
        name, toml = preset["name"], preset["toml"]
        size, count = ((640, 480), 2) if "[frame]" in toml else ((224, 224), 4)
        told = run(page, toml, size, scene(page, "street", size, count))
        simulated = native.simulate(toml, ["scene:street"], "--frames", count)
        same(told, simulated, f"preset {name}")
        assert told["facts"]["fingerprint"] == simulated.summary["design_fingerprint"], name


def test_matrix(page, native):
    """Features, references, what irrelevant regions show, depths, sides and sizes."""
    clips = {}
    for number, (name, toml, size) in enumerate(cameras()):
        subject = ["street", "random", "ramps", "night-rain"][number % 4]
        if (subject, size) not in clips:
            frames = scene(page, subject, size, 5)
            clips[subject, size] = frames, native.pictures(decoded(frames), size)
        frames, files = clips[subject, size]
        same(run(page, toml, size, frames), native.simulate(toml, files), f"{name} on {subject}: {toml!r}")


def test_colours(page, native):
    """A picture in colour becomes the same grey in a canvas and in the native program's reader of images."""
    size = (67, 45)
    folder = native.folders.mktemp("colours")
    files = []
    for number in range(3):
        image = Image.new("RGB", size)
        image.putdata([
            ((x * 7 + number * 31) % 256, (y * 11 + x * y + number) % 256, (x * x + y * 3) % 256)
            for y in range(size[1]) for x in range(size[0])
        ])
        files.append(folder / f"{number}.png")
        image.save(files[-1])
    pictures = page.evaluate("(files) => decoded(files)", [base64.b64encode(file.read_bytes()).decode() for file in files])
    same(run(page, "", size, pictures, colours=True), native.simulate("", files), "colours")


def test_explanations(page, native):
    """A region of the last frame is explained as `foveate explain` explains it, word for word."""
    size = (61, 43)
    frames = scene(page, "street", size, 4)
    files = native.pictures(decoded(frames), size)
    folder = native.folders.mktemp("explain")
    for toml in [FOUR, '[temporal]\nreference = "last-sent"\n[render]\nirrelevant = "mean"\n', "[frame]\npixel_bits = 12\n[region]\nsize = 20\n"]:
        config = folder / "design.toml"
        config.write_text(toml)
        regions = [(0, 0), (2, 1), (3, 2)]
        told = run(page, toml, size, frames, explained=[[x, y, str(files[-1])] for x, y in regions])["told"]
        for (x, y), own in zip(regions, told, strict=True):
            asked = ["explain", *files, "--config", config, "--frame", 3, "--region", f"{x},{y}"]
            assert own["text"] == native.call(*asked), f"{toml!r}, region {x},{y}"
            assert own["json"] == json.loads(native.call(*asked, "--json")), f"{toml!r}, region {x},{y}"


def test_camera(page, native):
    """What a page gets of a camera are pictures of the film, in order, and they lead to the native results."""
    seen = page.evaluate("watched(6)")
    size = (seen["width"], seen["height"])
    pictures = decoded(seen["pictures"])
    numbers = [film.number_of(picture, size[0]) for picture in pictures]
    assert None not in numbers, f"pictures that are none of the film: {numbers}"
    steps = [(after - before) % film.FRAMES for before, after in zip(numbers, numbers[1:], strict=False)]
    assert all(0 <= step <= film.FRAMES // 2 for step in steps) and any(steps), f"pictures out of order: {numbers}"
    folder = native.folders.mktemp("seen")
    files = []
    for number, picture in enumerate(pictures):
        files.append(folder / f"{number}.png")
        image = Image.frombytes("RGBA", size, picture).convert("RGB")
        image.save(files[-1])
    told = run(page, "", size, seen["pictures"], colours=True)
    same(told, native.simulate("", files), f"pictures {numbers} of the camera")


def test_refusals(page):
    """What is refused is said in the words of the project, and the engine goes on."""
    said = page.evaluate("(toml) => refused(() => engine.configure(toml, 16, 16))", "[region]\nsize = 65\n")
    assert said == "`region.size` = 65 is out of range; the valid range is 2..=64"
    for call, words in [
        ("() => engine.configure('', 16384, 16384)", "1 to 8294400 pixels"),
        ("() => engine.configure('', 1.5, 8)", "the width 1.5 is refused"),
        ("() => engine.scene('steet', 8, 8, 0)", "did you mean `street`"),
        ("() => engine.configure('', 8, 8).step(new Uint8Array(63))", "8x8 pixels has 64, 1 per pixel"),
        ("() => engine.configure('', 8, 8).events()", "nothing is recorded"),
        ("() => engine.configure('', 8, 8).scores(7)", "the camera has 1"),
        ("() => engine.configure('', 8, 8).explain(0, 0)", "no frame yet"),
        ("() => engine.configure('', 8, 8).step(new Uint8Array(3e8))", "300000000 bytes are more than the engine takes"),
    ]:
        said = page.evaluate(f"refused({call})")
        assert said and words in said, f"{call}: {said}"
    told = page.evaluate(
        "() => { const engine = window.engine, all = []; const said = refused(() => { for (;;) all.push(engine.configure('', 8, 8)); });"
        " all.forEach((camera) => camera.free()); return [said, refused(() => all[0].reset())]; }"
    )
    assert "8 cameras already" in told[0] and "no camera number" in told[1], told
