"""The comparison of pictures: what passes, what fails, and what a failure leaves behind."""

import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from brdf_explorer.compare import as_array, difference, read, write

RANDOM = np.random.default_rng(1)
GRADIENT = np.linspace(0, 1, 64)[:, None, None] * np.linspace(0.2, 1, 96)[:, None] * np.array([1, 0.8, 0.5])
PICTURES = {
    "sRGB": np.round(255 * GRADIENT).astype(np.uint8),
    "linear": (4 * GRADIENT).astype(np.float32),
    "with coverage": np.concatenate([GRADIENT, GRADIENT[..., :1]], axis=-1).astype(np.float32),
}


@pytest.fixture(params=PICTURES)
def golden(request):
    return PICTURES[request.param].copy()


def noise(shape, share):
    return RANDOM.random(shape) < share


def test_equal_pictures_pass(golden):
    assert difference(golden, golden.copy()).reason == ""


def test_the_last_bit_of_few_values_passes(golden):
    other = golden.copy()
    few = noise(golden.shape, 5e-4) & (golden > 0)
    other[few] = other[few] - 1 if golden.dtype == np.uint8 else np.nextafter(other[few], 0)
    assert not np.array_equal(other, golden)
    assert difference(other, golden).reason == ""


def test_what_is_seen_fails(golden):
    bright = golden.copy()
    bright[20:28, 20:28, :3] = golden.max()
    for other in (np.roll(golden, 3, axis=1), golden[::-1], golden[..., [2, 1, 0, *range(3, golden.shape[2])]], bright):
        found = difference(np.ascontiguousarray(other), golden)
        assert "FLIP" in found.reason
        assert found.map.shape == golden.shape[:2] and 0 <= found.map.min() and found.map.max() <= 1
    assert found.map[24, 24] > 0.1 and found.map[5, 80] < 0.05


def test_coverage_alone_counts():
    golden = PICTURES["with coverage"]
    other = golden.copy()
    other[..., 3] *= 0.9
    assert "FLIP" in difference(other, golden).reason


def test_shape_type_and_numbers_come_first(golden):
    assert "shape" in difference(golden[:-1], golden).reason
    assert "shape" in difference(golden[..., :2], golden).reason
    assert "values are float64" in difference(golden.astype(float), golden).reason
    if golden.dtype == np.float32:
        other = golden.copy()
        other[3, 4, 0], other[5, 6, 1] = np.nan, np.inf
        assert "it has 2 pixels that are not finite" in difference(other, golden).reason
        assert "the golden has 2 pixels that are not finite" in difference(golden, other).reason
        assert difference(other, golden).map.sum() == 2


@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_pictures_that_would_end_the_process_do_not(dtype):
    black = np.zeros((16, 16, 3), dtype)
    assert difference(black, black).reason == ""
    assert difference(black + dtype(100), black).reason
    assert difference(black, black + dtype(100)).reason
    one = np.full((1, 1, 3), 50, dtype)
    assert difference(one, one + dtype(100)).reason
    if dtype is np.float32:
        assert difference(black, black - 1).reason
        assert difference(black - 1, black).reason
        assert difference(black + 1, black - 1).reason


def test_statistics_forgive_places_but_not_colours(golden):
    noisy = golden.copy()
    noisy[::2] = golden[1::2]
    assert difference(noisy, golden).reason
    assert difference(noisy, golden, exact=False).reason == ""
    assert (
        "mean colours"
        in difference(golden // 2 if golden.dtype == np.uint8 else golden / 2, golden, exact=False).reason
    )
    assert difference(golden[:5, :3], golden[:5, :3] + golden.dtype.type(1), exact=False) is not None


def test_what_a_picture_may_be(tmp_path):
    grey = np.arange(12, dtype=np.uint8).reshape(3, 4)
    assert as_array(grey).shape == (3, 4, 3)
    assert as_array(grey / 2.0).dtype == np.float32
    assert as_array(Image.fromarray(grey)).shape == (3, 4, 3)
    assert as_array(Image.fromarray(grey).convert("RGBA")).shape == (3, 4, 4)
    Image.fromarray(grey).convert("P").save(tmp_path / "x.png")
    assert as_array(tmp_path / "x.png").dtype == np.uint8
    for bad in (np.zeros(3), np.zeros((2, 2, 2)), np.zeros((0, 2, 3)), grey.astype(int), grey > 3):
        with pytest.raises(ValueError, match="is no picture"):
            as_array(bad)


@pytest.mark.parametrize("name", PICTURES)
def test_goldens_are_kept_exactly(tmp_path, name):
    path = tmp_path / ("x.png" if PICTURES[name].dtype == np.uint8 else "x.exr")
    write(path, PICTURES[name][::-1, ::-1])
    np.testing.assert_array_equal(read(path), PICTURES[name][::-1, ::-1])


TEST = """
import numpy as np

def test_it(picture_regression):
    picture_regression.check(np.full((20, 30, 3), {value}, np.{dtype}), "plain")
"""


@pytest.mark.parametrize(("dtype", "suffix"), [("uint8", ".png"), ("float32", ".exr")])
def test_the_fixture_from_the_first_golden_to_a_failure(tmp_path, dtype, suffix):
    def run(value, *options):
        (tmp_path / "test_it.py").write_text(TEST.format(value=value, dtype=dtype))
        command = [sys.executable, "-m", "pytest", "-p", "brdf_explorer.compare", "-p", "no:cacheprovider", *options]
        alone = os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        done = subprocess.run(command, cwd=tmp_path, env=alone, capture_output=True, text=True, timeout=100)
        return done.returncode, done.stdout

    golden, failures = tmp_path / "goldens" / f"plain{suffix}", tmp_path / "failures"
    status, out = run(100)
    assert status == 1 and f"there is no golden {golden}" in out and "--picture-update" in out
    assert (failures / f"plain-picture{suffix}").exists() and not golden.exists()
    status, out = run(100, "--picture-update")
    assert status == 0 and str(golden) in out and golden.exists()
    status, out = run(100)
    assert status == 0
    status, out = run(200)
    assert status == 1 and "FLIP sees" in out and "Traceback" not in out
    for file in (f"plain-picture{suffix}", f"plain-expected{suffix}", "plain-difference.png"):
        assert str(failures / file) in out and (failures / file).exists()
    before = golden.stat().st_mtime_ns
    assert run(100, "--picture-update")[0] == 0 and golden.stat().st_mtime_ns == before
    assert run(200, "--picture-update")[0] == 0 and golden.stat().st_mtime_ns != before
    assert run(200)[0] == 0
