# SPDX-License-Identifier: MIT OR Apache-2.0
"""The engine in the browser is the native one: the same frames lead to the same bits, in Chromium and in `foveate simulate`."""

import base64
import json

import camera_clip
from compare import assert_same_results
from PIL import Image

ALL_FEATURES = """[[spatial]]
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
[[spatial]]
feature = "range"
min_score = 30
[[spatial]]
feature = "surface"
[[spatial]]
feature = "segment"
min_score = 6
mean_fraction_bits = 2
"""
# The organization that supports it is named, too.
FLOW = """[[spatial]]
feature = "flow"
radius = 2
"""
SERIAL = '[hardware]\norganization = "serial"\n'
RENDERINGS = {
    "zero": "",
    "hold": '[render]\nirrelevant = "hold"\n',
    "mean": '[render]\nirrelevant = "mean"\npayload = "raw"\n',
}
# Sizes that leave padding to the right, below, and both; one region; more than a block of lanes.
SIZES = [(97, 61), (64, 50), (50, 64), (5, 7), (131, 33)]


def toml_at_depth(toml, bits):
    """Returns a configuration of that depth, without the thresholds for 8 bits that a smaller depth may not allow."""
    lines = toml.splitlines() if bits >= 8 else [line for line in toml.splitlines() if not line.startswith(("level", "min_score"))]
    return "\n".join([f"[frame]\npixel_bits = {bits}", *lines, ""])


def cameras():
    """Name, TOML, size: every preset, then features x references x what is shown x depths x sides of a region x sizes, each
    value with many of the others."""
    one = [f'[[spatial]]\nfeature = "{feature}"\n' for feature in ["edge", "corner", "mad", "variance", "range", "surface", "segment"]]
    every = ALL_FEATURES + FLOW
    features = [*one, ALL_FEATURES, ALL_FEATURES + '[decision]\ncombine = "all"\n', FLOW, every, every + '[decision]\ncombine = "all"\n']
    depths = [8, 10, 8, 5, 8, 16, 8, 1, 12]
    sides = [8, 16, 5, 4, 12, 64]
    number = 0
    for feature in features:
        # With `last-sent`, another feature must be able to vote alone.
        has_one = FLOW in feature and (feature == FLOW or "all" in feature)
        for reference in ["previous"] if has_one else ["previous", "last-sent"]:
            for shown in RENDERINGS.values():
                bits = depths[number % len(depths)]
                toml = toml_at_depth(feature, bits) + shown + SERIAL * (FLOW in feature)
                toml += f'[temporal]\nreference = "{reference}"\n'
                toml += f'[region]\nsize = {sides[number % len(sides)]}\nneighborhood = "{["isolated", "shared"][number // 2 % 2]}"\n'
                toml += f'[denoise]\nfilter = "{["none", "median3x3", "switching3x3", "binomial3x3"][number // 3 % 4]}"\n'
                yield f"camera {number}", toml, SIZES[number % len(SIZES)]
                number += 1


def scene(page, name, size, count, side=8):
    """Returns frames of a scene as the page makes them."""
    return page.evaluate("(a) => scene(...a)", [name, *size, count, side])


def run(page, toml, size, frames, **more):
    """Returns the results of the page for these frames."""
    return page.evaluate("(a) => run(a)", {"toml": toml, "width": size[0], "height": size[1], "frames": frames, **more})


def decoded(frames):
    return [base64.b64decode(frame) for frame in frames]


def test_presets(page, native):
    """Every preset, on frames that the native program makes itself: scenes are the same, too."""
    for preset in page.evaluate("engine.describe().presets"):
        name, toml = preset["name"], preset["toml"]
        size, count = ((640, 480), 2) if "[frame]" in toml else ((224, 224), 4)
        browser_results = run(page, toml, size, scene(page, "street", size, count))
        simulated = native.simulate(toml, ["scene:street"], "--frames", count)
        assert_same_results(browser_results, simulated, f"preset {name}")
        assert browser_results["facts"]["fingerprint"] == simulated.summary["design_fingerprint"], name


