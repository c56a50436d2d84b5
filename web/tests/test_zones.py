# SPDX-License-Identifier: MIT OR Apache-2.0
"""Zones of the live page: painted by mouse, finger and keyboard, in the TOML, in links, at other sizes and depths. The results of a painted
camera are those of `foveate simulate` with the copied TOML."""

import os
import re
import subprocess
from pathlib import Path

import pytest
from test_page import control, drop, put, shown, step
from waiting import until

pytest_plugins = ["pages"]

FOVEATE = os.environ.get("FOVEATE", "foveate")
# 20 x 15 regions of 8 x 8 pixels.
WIDTH, HEIGHT = 160, 120
START = f"#source=scene:street&size={WIDTH}x{HEIGHT}&preset=fovea"
MAP = "foveate.config.zones?.classes ?? []"
FACTS = "foveate.camera.facts"


def brush(page, name, side=1):
    page.select_option("#zones select", str(side))
    page.click(f"#zones [data-zone={name}]")


def centre(page, picture, x, y):
    """Returns where the centre of a region is on the screen."""
    page.locator(f"#{picture}").scroll_into_view_if_needed()
    box = page.locator(f"#{picture}").bounding_box()
    return box["x"] + (x * 8 + 4) * box["width"] / WIDTH, box["y"] + (y * 8 + 4) * box["height"] / HEIGHT


def drag(page, picture, *regions):
    page.mouse.move(*centre(page, picture, *regions[0]))
    page.mouse.down()
    for region in regions[1:]:
        page.mouse.move(*centre(page, picture, *region))
    page.mouse.up()


def rows(changes):
    """Returns the rows of a map that is normal but for {(x, y): digit}."""
    return ["".join(changes.get((x, y), "0") for x in range(20)) for y in range(15)]


def simulated(page, native, frames):
    return native.simulate(page.evaluate(f"{FACTS}.toml"), ["scene:street"], "--frames", frames, "--resize", f"{WIDTH}x{HEIGHT}").frames


def assert_as_simulated(page, native):
    """Begins again, and compares frames with those of the command."""
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    step(page, 3)
    expected = simulated(page, native, 4)
    assert bytes(page.evaluate("[...foveate.camera.regions]")) == expected[3].regions
    assert page.evaluate("foveate.camera.hash()") == expected[3].hash()


def test_a_stroke_gives_its_regions_a_class(still, native):
    page = still(START)
    brush(page, "off")
    drag(page, "input", (2, 3), (6, 3), (6, 5))
    off = {(x, 3): "1" for x in range(2, 7)} | {(6, 4): "1", (6, 5): "1"}
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", rows(off))
    brush(page, "always", side=3)
    drag(page, "decisions", (10, 10), (11, 10))
    always = {(x, y): "3" for x in range(9, 13) for y in range(9, 12)}
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", rows(off | always))
    # At the edge a part of the brush is outside.
    brush(page, "keen", side=5)
    drag(page, "receiver", (19, 14))
    keen = {(x, y): "2" for x in range(17, 20) for y in range(12, 15)}
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", rows(off | always | keen))
    brush(page, "normal")
    drag(page, "input", (4, 3))
    del off[4, 3]
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", rows(off | always | keen))
    assert page.evaluate("document.querySelectorAll('#zones [aria-pressed=true]').length") == 1
    assert_as_simulated(page, native)
    page.click("#clear-zones")
    assert page.evaluate("foveate.config.zones ?? null") is None
    assert page.locator("#clear-zones").is_hidden()
    assert_as_simulated(page, native)


def test_a_brush_paints_and_does_not_choose(still):
    page = still(START)
    page.mouse.click(*centre(page, "input", 3, 3))
    assert "Region 3,3" in page.inner_text("#reasons")
    brush(page, "keen")
    page.mouse.click(*centre(page, "input", 8, 8))
    until(page, f"({MAP}).length === 15")
    assert "Region 3,3" in page.inner_text("#reasons")
    # The same button turns the brush off.
    page.click("#zones [data-zone=keen]")
    page.mouse.click(*centre(page, "input", 8, 8))
    assert "Region 8,8" in page.inner_text("#reasons")
    assert "class keen" in page.text_content("#reasons pre")


