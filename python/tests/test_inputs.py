# SPDX-License-Identifier: MIT OR Apache-2.0
"""Inputs that are not plain images or video: numbered images, archives, raw video, mosaics, and times from a file."""
import io
import subprocess
import zipfile

import numpy as np
import pytest
from PIL import Image

import foveate as fv


@pytest.fixture
def clip(tmp_path):
    """Makes a clip of four frames in every form, and returns its frames."""
    generator = np.random.default_rng(3)
    frames = generator.integers(0, 256, (4, 16, 24), np.uint8)
    with zipfile.ZipFile(tmp_path / "clip.zip", "w") as archive:
        for number, frame in enumerate(frames):
            Image.fromarray(frame).save(tmp_path / f"f{number:02}.png")
            file = io.BytesIO()
            Image.fromarray(frame).save(file, "png")
            archive.writestr(f"f{number:02}.png", file.getvalue())
    (tmp_path / "clip.raw").write_bytes(frames.tobytes())
    (tmp_path / "times.txt").write_text("0\n40\n80\n200\n")
    return frames


def test_every_form_of_a_clip_gives_its_frames(clip, tmp_path):
    times = {"timestamps": tmp_path / "times.txt", "timestamp_unit": "ms"}
    forms = {"f%02d.png": {}, "clip.zip": {}, "clip.raw": {"raw": "24x16,gray"}}
    for name, options in forms.items():
        outcomes = list(fv.simulate(tmp_path / name, "paper", **options, **times))
        assert np.array_equal([outcome.frame for outcome in outcomes], clip), name
        assert [outcome.time_us for outcome in outcomes] == [0, 40_000, 80_000, 200_000], name


def test_options_of_inputs_are_those_of_the_command(clip, command, tmp_path):
    image = Image.fromarray(clip[0])
    exif = image.getexif()
    exif[0x0112] = 6
    image.save(tmp_path / "turned.png", exif=exif)
    for name, options, words in (
        ("f00.png", {"bayer": "grbg"}, ["--bayer", "grbg"]),
        ("turned.png", {"orientation": "upright"}, ["--orientation", "upright"]),
    ):
        (outcome,) = fv.simulate(tmp_path / name, "bare", **options)
        command("simulate", tmp_path / name, "--preset", "bare", "-o", tmp_path / "out", "--force", "--quiet", *words)
        assert np.array_equal(outcome.scores["edge"], np.load(tmp_path / "out/score_edge.npy")[0])
    (turned,) = fv.simulate(tmp_path / "turned.png", "bare", orientation="upright")
    assert np.array_equal(turned.frame, np.rot90(clip[0], -1))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"raw": "24x16"}, ValueError, "a size and a pixel format"),
        ({"bayer": "rgb"}, ValueError, '"rggb"'),
        ({"orientation": "up"}, ValueError, '"upright"'),
        ({"timestamps": "none.txt"}, (ValueError, OSError), "none.txt"),
        ({"timestamps": "none.txt", "timestamp_unit": "min"}, ValueError, '"ms"'),
        ({"timestamp_unit": "ms"}, TypeError, "timestamps, which are not given"),
    ],
)
def test_wrong_options_are_refused(clip, tmp_path, options, error, message):
    with pytest.raises(error, match=message):
        fv.simulate(tmp_path / "f%02d.png", "bare", **options)


def test_a_stream_of_several_is_told_of_and_chosen(tmp_path):
    path = tmp_path / "two.mkv"
    sources = [word for shade in ["black", "white"] for word in ["-f", "lavfi", "-i", f"color={shade}:size=32x16:rate=5:duration=1"]]
    subprocess.run(["ffmpeg", "-v", "error", *sources, "-map", "0", "-map", "1", "-c:v", "ffv1", path], check=True)
    with pytest.warns(UserWarning, match="two.mkv` has 2 video streams.*--video-stream reads another one"):
        assert [outcome.frame.max() < 32 for outcome in fv.simulate(path, "paper")] == [True] * 5
    assert [outcome.frame.min() > 200 for outcome in fv.simulate(path, "paper", video_stream=1)] == [True] * 5
    with pytest.raises(ValueError, match="it has no video stream 2"):
        fv.simulate(path, "paper", video_stream=2)
