# SPDX-License-Identifier: MIT OR Apache-2.0
"""Arrays of every layout are the same frame, and what is no frame is refused by name."""
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis.extra.numpy import arrays

import foveate as fv
from conftest import equal


def spread(pixels):
    """The pixels with one column between them."""
    wide = np.zeros((pixels.shape[0], 2 * pixels.shape[1]), pixels.dtype)
    wide[:, ::2] = pixels
    return wide[:, ::2]


def framed(pixels):
    """The pixels inside of a larger array, with other values around."""
    return np.pad(pixels, ((3, 2), (5, 7)), constant_values=1)[3:-2, 5:-7]


def unaligned(pixels):
    """The pixels at an odd address."""
    raw = b"\0" + pixels.tobytes()
    return np.frombuffer(raw, pixels.dtype, offset=1).reshape(pixels.shape)


def frozen(pixels):
    """The pixels, which must not be written."""
    copy = pixels.copy()
    copy.flags.writeable = False
    return copy


LAYOUTS = {
    "Fortran": np.asfortranarray,
    "a part": framed,
    "spread": spread,
    "upside down": lambda pixels: np.flipud(np.flipud(pixels).copy()),
    "mirrored": lambda pixels: np.fliplr(np.fliplr(pixels).copy()),
    "a channel": lambda pixels: np.stack([pixels, pixels + 1, pixels], axis=2)[:, :, 2],
    "transposed": lambda pixels: pixels.T.copy().T,
    "unaligned": unaligned,
    "read-only": frozen,
    "a subclass": lambda pixels: pixels.copy().view(np.matrix),
    "a masked array": lambda pixels: np.ma.masked_array(pixels),
    "an array by protocol": lambda pixels: type("Pixels", (), {"__array__": lambda self, dtype=None, copy=None: pixels})(),
}


def pixels(dtype, largest):
    """Frames of 1 to 40 pixels a side."""
    sides = st.integers(1, 40)
    return st.tuples(sides, sides).flatmap(lambda shape: arrays(dtype, shape, elements=st.integers(0, largest)))


@pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")
@pytest.mark.parametrize("layout", LAYOUTS)
@given(one=pixels(np.uint8, 255), deep=pixels(np.uint16, 4095))
@settings(max_examples=25, deadline=None)
def test_the_layout_does_not_matter(layout, one, deep):
    for frame, keys in ((one, {}), (deep, {"frame": {"pixel_bits": 12}})):
        camera, other = (fv.Camera("seamless", region={"size": 4}, **keys) for _ in range(2))
        for current in (frame, frame[::-1].copy()):
            expected = camera.step(np.ascontiguousarray(current))
            assert equal(other.step(LAYOUTS[layout](current)), expected)


def test_rows_that_overlap_are_read_as_they_are():
    row = np.arange(40, dtype=np.uint8)
    same = np.broadcast_to(row, (24, 40))
    sliding = np.lib.stride_tricks.sliding_window_view(row, 16)
    for view in (same, sliding):
        assert equal(fv.Camera().step(view), fv.Camera().step(view.copy()))


def test_a_frame_is_not_kept_and_not_changed():
    frame = np.random.default_rng(1).integers(0, 256, (32, 32), np.uint8)
    before = frame.copy()
    camera = fv.Camera("steady")
    first = camera.step(frame, keep=True)
    shown = first.rendered.copy()
    assert np.array_equal(frame, before) and shown.any()
    frame[:] = 0
    assert np.array_equal(first.rendered, shown)


WRONG = [
    (np.zeros((4, 4, 3), np.uint8), ValueError, r"shape \(4, 4, 3\); foveate.luma"),
    (np.zeros((4, 4, 1), np.uint8), ValueError, r"take frame\[:, :, 0\]"),
    (np.zeros((7, 4, 4), np.uint8), ValueError, "give the frames one by one"),
    (np.zeros(16, np.uint8), ValueError, r"2-D array.*shape \(16,\)"),
    (np.zeros((0, 5), np.uint8), ValueError, r"no pixels: its shape is \(0, 5\)"),
    (np.zeros((4, 4)), TypeError, 'not float64.*astype'),
    (np.zeros((4, 4), bool), TypeError, "not bool"),
    (np.zeros((4, 4), np.int8), TypeError, "not int8"),
    (np.zeros((4, 4), ">u2"), TypeError, r'not >u2.*astype\("uint16"\)'),
    (np.zeros((4, 4), object), TypeError, "not object"),
    (np.zeros((4, 4), "M8[s]"), TypeError, "not datetime64"),
    (np.zeros((4, 4), [("x", "u1")]), TypeError, "dtype"),
    (np.zeros((4, 4), np.uint16), TypeError, "dtype uint16, but the design has 8 bits per pixel"),
    (np.zeros((1, 20000), np.uint8), ValueError, "16384"),
    ("street.png", ValueError, "2-D array"),
    (None, ValueError, "2-D array"),
]