def test_the_keyboard_paints(still):
    page = still(START)
    brush(page, "off")
    page.focus("#decisions")
    for key in ("ArrowLeft", "ArrowLeft", "Enter", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", rows({(8, 7): "1", (8, 6): "1"}))


def test_a_running_clip_goes_on_while_it_is_painted(opened):
    page = opened(START)
    until(page, "foveate.sums.frames > 5")
    brush(page, "off", side=9)
    drag(page, "input", (5, 5))
    until(page, f"({MAP}).length === 15")
    # The first stroke makes a camera with zones; the next ones change nothing but the map.
    until(page, "foveate.sums.frames > 5")
    before = page.evaluate("foveate.sums.frames")
    drag(page, "input", (9, 5), (14, 9))
    count = page.evaluate("foveate.sums.frames")
    assert count >= before
    until(page, "count => foveate.sums.frames > count", count)
    off = page.evaluate(f"({MAP}).join('').split('').flatMap((digit, region) => digit === '1' ? [region] : [])")
    assert len(off) > 100
    assert page.evaluate("off => off.every(region => (foveate.camera.regions[region] & 1) === 0)", off)


def test_a_link_and_the_toml_have_the_map(still):
    page = still(START)
    brush(page, "keen", side=5)
    drag(page, "input", (4, 4), (12, 9))
    until(page, f"({MAP}).length === 15")
    put(page, "zones.keen.temporal.level", 3)
    put(page, "zones.keen.spatial.edge.min_score", 2)
    put(page, "zones.off_level", 77)
    until(page, "location.hash.includes('zones.classes')")
    facts = page.evaluate(FACTS)
    assert facts["config"]["zones"]["keen"] == {"spatial": [{"feature": "edge", "min_score": 2}], "temporal": {"level": 3}}
    page.click("#copy-link")
    until(page, "document.getElementById('copied').textContent.includes('clipboard')")
    link = page.evaluate("navigator.clipboard.readText()")
    assert len(link.split("#")[1]) < 600
    other = still("#" + link.split("#")[1])
    assert other.evaluate(FACTS) == facts
    path = Path(page.folder) / "camera.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(facts["toml"])
    done = subprocess.run([FOVEATE, "check", path], capture_output=True, text=True, check=True)
    assert facts["fingerprint"] in done.stdout
    # An empty map turns zones on.
    assert still(f"{START}&zones.classes=%22%22").evaluate("foveate.config.zones") is not None


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("%224x2:n5%22", "not a map"),
        ("%224x2:n4x4%22", "not a map"),
        ("%220x2:n4%22", "not a map"),
        ("%2299999x99999:n9999999%22", "not a map"),
        ("%224x2%22", "not a map"),
        ("7", "not a map"),
        ("true", "not a map"),
    ],
)
def test_a_wrong_map_in_a_link_is_told(still, value, message):
    page = still(f"{START}&zones.classes={value}")
    assert message in shown(page, message)
    assert page.evaluate("foveate.config.zones ?? null") is None
    step(page, 1)


@pytest.mark.parametrize(
    "link",
    ["zones.__proto__.rgba=1", "zones.keen.constructor.name=1", "zones.keen.spatial.0.__proto__=1", "zones.map=%22a.png%22"],
)
def test_a_wrong_key_of_zones_in_a_link_is_told(still, link):
    page = still(f"{START}&{link}")
    until(page, "!document.getElementById('notice').hidden")
    assert page.evaluate("Object.keys(Object.prototype).length === 0 && ({}).rgba === undefined")
    step(page, 1)


def test_a_map_goes_with_size_side_features_and_preset(still, native):
    page = still(START)
    brush(page, "off", side=9)
    drag(page, "input", (4, 4))
    until(page, f"({MAP}).length === 15")
    put(page, "region.size", 16)
    assert page.evaluate(MAP) == ["1111000000"] * 5 + ["0000000000"] * 3
    page.select_option("#size", "320x240")
    assert page.evaluate(f"[({MAP}).length, ({MAP})[0].length]") == [15, 20]
    page.select_option("#size", f"{WIDTH}x{HEIGHT}")
    control(page, "preset", "select").select_option("paper")
    assert page.evaluate(f"({MAP}).length") == 15
    page.get_by_label("mad", exact=True).check()
    put(page, "zones.keen.spatial.edge.level", 9)
    page.get_by_label("edge", exact=True).uncheck()
    assert page.locator("[data-key='feature.edge'] .refused").is_hidden()
    assert_as_simulated(page, native)


def test_a_map_is_rounded_once(still, picture):
    page = still(START)
    brush(page, "off")
    drag(page, "input", (3, 3))
    painted = rows({(3, 3): "1"})
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", painted)
    page.select_option("#size", "224x224")
    assert page.evaluate(f"({MAP}).length") == 28
    # The link has the map that the camera uses.
    until(page, "location.hash.includes('zones.classes=%2228x28:')")
    page.select_option("#size", f"{WIDTH}x{HEIGHT}")
    assert page.evaluate(MAP) == painted
    for side in (16, 12, 8):
        put(page, "region.size", side)
    assert page.evaluate(MAP) == painted
    # The first camera of a link has frames of 640x480, in which the only region that is off vanishes.
    page = still("#source=scene:street&preset=fovea&zones.classes=%22160x2:o1n319%22")
    drop(page, ("wide.png", "image/png", picture(1280, 16)))
    until(page, f"{FACTS}.width === 1280")
    assert page.evaluate(MAP) == ["1" + "0" * 159, "0" * 160]


