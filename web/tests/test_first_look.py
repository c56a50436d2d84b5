# SPDX-License-Identifier: MIT OR Apache-2.0
"""The first look at the live page in Chromium: the result, the pictures, plain words, help, and messages of the page itself."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from waiting import until

pytest_plugins = ["pages"]

SIZE = "#source=scene:street&size=160x120"
# Returns the pixels of a picture, the grey value of each.
GREYS = """id => {
    const canvas = document.querySelector(`#${id} canvas`);
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return [...data].filter((_, place) => place % 4 === 0);
}"""


def greys(page, name):
    return np.array(page.evaluate(GREYS, name), np.uint8).reshape(120, 160)


def step(page, count):
    for _ in range(count):
        before = page.evaluate("foveate.sums.frames")
        page.evaluate("document.getElementById('step').click()")
        until(page, "before => foveate.sums.frames === before + 1", before)


def share(text):
    return float(text.removesuffix(" %")) / 100


@pytest.mark.parametrize("size", [(1280, 800), (390, 844)])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_result_is_in_view_within_ten_seconds(opened, size, scheme):
    page = opened("", folded=True, viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)
    until(page, "document.getElementById('headline').textContent.includes('%')", timeout=10)
    box = page.locator("#result").bounding_box()
    assert box["y"] + box["height"] <= size[1]
    assert page.evaluate("parseFloat(getComputedStyle(document.getElementById('headline')).fontSize)") >= 28
    receiver = page.locator("#receiver").bounding_box()
    assert receiver["y"] + receiver["height"] <= box["y"] + 1
    # On a phone the figure stays in view.
    page.evaluate("scrollTo(0, 900)")
    page.wait_for_timeout(100)
    if size[0] < 500:
        assert 0 <= page.locator("#result").bounding_box()["y"] <= 1


def test_the_large_figure_is_the_share_of_the_last_second(still):
    page = still(SIZE)
    assert page.inner_text("#headline") == "–"
    shares = []
    for _ in range(4):
        before = page.evaluate("foveate.sums.camera")
        step(page, 1)
        shares.append((page.evaluate("foveate.sums.camera") - before) / (160 * 120))
    page.wait_for_timeout(300)
    until(page, "document.getElementById('headline').textContent.includes('%')")
    found = share(page.inner_text("#headline"))
    assert min(shares) - 1e-3 <= found <= max(shares) + 1e-3
    times = float(page.inner_text("#headline-times").removeprefix(": ").removesuffix(" times less"))
    assert abs(times * found - 1) < 0.06
    difference = np.abs(greys(page, "input").astype(int) - greys(page, "receiver")).mean()
    assert f"differs by {difference:.1f} of 255" in page.inner_text("#difference")


def test_what_is_sent_is_bright_and_the_rest_is_dark(still):
    page = still(SIZE + "&preset=steady")
    step(page, 4)
    regions = np.array(page.evaluate("[...foveate.camera.regions]"), np.uint8).reshape(15, 20)
    sent = (regions >> 2 == 0).repeat(8, axis=0).repeat(8, axis=1)
    seen, decided = greys(page, "input").astype(int), greys(page, "decisions").astype(int)
    assert 0 < sent.sum() < sent.size
    assert np.array_equal(decided[sent], seen[sent])
    assert (decided[~sent] <= 0.35 * seen[~sent] + 1).all()


def test_reasons_are_outlined_on_request(still):
    page = still(SIZE)
    step(page, 2)
    keys = page.locator("#legend")
    assert "relevant, unchanged" not in keys.inner_text() and "dark: not sent" in keys.inner_text()
    assert page.locator(".outlines").is_hidden()
    page.check("#outlines")
    assert "relevant, unchanged" in keys.inner_text() and "changed, irrelevant" in keys.inner_text()
    colours = page.evaluate(
        """() => {
            const canvas = document.querySelector(".outlines");
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            const words = new Uint32Array(data.buffer).filter(word => word >>> 24 === 255);
            return [...new Set(words)].length;
        }"""
    )
    # Sent, average sent, relevant only, changed only.
    assert 3 <= colours <= 4
    page.uncheck("#outlines")
    assert page.locator(".outlines").is_hidden()


def test_holding_a_button_or_a_key_compares(still):
    page = still(SIZE + "&preset=paper")
    step(page, 3)
    seen, shown = greys(page, "input"), greys(page, "receiver")
    assert not np.array_equal(seen, shown)
    box = page.locator("#compare").bounding_box()
    page.mouse.move(box["x"] + 10, box["y"] + 10)
    page.mouse.down()
    assert np.array_equal(greys(page, "receiver"), seen) and page.inner_text("#receiver-title") == "The camera sees"
    page.mouse.up()
    assert np.array_equal(greys(page, "receiver"), shown) and page.inner_text("#receiver-title") == "The receiver sees"
    page.focus("#input")
    page.keyboard.down("c")
    assert np.array_equal(greys(page, "receiver"), seen)
    page.keyboard.up("c")
    assert np.array_equal(greys(page, "receiver"), shown)


def test_two_sliders_stand_beside_the_pictures_and_the_rest_is_folded(still):
    page = still(SIZE, folded=True)
    for key in ("region.size", "temporal.level"):
        assert page.locator(f"#key-controls [data-key='{key}']").is_visible()
    assert page.locator("[data-key='temporal.min_count']").is_hidden()
    page.click("#all-settings summary")
    assert page.locator("[data-key='temporal.min_count']").is_visible()


def test_every_control_has_a_visible_line_of_help(still):
    page = still(SIZE)
    for feature in ("mad", "segment", "surface", "flow"):
        page.get_by_label(feature, exact=True).check()
    page.evaluate("document.querySelector('[data-zone=keen]').click()")
    rows = page.locator("[data-key]:not([data-key=preset])")
    assert rows.count() > 25
    for place in range(rows.count()):
        row = rows.nth(place)
        text = row.locator(".help")
        assert text.count() == 1 and text.is_visible() and len(text.inner_text()) > 8, row.get_attribute("data-key")
        assert row.locator("input, select").first.get_attribute("aria-describedby") == text.get_attribute("id")


def test_words_of_the_page_are_plain(opened):
    page = opened(SIZE, folded=True)
    page.check("#outlines")
    text = page.inner_text("body")
    for word in ("SRS only", "TRS only", "means sent", "as it is", "as the source"):
        assert word not in text
    assert page.locator("#speed option").first.inner_text() == "1x" and page.locator("#size option").first.inner_text() == "original"


@pytest.mark.parametrize("pointer", ["mouse", "finger"])
def test_targets_are_large_enough(still, pointer):
    page = still(SIZE, viewport={"width": 390, "height": 844}, has_touch=pointer == "finger")
    small = page.evaluate(
        """() => [...document.querySelectorAll("button, select, input, summary")]
            .filter(own => own.offsetParent && own.type !== "file")
            .map(own => [own.id || own.closest("[data-key]")?.dataset.key || own.textContent, own.getBoundingClientRect()])
            .filter(([, { width, height }]) => width < 24 || height < 24).map(([name]) => name)"""
    )
    assert small == []


def test_a_region_is_explained_before_one_is_chosen(opened, still):
    page = still(SIZE)
    assert "Region 10,7" in page.inner_text("#reasons")
    # The region at the same place stays chosen.
    page.locator("[data-key='region.size'] input[type=number]").fill("32")
    page.keyboard.press("Tab")
    page.evaluate("document.getElementById('step').click()")
    until(page, "document.getElementById('reasons').textContent.includes('Region 2,1')")
    running = opened(SIZE)
    until(running, "document.getElementById('reasons').textContent.includes('Region')")
    assert running.locator("#receiver .cursor").is_visible()


def test_the_first_frame_of_a_further_pass_is_not_counted(still, picture):
    page = still("")
    page.evaluate(
        """files => {
            const transfer = new DataTransfer();
            for (const [name, bytes] of files) transfer.items.add(new File([new Uint8Array(bytes)], name, { type: "image/png" }));
            document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true }));
        }""",
        [[f"f{number}.png", list(picture(64, 48, number))] for number in range(3)],
    )
    until(page, "document.getElementById('source').value === 'files' && foveate.sums.frames === 1")
    first = page.evaluate("foveate.sums.camera")
    step(page, 2)
    sums = page.evaluate("foveate.sums")
    page.evaluate("document.getElementById('step').click()")
    page.wait_for_timeout(300)
    # All regions of the fourth frame were sent, because the clip began again.
    assert page.evaluate("foveate.sums") == sums
    step(page, 1)
    assert page.evaluate("foveate.sums.camera") - sums["camera"] < first


def test_a_camera_is_kept_beside_another(still):
    page = still(SIZE + "&preset=paper")
    assert page.locator("#pinned").is_hidden()
    page.click("#pin")
    page.locator("[data-key='region.size'] input[type=number]").fill("16")
    page.keyboard.press("Tab")
    page.click("#reset")
    until(page, "foveate.sums.frames === 1")
    step(page, 5)
    other = still(SIZE + "&preset=paper")
    other.click("#reset")
    until(other, "foveate.sums.frames === 1")
    step(other, 5)
    assert np.array_equal(greys(page, "pinned-screen"), greys(other, "receiver"))
    assert not np.array_equal(greys(page, "receiver"), greys(other, "receiver"))
    assert share(page.inner_text("#pinned-headline")) > 0
    page.select_option("#size", "320x240")
    assert page.evaluate("document.querySelector('#pinned-screen canvas').width") == 320
    page.click("#unpin")
    assert page.locator("#pinned").is_hidden() and page.locator("#unpin").is_hidden()


def test_the_pictures_are_saved_and_recorded(opened, still):
    page = still("#source=scene:street&size=320x240")
    step(page, 2)
    with page.expect_download() as waiting:
        page.click("#save-picture")
    image = np.asarray(Image.open(io.BytesIO(Path(waiting.value.path()).read_bytes())).convert("L"))
    assert waiting.value.suggested_filename == "foveate.png" and image.shape == (240, 3 * 320 + 2 * 7)
    own = page.evaluate(GREYS, "receiver")
    assert np.array_equal(image[:, 654:974], np.array(own, np.uint8).reshape(240, 320))
    running = opened("#source=scene:street&size=320x240")
    running.click("#film")
    running.wait_for_timeout(1200)
    with running.expect_download() as waiting:
        running.click("#film")
    assert waiting.value.suggested_filename.startswith("foveate.") and Path(waiting.value.path()).stat().st_size > 2000
    assert running.get_attribute("#film", "aria-pressed") == "false"


# --- Messages


def test_a_page_that_stands_still_says_why(still):
    page = still("")
    assert "asks for less motion; press Play" in page.inner_text("#source-status") and page.inner_text("#pause-name") == "Play"
    page.click("#pause")
    assert page.inner_text("#pause-name") == "Pause"
    assert page.inner_text("#source-status") == ""


def test_an_incomplete_file_says_so(chromium, page_file, tmp_path):
    path = tmp_path / "cut.html"
    path.write_text(page_file.read_text()[:60_000])
    page = chromium.new_page()
    page.goto(path.as_uri())
    assert page.locator("#late").is_hidden()
    page.wait_for_timeout(6500)
    assert page.locator("#late").is_visible() and "fetch the page again" in page.inner_text("#late")
    page.close()


def test_a_network_that_is_too_large_is_told(still):
    page = still("")
    page.evaluate("""() => {
        const file = new File([], "big.onnx");
        Object.defineProperty(file, "size", { value: 3e9 });
        foveate.network.open(file);
    }""")
    until(page, "!document.getElementById('network-refused').hidden")
    text = page.inner_text("#network-refused")
    assert "big.onnx has 3.0 GB" in text and "at most 2 GiB" in text and "foveate infer" in text


def test_a_browser_that_starts_no_thread_is_told(still):
    page = still("", before="globalThis.Worker = class { constructor() { throw new DOMException('blocked', 'SecurityError'); } };")
    page.set_input_files("#network-file", [{"name": "a.onnx", "mimeType": "", "buffer": b"x"}])
    until(page, "!document.getElementById('network-refused').hidden")
    assert "allow workers for this page" in page.inner_text("#network-refused")


def test_a_long_network_is_cancelled(still):
    page = still("", before="globalThis.Worker = class { postMessage() {} terminate() { globalThis.ended = true; } };")
    page.set_input_files("#network-file", [{"name": "a.onnx", "mimeType": "", "buffer": b"x"}])
    until(page, "document.getElementById('network-status').textContent === 'reading a.onnx'")
    assert page.inner_text("#close-network") == "Cancel"
    page.click("#close-network")
    assert page.evaluate("globalThis.ended") and page.inner_text("#network-status") == ""
    assert page.locator("#close-network").is_hidden()


def test_an_old_message_is_gone_after_a_success(still):
    page = still("#size=large")
    until(page, "!document.getElementById('notice').hidden")
    page.locator("[data-key='temporal.level'] input[type=number]").fill("20")
    page.keyboard.press("Tab")
    assert page.locator("#notice").is_hidden()


def test_forced_colours_keep_the_legend(still):
    page = still(SIZE, forced_colors="active")
    page.check("#outlines")
    colours = page.evaluate("[...document.querySelectorAll('#legend .outline i')].map(own => getComputedStyle(own).backgroundColor)")
    assert len(set(colours)) == 4
