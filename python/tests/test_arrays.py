# SPDX-License-Identifier: MIT OR Apache-2.0
"""Arrays of every layout give the same frame, and other values are refused with a reason."""
import contextlib
import re
from pathlib import Path

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis.extra.numpy import arrays

import foveate as fv
from conftest import equal


def spread(pixels):
    """Returns the pixels in an array with a gap of one column between them."""
    wide = np.zeros((pixels.shape[0], 2 * pixels.shape[1]), pixels.dtype)
    wide[:, ::2] = pixels
    return wide[:, ::2]


def framed(pixels):
    """Returns the pixels inside of a larger array, with other values around."""
    return np.pad(pixels, ((3, 2), (5, 7)), constant_values=1)[3:-2, 5:-7]


def unaligned(pixels):
    """Returns the pixels at an odd address."""
    raw = b"\0" + pixels.tobytes()
    return np.frombuffer(raw, pixels.dtype, offset=1).reshape(pixels.shape)


def frozen(pixels):
    """Returns the pixels in a read-only array."""
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
    """Draws frames with sides of 1 to 40 pixels."""
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
    ("street.png", TypeError, "2-D array .*, not str; foveate.simulate reads files"),
    (Path("street.png"), TypeError, "2-D array .*, not P.*Path; foveate.simulate reads files"),
    (b"street", TypeError, "2-D array .*, not bytes"),
    (None, TypeError, "2-D array .*, not NoneType"),
    (3, TypeError, "2-D array .*, not int"),
    (object(), TypeError, "2-D array .*, not object"),
    (np.uint8(3), TypeError, "2-D array .*, not uint8"),
    (np.array(3, np.uint8), ValueError, r"not one of shape \(\)"),
    ([["a", "b"], ["c", "d"]], TypeError, "not <U1$"),
    ([[None, 1], [2, 3]], TypeError, "not object$"),
    ([[1, 2], [3]], ValueError, "2-D array .*; list cannot be read as one: .*inhomogeneous"),
    ([[1, 2], [3, 4]], TypeError, r'not int64; convert it, for example with frame.astype\("uint8"\)'),
    (np.zeros((4, 4), complex), TypeError, "not complex128$"),
    (np.ma.masked_array(np.zeros((4, 4), np.uint8), np.eye(4)), TypeError, r"4 values of the masked array are masked.*frame.filled\(0\)"),
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
    (np.zeros((4, 6, 3)), TypeError, r"array of uint8 with the shape \(height, width, 3\), not of float64; .*\(frame \* 255\)"),
    (np.zeros((4, 6, 3), np.float32), TypeError, "not of float32; .* for values from 0 to 1, "),
    (np.zeros((4, 6, 3), np.uint16), TypeError, "not of uint16; for values of 16 bits"),
    (np.zeros((4, 6, 3), np.int64), TypeError, r"not of int64; .*astype\(\"uint8\"\)"),
    (np.zeros((4, 6, 3), bool), TypeError, "not of bool; for black and white, "),
    ([[[1, 2, 3]]], TypeError, "not of int64"),
    (np.zeros((4, 6), np.uint8), ValueError, r"not \(4, 6\); it is grey already"),
    (np.zeros((4, 6, 4), np.uint8), ValueError, r"not \(4, 6, 4\); leave the fourth channel out"),
    (np.zeros((3, 4, 6), np.uint8), ValueError, r"not \(3, 4, 6\); put the channels last"),
    (np.zeros((9, 4, 6, 3), np.uint8), ValueError, r"not \(9, 4, 6, 3\); give the frames one by one"),
    (np.full((4, 6, 3), 200.0), TypeError, r"0 to 255, frame.round\(\).astype\(\"uint8\"\)"),
    (None, TypeError, r"\(height, width, 3\), not NoneType"),
    ("street.png", TypeError, r"\(height, width, 3\), not str"),
    (np.ma.masked_array(np.zeros((4, 6, 3), np.uint8), np.ones((4, 6, 3))), TypeError, "72 values of the masked array"),
])
def test_what_has_no_colours_is_refused_with_what_would_be_right(frame, error, message):
    with pytest.raises(error, match=message):
        fv.luma(frame)


