# SPDX-License-Identifier: MIT OR Apache-2.0
"""The live page in Chromium: every source and every control, messages, link, files, keyboard, sizes and colours.

The page is one file, which is opened as a file. The witness is the installed `foveate` (environment FOVEATE).
"""

import csv
import gzip
import io
import os
import re
import shlex
import subprocess
import urllib.parse
from pathlib import Path

import pytest
from PIL import Image
from waiting import eventually, until

pytest_plugins = ["pages"]


FOVEATE = os.environ.get("FOVEATE", "foveate")
WIDTH, HEIGHT = 160, 120
HASH = "foveate.camera.hash()"
TOML = "foveate.camera.facts.toml"


def foveate(*arguments, cwd=None):
    done = subprocess.run([FOVEATE, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, done.stderr
    return done.stdout


def shown(page, text):
    until(page, "text => document.getElementById('notice').textContent.includes(text)", text)
    return page.inner_text("#notice")


def frames(page, count):
    """Waits for a frame of that number or a later one."""
    until(page, "count => Number(document.getElementById('number').textContent) >= count", count)


def control(page, key, field="select, input"):
    return page.locator(f'[data-key="{key}"]').locator(field).first


def put(page, key, value):
    page.locator(f'[data-key="{key}"] input[type=number]').fill(str(value))
    page.keyboard.press("Tab")


def drop(page, *files):
    """Drops files, given as (name, type, bytes), on the page."""
    page.evaluate(
        """files => {
            const transfer = new DataTransfer();
            for (const [name, type, bytes] of files) transfer.items.add(new File([new Uint8Array(bytes)], name, { type }));
            document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true }));
        }""",
        [[name, kind, list(data)] for name, kind, data in files],
    )


def clip(folder, *more):
    """A clip of two seconds by ffmpeg."""
    path = folder / more[-1]
    source = ["-f", "lavfi", "-i", "testsrc=size=160x120:rate=30:duration=2"]
    subprocess.run(["ffmpeg", "-v", "error", "-y", *source, *more[:-1], str(path)], check=True)
    return path


def step(page, count):
    """Steps so many frames while the page stands still."""
    for _ in range(count):
        before = page.evaluate("foveate.sums.frames")
        page.evaluate("document.getElementById('step').click()")
        until(page, "before => foveate.sums.frames === before + 1", before)


# --- Scenes and controls


def test_a_scene_runs_and_nothing_is_requested(opened):
    page = opened("")
    requests = []
    page.on("request", lambda request: requests.append(request.url))
    frames(page, 5)
    assert page.input_value("#source") == "scene:street"
    assert page.locator("#notice").is_hidden()
    # Three pictures, of which none is blank.
    for name in ("input", "decisions", "receiver"):
        kinds = page.evaluate(
            """name => {
                const canvas = document.querySelector(`#${name} canvas`);
                return new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size;
            }""",
            name,
        )
        assert kinds > 20, name
    page.select_option("#source", "scene:flicker")
    frames(page, 3)
    assert requests == []


def test_a_scene_slows_down_and_changes_its_size(opened):
    page = opened("#size=160x120")
    page.select_option("#speed", "0.1")
    page.wait_for_timeout(400)
    before, start_ms = page.evaluate("[foveate.sums.frames, performance.now()]")
    page.wait_for_timeout(1500)
    after, end_ms = page.evaluate("[foveate.sums.frames, performance.now()]")
    assert 2 <= after - before <= 7 * (end_ms - start_ms) / 1500
    page.select_option("#size", "320x240")
    assert page.evaluate("[foveate.camera.facts.width, foveate.camera.facts.height]") == [320, 240]
    frames(page, 1)
    assert page.evaluate("document.querySelector('#receiver canvas').width") == 320


CHANGES = {
    "region.size": 16,
    "region.neighborhood": "shared",
    "denoise.filter": "median3x3",
    "frame.pixel_bits": 5,
    "spatial.0.level": 200,
    "spatial.0.min_score": 20,
    "temporal.level": 40,
    "temporal.min_count": 30,
    "temporal.reference": "previous",
    "render.irrelevant": "zero",
    "periphery.blocks": 4,
    "periphery.level": 0,
}


@pytest.mark.parametrize("key", CHANGES)
def test_a_control_changes_the_camera(still, key):
    page = still(f"#source=scene:street&size={WIDTH}x{HEIGHT}&preset=fovea")
    step(page, 6)
    before = page.evaluate(f"[{HASH}, foveate.camera.facts.fingerprint]")
    value = CHANGES[key]
    if isinstance(value, str) or key == "periphery.blocks":
        control(page, key, "select").select_option(str(value))
    else:
        put(page, key, value)
    parts = key.split(".")
    set_to = page.evaluate("parts => parts.reduce((table, name) => table[name], foveate.config)", parts)
    assert set_to == value
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    step(page, 6)
    after = page.evaluate(f"[{HASH}, foveate.camera.facts.fingerprint]")
    assert after[1] != before[1]
    assert after[0] != before[0]


def test_features_are_turned_on_and_off_but_never_all_off(still):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=paper")
    for feature in ("corner", "mad", "variance"):
        page.get_by_label(feature, exact=True).check()
    assert page.evaluate("foveate.camera.facts.features") == ["edge", "corner", "mad", "variance"]
    control(page, "decision.combine", "select").select_option("all")
    assert page.evaluate("foveate.config.decision.combine") == "all"
    for feature in ("edge", "corner", "mad"):
        page.get_by_label(feature, exact=True).uncheck()
    assert page.evaluate("foveate.camera.facts.features") == ["variance"]
    page.get_by_label("variance", exact=True).click()
    assert page.locator("[data-key='feature.variance'] .refused").is_visible()
    assert "needs a feature" in page.inner_text("[data-key='feature.variance'] .refused")
    assert page.get_by_label("variance", exact=True).is_checked()


def test_flow_has_arrows_and_an_organization_that_supports_it(still):
    page = still("#source=scene:shake&size=224x224&preset=raster")
    marked = """() => {
        const canvas = document.querySelector("#decisions .arrows");
        const words = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer);
        return words.filter(word => word === 0xffffffff).length;
    }"""
    before = page.evaluate(TOML)
    assert page.locator("#decisions .arrows").is_hidden() and page.locator("#moved-key").is_hidden()
    page.get_by_label("flow", exact=True).check()
    assert page.evaluate("foveate.config.hardware.organization") == "serial"
    assert page.locator("#moved-key").is_visible()
    control(page, "spatial.1.radius", "select").select_option("3")
    assert page.evaluate("foveate.config.spatial[1].radius") == 3
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    # Nothing has a reference yet.
    assert page.evaluate(marked) == 0
    step(page, 2)
    few = page.evaluate(marked)
    moved = page.evaluate("foveate.camera.displacements.filter((_, place) => place % 3 === 2).reduce((sum, vote) => sum + vote)")
    # An arrow has some ten pixels or more.
    assert moved > 50 and few > 10 * moved
    # The figures are those of raster cores, so the page says why there are none.
    assert "raster core, which does not compute flow" in page.inner_text("#area")
    assert page.locator("#area dd").count() == 0
    command = shlex.split(page.inner_text("#area pre"))
    (folder := Path(page.folder)).mkdir(exist_ok=True)
    (folder / "camera.toml").write_text(page.evaluate(TOML))
    told = foveate("check", *command[2:], cwd=folder)
    assert "serial" in told and "640 x 480" in told
    # A link has the organization, with its own keys.
    facts = page.evaluate("foveate.camera.facts")
    page.click("#copy-link")
    until(page, "document.getElementById('copied').textContent.includes('clipboard')")
    other = still("#" + page.evaluate("navigator.clipboard.readText()").split("#")[1])
    assert other.evaluate("foveate.camera.facts") == facts
    # Without the feature, the hardware is that from before.
    page.get_by_label("flow", exact=True).uncheck()
    assert page.evaluate(TOML) == before
    assert page.locator("#decisions .arrows").is_hidden()


def test_flow_alone_is_refused_where_nothing_would_have_a_reference(still):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=fovea")
    page.get_by_label("flow", exact=True).check()
    page.get_by_label("edge", exact=True).click()
    refused = page.inner_text("[data-key='feature.edge'] .refused")
    assert "flow" in refused and "last-sent" in refused
    assert page.evaluate("foveate.camera.facts.features") == ["edge", "flow"]


def test_a_movement_is_explained(still):
    page = still("#source=scene:shake&size=224x224&preset=paper")
    page.get_by_label("flow", exact=True).check()
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    step(page, 2)
    region = page.evaluate("foveate.camera.displacements.findIndex((vote, place) => place % 3 === 2 && vote) - 2") // 3
    box = page.locator("#decisions").bounding_box()
    column, row = region % 28, region // 28
    page.mouse.click(box["x"] + box["width"] * (column + 0.5) / 28, box["y"] + box["height"] * (row + 0.5) / 28)
    assert "because the content has moved by 1" in page.inner_text("#reasons")
    page.click("#reasons summary")
    assert "the content has moved by 1" in page.inner_text("#reasons pre")


def test_what_the_engine_refuses_is_told_beside_the_control(still):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=paper")
    before = page.evaluate(TOML)
    put(page, "region.size", 99)
    assert page.locator("[data-key='region.size'] .refused").is_visible()
    refused = page.inner_text("[data-key='region.size'] .refused")
    assert "region.size" in refused and "99" in refused and "2..=64" in refused
    assert page.evaluate(TOML) == before
    put(page, "region.size", 16)
    assert page.locator("[data-key='region.size'] .refused").is_hidden()
    assert "size = 16" in page.evaluate(TOML)


def test_means_follow_the_side_of_a_region(still):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=fovea")
    seen = []
    for side in (9, 10, 16):
        put(page, "region.size", side)
        seen.append(page.evaluate("[foveate.config.region.size, foveate.config.periphery.blocks]"))
    assert seen == [[9, 1], [10, 2], [16, 2]]


def test_presets_are_those_of_the_command(still):
    page = still(f"#size={WIDTH}x{HEIGHT}")
    names = [line.split()[0] for line in foveate("presets").splitlines()]
    options = control(page, "preset", "select").locator("option").all_inner_texts()
    assert options == names
    for name in names:
        control(page, "preset", "select").select_option(name)
        own = page.evaluate("foveate.camera.facts.fingerprint")
        size = f"frame={{width={WIDTH},height={HEIGHT}}}"
        assert own in foveate("check", "--preset", name, "--set", size)


@pytest.mark.parametrize("bits", [1, 5, 12])
def test_thresholds_go_with_the_depth_as_in_the_command(still, bits):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=fovea")
    for feature in ("mad", "variance"):
        page.get_by_label(feature, exact=True).check()
    (folder := Path(page.folder)).mkdir(exist_ok=True)
    (folder / "camera.toml").write_text(page.evaluate(TOML))
    put(page, "frame.pixel_bits", bits)
    refused = page.locator("[data-key='frame.pixel_bits'] .refused")
    command = ["check", "--config", folder / "camera.toml", "--set", f"frame.pixel_bits={bits}"]
    done = subprocess.run([FOVEATE, *map(str, command)], capture_output=True, text=True)
    if done.returncode:
        assert done.stderr.replace("`", "").replace("foveate: ", "").strip() in " ".join(refused.inner_text().split())
    else:
        assert page.evaluate("foveate.camera.facts.fingerprint") in done.stdout


# --- What is taken along


def test_the_copied_toml_is_a_configuration(still):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=fovea&region.size=6")
    page.click("#copy-toml")
    until(page, "document.getElementById('copied').textContent.includes('clipboard')")
    path = Path(page.folder) / "camera.toml"
    path.write_text(page.evaluate("navigator.clipboard.readText()"))
    assert page.evaluate("foveate.camera.facts.fingerprint") in foveate("check", path)


def test_a_link_restores_all_settings(still):
    page = still("#preset=paper&size=224x224&source=scene:flicker")
    put(page, "region.size", 12)
    page.get_by_label("mad", exact=True).check()
    control(page, "render.irrelevant", "select").select_option("mean")
    page.click("#copy-link")
    until(page, "document.getElementById('copied').textContent.includes('clipboard')")
    link = page.evaluate("navigator.clipboard.readText()")
    facts = page.evaluate("foveate.camera.facts")
    until(page, "link => location.href === link", link)
    other = still("#" + link.split("#")[1])
    assert other.evaluate("foveate.camera.facts") == facts
    assert other.input_value("#source") == "scene:flicker"
    assert control(other, "preset", "select").input_value() == "paper"


@pytest.mark.parametrize("change", ['render.irrelevant="hold"', 'render.irrelevant="zero"', "region.size=15"])
def test_a_link_leaves_out_means_that_do_not_fit(still, change):
    """Preset fovea has means of 2x2 blocks, and a link names only the keys that differ from the preset."""
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=fovea&{urllib.parse.quote(change, safe='=.')}")
    size = f"frame={{width={WIDTH},height={HEIGHT}}}"
    assert page.evaluate("foveate.camera.facts.fingerprint") in foveate("check", "--preset", "fovea", "--set", size, "--set", change)
    refused = still(f"#size={WIDTH}x{HEIGHT}&preset=fovea&render.irrelevant=%22hold%22&periphery.level=2")
    assert "periphery.level" in shown(refused, "cannot be combined")


@pytest.mark.parametrize(
    ("link", "message"),
    [
        ("region.size=99", "region.size"),
        ("regoin.size=9", "did you mean region?"),
        ("region=9", "`region` is not a setting".replace("`", "")),
        ("preset=nothing", "no preset nothing"),
        ("source=scene:nothing", "scene:nothing"),
        ("size=large", "write it as 640x480"),
        ("region.size=x", "x is not a value"),
        # Names that every object has from elsewhere.
        ("__proto__.rgba=1", "__proto__"),
        ("constructor.prototype=1", "constructor"),
        ("constructor.name=1", "constructor"),
        ("region.__proto__=1", "__proto__"),
        ("region.constructor=1", "constructor"),
        ("spatial.0.__proto__=1", "__proto__"),
        ("__proto__.0.rgba=1", "__proto__"),
        ("spatial.0.feature=%22toString%22", "toString"),
        ("preset=__proto__", "no preset __proto__"),
        ("source=scene:constructor", "scene:constructor"),
        ("network.__proto__=1", "network.__proto__ is not a setting"),
        ("__proto__=1", "__proto__ is not a setting"),
        # Numbers that are none, too large or leave others out.
        ("region.size=1e999", "1e999 is not a value"),
        ("region.size=12345678901234567890", "12345678901234567890 is not a value"),
        ("region.size=null", "null is not a value"),
        ("region.size=%5B8%5D", "[8] is not a value"),
        ("region.size=%7B%22__proto__%22:%7B%22rgba%22:1%7D%7D", "is not a value"),
        ("spatial.999999999.level=1", "spatial.999999999"),
        ("spatial.1.feature=%22edge%22", "spatial.1"),
        ("size=99999999999x1", "99999999999"),
        ("size=4294967295x4294967295", "4294967295"),
        # Text that is no link.
        ("region.size=%E0%A4%A", "region.size has a % that begins no character"),
        ("size=%", "size has a % that begins no character"),
        ("region.size=8&region.size=16", "region.size twice"),
        ("size=160x120&size=64x64", "size twice"),
        ("region.size=" + "8" * 20_000, "20013 characters"),
    ],
)
def test_a_wrong_link_is_told_and_the_page_starts(still, link, message):
    page = still("#" + link)
    assert message in shown(page, message)
    assert page.input_value("#source") == "scene:street"
    assert page.evaluate("Object.keys(Object.prototype).length === 0 && ({}).rgba === undefined")
    step(page, 2)


def test_events_are_those_of_simulate(still):
    page = still(f"#source=scene:street&size={WIDTH}x{HEIGHT}&preset=fovea")
    page.click("#record")
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    step(page, 4)
    assert page.inner_text("#recorded").startswith("5 frames")
    # The recorded frames are kept when recording ends.
    page.click("#record")
    with page.expect_download() as waiting:
        page.click("#download")
    assert waiting.value.suggested_filename == "events.csv"
    ours = Path(waiting.value.path()).read_text().splitlines()
    out = Path(page.folder) / "out"
    size = f"frame={{width={WIDTH},height={HEIGHT}}}"
    foveate("simulate", "scene:street", "-o", out, "--preset", "fovea", "--set", size, "--events", "csv")
    theirs = (out / "events.csv").read_text().splitlines()
    regions = (WIDTH // 8) * (HEIGHT // 8)
    assert ours == theirs[: 1 + 5 * regions]


def test_pixel_events_are_counted_as_simulate_does(still):
    page = still(f"#source=scene:street&size={WIDTH}x{HEIGHT}&preset=paper")
    step(page, 9)
    sums = page.evaluate("foveate.sums")
    out = Path(page.folder) / "out"
    size = f"frame={{width={WIDTH},height={HEIGHT}}}"
    foveate("simulate", "scene:street", "-o", out, "--preset", "paper", "--set", size, "--pixel-events=csv", "--log")
    times = [int(row["t"]) for row in csv.DictReader(io.StringIO((out / "pixel_events.csv").read_text()))]
    expected = sum(time <= round((sums["frames"] - 1) * 1e6 / 30) for time in times)
    assert sums["pixels"] == 4 * expected > 0


# --- Sources


def test_pictures_are_dropped(still, picture):
    page = still("#preset=paper")
    drop(page, ("one.png", "image/png", picture(64, 48)))
    until(page, "document.getElementById('source').value === 'files'")
    until(page, "foveate.sums.frames >= 1")
    assert page.evaluate("[foveate.camera.facts.width, foveate.camera.facts.height]") == [64, 48]
    ours = bytes(page.evaluate("[...foveate.camera.input]"))
    image = Image.open(io.BytesIO(picture(64, 48)))
    assert ours == bytes((77 * r + 150 * g + 29 * b + 128) >> 8 for r, g, b in image.get_flattened_data())


def test_several_pictures_are_a_clip_in_order_of_their_numbers(still, picture):
    page = still("")
    drop(page, *[(f"f{number}.png", "image/png", picture(32, 32, number)) for number in (10, 9, 1)])
    until(page, "document.getElementById('source').value === 'files'")
    until(page, "foveate.sums.frames === 1")
    seen = [page.evaluate("foveate.camera.input[0]")]
    for _ in range(2):
        step(page, 1)
        seen.append(page.evaluate("foveate.camera.input[0]"))
    assert seen == sorted(seen) and len(set(seen)) == 3


@pytest.mark.parametrize(
    ("name", "kind", "data", "message"),
    [
        ("broken.png", "image/png", b"\x89PNG\r\n\x1a\nbroken", "broken.png is not a picture"),
        ("notes.txt", "text/plain", b"notes", "notes.txt is neither a clip nor a picture"),
        ("clip.mp4", "video/mp4", b"no clip at all", "foveate live clip.mp4"),
    ],
    ids=["picture", "text", "clip"],
)
def test_what_is_no_picture_and_no_clip_is_told(still, name, kind, data, message):
    page = still("")
    drop(page, (name, kind, data))
    shown(page, message)
    assert page.input_value("#source") == "scene:street"
    step(page, 1)


def test_a_clip_that_the_browser_cannot_decode_is_told(still):
    page = still("")
    path = clip(Path(page.folder), "-c:v", "mpeg2video", "old.mpg")
    page.set_input_files("#files", path)
    text = shown(page, "cannot decode old.mpg")
    assert "foveate live old.mpg" in text


def test_a_clip_plays_steps_and_begins_again(opened):
    page = opened("#preset=paper")
    page.set_input_files("#files", clip(Path(page.folder), "-c:v", "libvpx", "-b:v", "1M", "clip.webm"))
    until(page, "document.getElementById('source').value === 'files'")
    frames(page, 20)
    page.click("#pause")
    assert page.evaluate("foveate.source.video.paused")
    time = page.evaluate("foveate.source.video.currentTime")
    step(page, 2)
    assert page.evaluate("foveate.source.video.currentTime") > time
    page.select_option("#speed", "0.25")
    assert page.evaluate("foveate.source.video.playbackRate") == 0.25
    page.select_option("#speed", "1")
    page.click("#reset")
    until(page, "foveate.source.video.currentTime === 0")
    page.click("#pause")
    until(page, "foveate.source.video.currentTime > 1.5")
    # After its end it begins again, and so does the camera.
    until(page, "foveate.source.video.currentTime < 0.5")
    until(page, "Number(document.getElementById('number').textContent) < 20")


def test_the_camera_is_shown(camera):
    page = camera("#source=webcam&preset=paper")
    until(page, "document.getElementById('source').value === 'webcam'")
    frames(page, 10)
    assert page.locator("#notice").is_hidden()
    assert page.locator("#speed").is_disabled()
    page.evaluate("foveate.source.video.srcObject.getVideoTracks()[0].dispatchEvent(new Event('ended'))")
    assert "plug it in" in shown(page, "the camera has been disconnected")


def test_a_refused_camera_is_told(still):
    page = still("")
    page.select_option("#source", "webcam")
    until(page, "!document.getElementById('notice').hidden")
    assert re.search("did not give the camera|there is no camera", page.inner_text("#notice"))
    assert page.input_value("#source") == "scene:street"


@pytest.mark.parametrize("error", ["NotAllowedError", "NotFoundError", "NotReadableError", "StrangeError"])
def test_every_refusal_says_what_to_do(still, error):
    page = still("")
    page.evaluate("name => { navigator.mediaDevices.getUserMedia = async () => { throw new DOMException('so', name); }; }", error)
    page.select_option("#source", "webcam")
    words = {"NotAllowedError": "allow it", "NotFoundError": "plug one in", "NotReadableError": "close that", "StrangeError": "StrangeError: so"}
    shown(page, words[error])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (gzip.compress(b"no engine", mtime=0), "foveate.wasm cannot be used here"),
        (b"cut", "the engine in this page is damaged"),
        ("01<23", "a character is not of base 85"),
        ("", "the engine in this page is damaged"),
    ],
    ids=["no engine", "damaged", "not base 85", "empty"],
)
def test_an_engine_that_does_not_load_is_told(broken, data, message):
    page = broken(data)
    shown(page, message)
    assert page.inner_text("#status") == "the engine did not start"


def test_a_browser_that_cannot_unpack_the_engine_is_told(visit, chromium, page_file):
    page = visit(chromium, page_file.as_uri(), ready="!document.getElementById('notice').hidden", before="delete globalThis.DecompressionStream")
    shown(page, "use a browser of 2023 or later")


# --- For everybody


def test_all_goes_by_keyboard(still):
    page = still(f"#size={WIDTH}x{HEIGHT}&preset=paper")
    reached = set()
    for _ in range(100):
        page.keyboard.press("Tab")
        name = page.evaluate(
            """() => {
                const own = document.activeElement;
                if (own === document.body) return null;
                const style = getComputedStyle(own);
                return [own.id || own.closest("[data-key]")?.dataset.key || own.tagName, style.outlineStyle !== "none"];
            }"""
        )
        if name is None:
            break
        assert name[1], f"{name[0]} has no visible focus"
        reached.add(name[0])
    keys = set(page.evaluate("[...document.querySelectorAll('[data-key]')].map(own => own.dataset.key)"))
    buttons = {"source", "open", "size", "pause", "step", "reset", "speed", "input", "decisions", "receiver", "open-network"}
    buttons |= {"compare", "outlines", "pin", "save-picture", "film"}
    buttons |= {"copy-toml", "copy-link", "record"}
    assert keys | buttons <= reached, keys | buttons - reached
    page.focus("#receiver")
    for key in ("ArrowRight", "ArrowRight", "ArrowDown"):
        page.keyboard.press(key)
    assert "Region 12,8" in page.inner_text("#reasons")
    number = page.evaluate("foveate.sums.frames")
    page.keyboard.press("s")
    until(page, "number => foveate.sums.frames === number + 1", number)
    page.keyboard.press(" ")
    frames(page, 5)
    page.keyboard.press(" ")
    assert page.inner_text("#pause-name") == "Play"
    # A slider goes by arrows.
    page.focus("[data-key='temporal.level'] input[type=range]")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("foveate.config.temporal.level") == 9


def test_a_region_is_explained_as_the_command_does(still):
    page = still("#size=224x224&preset=paper")
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    step(page, 3)
    box = page.locator("#decisions").bounding_box()
    page.mouse.click(box["x"] + box["width"] * 14.5 / 28, box["y"] + box["height"] * 24.5 / 28)
    assert "Region 14,24" in page.inner_text("#reasons")
    page.click("#reasons summary")
    text = page.inner_text("#reasons pre")
    command = foveate("explain", "scene:street", "--frame", "3", "--region", "14,24", "--preset", "paper")
    assert text.strip() == command.strip()


@pytest.mark.parametrize("width", [360, 768, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_no_width_scrolls_sideways_and_colours_follow(still, width, scheme):
    page = still("", viewport={"width": width, "height": 740}, color_scheme=scheme)
    step(page, 2)
    page.focus("#receiver")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert ground == {"light": "rgb(255, 255, 255)", "dark": "rgb(27, 30, 33)"}[scheme]


def test_reduced_motion_begins_paused(opened):
    page = opened("", reduced_motion="reduce")
    until(page, "foveate.sums.frames === 1")
    page.wait_for_timeout(300)
    assert page.evaluate("foveate.sums.frames") == 1
    assert page.inner_text("#pause-name") == "Play"


def test_hardware_is_from_the_table_or_a_command(still):
    page = still("#preset=fovea")
    assert page.locator("#area dd").count() == 5
    put(page, "region.size", 24)
    command = page.inner_text("#area pre")
    assert command.startswith("foveate estimate --config camera.toml")
    assert page.locator("#area dd").count() == 0
    # The design of any preset becomes a core.
    control(page, "preset", "select").select_option("serial")
    put(page, "region.size", 24)
    (Path(page.folder) / "camera.toml").write_text(page.evaluate(TOML))
    command = shlex.split(page.inner_text("#area pre"))
    told = foveate("check", *command[2:], cwd=page.folder)
    assert "raster" in told and "640 x 480" in told and "24x24" in told


def test_the_copied_link_of_a_served_page_has_no_address(server, still):
    page, _ = server
    frames(page, 1)
    put(page, "region.size", 12)
    page.click("#copy-link")
    until(page, "document.getElementById('copied').textContent.includes('clipboard')")
    text = page.evaluate("navigator.clipboard.readText()")
    assert text.startswith("#source=computer&") and "region.size=12" in text and "127.0.0.1" not in text
    # It stands behind another address.
    other = still(text.replace("source=computer&", ""))
    assert other.evaluate("foveate.camera.facts.side") == 12


def test_the_computer_serves_frames(server):
    page, served = server
    frames(page, 2)
    assert page.input_value("#source") == "computer"
    assert page.evaluate("[foveate.camera.facts.width, foveate.camera.facts.height]") == [48, 32]
    # The end of a clip is no error.
    until(page, "document.getElementById('source-status').textContent === 'the clip has ended; Reset begins again'")
    assert page.locator("#notice").is_hidden()
    assert page.evaluate("foveate.sums.frames") == 3
    page.click("#reset")
    # The server is asked for all frames again, up to the one after the last, and the page counts them from 0.
    restart = "POST /restart"
    eventually(
        lambda: restart in served.log and any("after=2&" in line for line in served.log[served.log.index(restart) :]),
        lambda: f"the second clip is not over: {served.log}",
    )
    until(page, "foveate.sums.frames === 3")
    assert {urllib.parse.urlsplit(line.split()[1]).path for line in served.log} == {"/", "/frames", "/restart"}
    # A fault at the end is one, also for a clip that loops.
    served.end = "ffmpeg reports: damaged"
    page.click("#loop")
    page.click("#reset")
    shown(page, "ffmpeg reports: damaged; Reset begins again")


def test_a_clip_of_the_computer_begins_again_if_it_loops(server):
    page, served = server
    page.click("#loop")
    page.click("#reset")
    until(page, "foveate.sums.frames >= 7")
    assert sum(line == "POST /restart" for line in served.log) >= 3
    assert page.locator("#notice").is_hidden() and page.inner_text("#source-status") == ""
    page.click("#loop")
    until(page, "document.getElementById('source-status').textContent.includes('the clip has ended')")


def test_an_input_that_another_page_shows_is_told(server):
    page, served = server
    frames(page, 1)
    taken = b"\x13\x00\x00\x00" + b'{"status": "taken"}'
    page.route("**/frames?*", lambda route: route.fulfill(body=taken, content_type="application/octet-stream"))
    page.click("#reset")
    shown(page, "another page shows this input now; Reset brings it back")
    viewers = {urllib.parse.parse_qs(urllib.parse.urlsplit(line.split()[1]).query)["viewer"][0] for line in served.log if "frames?" in line}
    page.unroute("**/frames?*")
    page.click("#reset")
    until(page, "foveate.sums.frames === 3")
    # The page asks under another name, so it is the last again.
    later = {urllib.parse.parse_qs(urllib.parse.urlsplit(line.split()[1]).query)["viewer"][0] for line in served.log if "frames?" in line}
    assert len(later) > len(viewers)
    assert page.locator("#notice").is_hidden()