def test_a_kept_camera_with_zones_goes_with_size_and_source(still, picture):
    page = still(f"{START}&zones.classes=%2220x15:o130k170%22")
    page.click("#pin")
    sizes = f"[{FACTS}.width, document.querySelector('#pinned-screen canvas').width, Number(document.getElementById('size').value.split('x')[0])]"
    # If the kept camera is refused, all stays.
    page.evaluate(
        """() => {
            const { engine } = foveate, configure = engine.configure.bind(engine);
            let count = 0;
            engine.configure = (...values) => { if (++count === 2) throw new Error("no room"); return configure(...values); };
        }"""
    )
    page.select_option("#size", "320x240")
    shown(page, "the kept camera: no room")
    assert page.evaluate(sizes) == [WIDTH] * 3
    page.evaluate("delete foveate.engine.configure")
    page.select_option("#size", "320x240")
    assert page.locator("#notice").is_hidden()
    assert page.evaluate(sizes) == [320] * 3
    until(page, "foveate.sums.frames >= 1")
    step(page, 2)
    # It is a camera like that of the page, so its receiver sees the same.
    pixels = "id => document.querySelector(`#${id} canvas`).toDataURL()"
    assert page.evaluate(pixels, "pinned-screen") == page.evaluate(pixels, "receiver")
    page.select_option("#size", "")
    drop(page, ("one.png", "image/png", picture(64, 48)))
    until(page, f"{FACTS}.width === 64")
    assert page.evaluate(sizes) == [64, 64, 0]
    assert page.locator("#pinned").is_visible() and page.locator("#notice").is_hidden()


def test_the_reasons_name_the_class_that_decides(still):
    page = still(f"{START}&zones.classes=%2220x15:n1o1k1a1n296%22")
    decided = {
        "normal": "one vote is enough.",
        "off": "Not relevant (SRS is 0): the class off decides, whatever the votes are.",
        "keen": "one vote is enough, at the thresholds of the class keen.",
        "always": "Relevant (SRS is 1): the class always decides, whatever the votes are.",
    }
    for x, (name, words) in enumerate(decided.items()):
        page.mouse.click(*centre(page, "input", x, 0))
        text = page.inner_text("#reasons")
        assert f"Region {x},0 " in text and f", class {name}, frame " in text and words in text


def test_the_slider_of_off_reaches_the_level_that_sends_once(still):
    page = still(f"{START}&zones.classes=%22%22")
    put(page, "zones.off_level", 255)
    assert page.evaluate("foveate.config.zones.off_level") == 255
    fields = "[...document.querySelectorAll('[data-key=\"zones.off_level\"] input')].map(({ value, max }) => [value, max])"
    assert page.evaluate(fields) == [["255", "255"]] * 2


@pytest.mark.parametrize("change", ["frame.pixel_bits=5", 'render.irrelevant="hold"'])
def test_thresholds_of_zones_follow_as_in_the_command(still, change):
    page = still(START + "&zones.classes=%22%22")
    put(page, "zones.keen.temporal.level", 30)
    put(page, "zones.keen.periphery.level", 25)
    put(page, "zones.off_level", 200)
    put(page, "zones.keen.spatial.edge.level", 50)
    path = Path(page.folder) / "camera.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(page.evaluate(f"{FACTS}.toml"))
    key, value = re.match(r"([a-z_.]+)=\"?([^\"]+)", change).groups()
    if value.isdigit():
        put(page, key, value)
    else:
        control(page, key, "select").select_option(value)
    done = subprocess.run([FOVEATE, "check", "--config", path, "--set", change], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert page.evaluate(f"{FACTS}.fingerprint") in done.stdout


def test_hardware_figures_are_not_those_of_a_camera_without_zones(still):
    page = still(f"#size=640x480&preset=fovea&region.size=8&zones.classes=%22{80}x60:o4800%22")
    text = page.inner_text("#area")
    assert "It is not in the table" in text and "'zones.classes=[]'" in text


def test_a_finger_paints(visit, chromium, page_file):
    page = visit(chromium, page_file.as_uri() + START, viewport={"width": 390, "height": 844}, has_touch=True, reduced_motion="reduce")
    until(page, "foveate.sums.frames >= 1")
    brush(page, "always")
    page.touchscreen.tap(*centre(page, "input", 7, 7))
    until(page, f"expected => JSON.stringify({MAP}) === JSON.stringify(expected)", rows({(7, 7): "3"}))