def test_matrix(page, native):
    """Features, references, what irrelevant regions show, depths, sides and sizes."""
    clips = {}
    for number, (name, toml, size) in enumerate(cameras()):
        subject = ["street", "random", "ramps", "night-rain"][number % 4]
        if (subject, size) not in clips:
            frames = scene(page, subject, size, 5)
            clips[subject, size] = frames, native.pictures(decoded(frames), size)
        frames, files = clips[subject, size]
        assert_same_results(run(page, toml, size, frames), native.simulate(toml, files), f"{name} on {subject}: {toml!r}")


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
    assert_same_results(run(page, "", size, pictures, colours=True), native.simulate("", files), "colours")


def test_explanations(page, native):
    """A region of the last frame is explained as `foveate explain` explains it, word for word."""
    size = (61, 43)
    frames = scene(page, "street", size, 4)
    files = native.pictures(decoded(frames), size)
    folder = native.folders.mktemp("explain")
    means = '[temporal]\nreference = "last-sent"\n[render]\nirrelevant = "mean"\n'
    for toml in [ALL_FEATURES, means, "[frame]\npixel_bits = 12\n[region]\nsize = 20\n"]:
        config = folder / "design.toml"
        config.write_text(toml)
        regions = [(0, 0), (2, 1), (3, 2)]
        explanations = run(page, toml, size, frames, explained=[[x, y, str(files[-1])] for x, y in regions])["explanations"]
        for (x, y), explanation in zip(regions, explanations, strict=True):
            arguments = ["explain", *files, "--config", config, "--frame", 3, "--region", f"{x},{y}"]
            assert explanation["text"] == native.call(*arguments), f"{toml!r}, region {x},{y}"
            assert explanation["json"] == json.loads(native.call(*arguments, "--json")), f"{toml!r}, region {x},{y}"


def test_camera(page, native):
    """The pictures that a page gets from a camera are those of its clip in order, and lead to the native results."""
    camera_pictures = page.evaluate("watched(6)")
    size = (camera_pictures["width"], camera_pictures["height"])
    pictures = decoded(camera_pictures["pictures"])
    numbers = [camera_clip.number_of(picture, size[0]) for picture in pictures]
    assert None not in numbers, f"pictures that are not of the clip: {numbers}"
    steps = [(after - before) % camera_clip.FRAMES for before, after in zip(numbers, numbers[1:], strict=False)]
    assert all(0 <= step <= camera_clip.FRAMES // 2 for step in steps) and any(steps), f"pictures out of order: {numbers}"
    folder = native.folders.mktemp("seen")
    files = []
    for number, picture in enumerate(pictures):
        files.append(folder / f"{number}.png")
        image = Image.frombytes("RGBA", size, picture).convert("RGB")
        image.save(files[-1])
    browser_results = run(page, "", size, camera_pictures["pictures"], colours=True)
    assert_same_results(browser_results, native.simulate("", files), f"pictures {numbers} of the camera")


def test_refusals(page):
    """A refusal has the message of the project, and the engine goes on."""
    message = page.evaluate("(toml) => refused(() => engine.configure(toml, 16, 16))", "[region]\nsize = 65\n")
    assert message == "`region.size` = 65 is out of range; the valid range is 2..=64"
    for call, expected in [
        ("() => engine.configure('', 16384, 16384)", "1 to 8294400 pixels"),
        ("() => engine.configure('', 1.5, 8)", "the width 1.5 is refused"),
        ("() => engine.scene('steet', 8, 8, 0)", "did you mean `street`"),
        ("() => engine.configure('', 8, 8).step(new Uint8Array(63))", "8x8 pixels has 64, 1 per pixel"),
        ("() => engine.configure('', 8, 8).events()", "nothing is recorded"),
        ("() => engine.configure('', 8, 8).scores(7)", "the camera has 1"),
        ("() => engine.configure('', 8, 8).explain(0, 0)", "no frame yet"),
        ("() => engine.configure('', 8, 8).step(new Uint8Array(3e8))", "300000000 bytes are more than the engine takes"),
    ]:
        message = page.evaluate(f"refused({call})")
        assert message and expected in message, f"{call}: {message}"
    messages = page.evaluate(
        "() => { const engine = window.engine, all = []; const said = refused(() => { for (;;) all.push(engine.configure('', 8, 8)); });"
        " all.forEach((camera) => camera.free()); return [said, refused(() => all[0].reset())]; }"
    )
    assert "8 cameras already" in messages[0] and "no camera number" in messages[1], messages