CONVERTED = [
    # Values, bits of a pixel, and the pixels after the conversion that the message names.
    (np.array([[0.0, 0.25], [0.5, 1.0]]), 8, [[0, 64], [128, 255]]),
    (np.array([[0.0, 0.25], [0.5, 1.0]], np.float32), 10, [[0, 256], [512, 1023]]),
    (np.array([[0.0, 0.25], [0.5, 1.0]], np.float16), 4, [[0, 4], [8, 15]]),
    (np.array([[-1.0, 0.0], [0.5, 1.0]]), 8, [[0, 128], [191, 255]]),
    (np.array([[0.0, 17.4], [99.6, 255.0]]), 8, [[0, 17], [100, 255]]),
    (np.array([[0.0, 17.4], [99.6, 4000.0]]), 12, [[0, 17], [100, 4000]]),
    (np.array([[0, 17], [99, 255]], np.int64), 8, [[0, 17], [99, 255]]),
    (np.array([[0, 17], [99, 4000]], np.int32), 12, [[0, 17], [99, 4000]]),
    (np.array([[False, True], [True, False]]), 8, [[0, 255], [255, 0]]),
    (np.array([[False, True], [True, False]]), 10, [[0, 1023], [1023, 0]]),
    (np.array([[0, 17], [99, 4000]], ">u2"), 12, [[0, 17], [99, 4000]]),
]


@pytest.mark.parametrize("frame, bits, pixels", CONVERTED)
def test_the_conversion_of_the_message_makes_a_frame_that_is_taken(frame, bits, pixels):
    keys = {"frame": {"pixel_bits": bits}, "spatial": {"feature": "mad", "min_score": 0}, "temporal": {"min_count": 1}}
    camera = fv.Camera("bare", region={"size": 2}, **keys)
    with pytest.raises(TypeError) as refused:
        camera.step(frame)
    expression = re.split(r", (?:for example with )?", str(refused.value))[-1]
    converted = eval(expression, {"frame": frame})
    assert converted.tolist() == pixels, refused.value
    assert camera.step(converted).number == 0


def test_the_message_says_which_values_there_are():
    def refusal(frame):
        with pytest.raises(TypeError) as refused:
            fv.Camera().step(np.array(frame))
        return str(refused.value)

    assert "its values are 0.125 to 0.5: for values from 0 to 1, (frame * 255)" in refusal([[0.125, 0.5]])
    assert "its values are -7.5 to 300: pixels of 8 bits are 0 to 255, so scale them first" in refusal([[-7.5, 300.0]])
    assert "its values are -3 to 300: pixels of 8 bits are 0 to 255, so scale them first" in refusal([[-3, 300]])
    for wrong in (np.nan, np.inf, -np.inf):
        assert "values that are not numbers (NaN)" in refusal([[0.5, wrong]])


class Exchanged:
    """An object with an array that supports only DLPack."""

    def __init__(self, array, device=(1, 0)):
        self._array, self._device = array, device

    def __dlpack__(self, **options):
        return self._array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._device


def check_that_both_are_frames(exchange):
    """Checks a grey frame and one in colour, given as `exchange` gives arrays to others."""
    pixels = np.random.default_rng(3).integers(0, 256, (20, 30), np.uint8)
    assert equal(fv.Camera().step(exchange(pixels)), fv.Camera().step(pixels))
    colour = np.stack([pixels, pixels, pixels], axis=2)
    assert np.array_equal(fv.luma(exchange(colour)), fv.luma(colour))
    with pytest.raises(TypeError, match="not float32; .* from 0 to 1, "):
        fv.Camera().step(exchange(np.zeros((4, 4), np.float32)))


def test_what_dlpack_gives_is_a_frame():
    check_that_both_are_frames(Exchanged)
    pixels = np.zeros((20, 30), np.uint8)
    with pytest.raises(TypeError, match=r"in the memory of the processor; this Exchanged lies on another device \(DLPack device type 2\).*cpu\(\)"):
        fv.Camera().step(Exchanged(pixels, (2, 0)))


def test_a_memoryview_is_a_frame():
    pixels = np.random.default_rng(3).integers(0, 256, (20, 30), np.uint8)
    assert equal(fv.Camera().step(memoryview(pixels)), fv.Camera().step(pixels))


def test_a_tensor_is_a_frame():
    check_that_both_are_frames(pytest.importorskip("torch").from_numpy)


def test_an_array_that_cannot_be_made_is_a_type_error():
    class Broken:
        def __array__(self, dtype=None, copy=None):
            raise RuntimeError("it lies elsewhere")

    with pytest.raises(TypeError, match="a frame is a 2-D array .*; Broken cannot be read as one: it lies elsewhere"):
        fv.Camera().step(Broken())


def test_masks_that_mask_nothing_are_no_matter():
    pixels = np.random.default_rng(4).integers(0, 256, (20, 30), np.uint8)
    masked = np.ma.masked_array(pixels, np.zeros((20, 30)))
    assert equal(fv.Camera().step(masked), fv.Camera().step(pixels))
    with contextlib.suppress(TypeError):
        fv.Camera().step(np.ma.masked_equal(pixels, pixels[0, 0]))
        pytest.fail("a masked pixel was taken")