@pytest.mark.parametrize("frame, error, message", WRONG, ids=[message for _, _, message in WRONG])
def test_what_is_no_frame_is_refused_and_changes_nothing(frame, error, message):
    camera = fv.Camera()
    with pytest.raises(error, match=message):
        camera.step(frame)
    assert camera.frames == 0
    good = np.arange(256, dtype=np.uint8).reshape(16, 16)
    camera.step(good)
    with pytest.raises((TypeError, ValueError)):
        camera.step(frame)
    assert camera.frames == 1 and equal(camera.step(good), after_two(good))


def after_two(frame):
    camera = fv.Camera()
    camera.step(frame)
    return camera.step(frame)


def test_pixels_must_fit_into_the_bits():
    camera = fv.Camera(frame={"pixel_bits": 5})
    with pytest.raises(ValueError, match=r"pixel \(3, 2\) is 32; the largest value of 5 bits is 31"):
        frame = np.zeros((8, 8), np.uint8)
        frame[2, 3] = 32
        camera.step(frame)
    deep = fv.Camera(frame={"pixel_bits": 10})
    with pytest.raises(TypeError, match="uint8, but the design has 10 bits.*uint16"):
        deep.step(np.zeros((8, 8), np.uint8))
    with pytest.raises(ValueError, match="is 1024; the largest value of 10 bits is 1023"):
        deep.step(np.full((8, 8), 1024, np.uint16))


def test_luma_is_that_of_footage(tmp_path):
    from PIL import Image

    colour = np.random.default_rng(2).integers(0, 256, (20, 30, 3), np.uint8)
    Image.fromarray(colour).save(tmp_path / "colour.png")
    (seen,) = fv.simulate(tmp_path / "colour.png")
    grey = fv.luma(colour)
    assert grey.shape == (20, 30) and np.array_equal(grey, seen.frame)
    assert np.array_equal(fv.luma(colour[::-1, ::2]), grey[::-1, ::2])
    with pytest.raises(ValueError, match=r"\(height, width, 3\)"):
        fv.luma(np.zeros((4, 4, 4), np.uint8))


@pytest.mark.parametrize(("frame", "error", "message"), [
    (np.zeros((4, 6, 3)), TypeError, r"array of uint8 with the shape \(height, width, 3\), not of float64; .*255 \* frame"),
    (np.zeros((4, 6, 3), np.float32), TypeError, "not of float32; for values from 0 to 1, numpy.uint8"),
    (np.zeros((4, 6, 3), np.uint16), TypeError, "not of uint16; for values of 16 bits"),
    (np.zeros((4, 6, 3), np.int64), TypeError, r"not of int64; .*astype\(\"uint8\"\)"),
    (np.zeros((4, 6, 3), bool), TypeError, "not of bool;"),
    ([[[1, 2, 3]]], TypeError, "not of int64"),
    (np.zeros((4, 6), np.uint8), ValueError, r"not \(4, 6\); it is grey already"),
    (np.zeros((4, 6, 4), np.uint8), ValueError, r"not \(4, 6, 4\); leave the fourth channel out"),
    (np.zeros((3, 4, 6), np.uint8), ValueError, r"not \(3, 4, 6\); put the channels last"),
    (np.zeros((9, 4, 6, 3), np.uint8), ValueError, r"not \(9, 4, 6, 3\); give the frames one by one"),
    (None, ValueError, r"not \(\)"),
])
def test_what_has_no_colours_is_refused_with_what_would_be_right(frame, error, message):
    with pytest.raises(error, match=message):
        fv.luma(frame)
