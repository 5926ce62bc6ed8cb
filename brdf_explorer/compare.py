"""Pictures against goldens, as a fixture of pytest: equality first, then the visible difference by NVIDIA FLIP.

Installing brdf_explorer gives pytest the fixture `picture_regression`. A test of one's own program:

    def test_start_page(picture_regression):
        picture_regression.check(screenshot(), "start_page")

`screenshot()` is an array (H, W), (H, W, 3) or (H, W, 4), first row at the top: uint8 is sRGB as on a screen, floats are
linear light; or a Pillow image, or the path of a picture. Its golden is goldens/start_page.png beside the test's file, .exr
for floats. It passes if it equals the golden, or if FLIP sees no difference: at most 5e-4 on average and 0.03 in a pixel. If
not, the folder failures/ beside the test's file gets the picture, the one expected and a map of the difference, and the
message names them. `pytest --picture-update` writes the goldens that are missing or differ; look at them, then commit them.

Another GPU or driver rounds otherwise, so goldens need one renderer everywhere, such as Mesa's llvmpipe. On others,
`check(picture, name, exact=False)` compares the mean colours of a coarse grid instead.

FLIP, by the package flip-evaluator: Andersson et al. 2020 for sRGB, 2021 for linear light.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from .lib.colormap import viridis

# of FLIP: versions and instruction sets of one renderer differ by a third of that, a visible change by many times
MEAN, LARGEST = 5e-4, 0.03
CELLS = 8  # along each side of the grid of mean colours
CELL = 0.02  # largest difference of a cell's mean, as a share of the golden's largest value


@dataclass(frozen=True)
class Difference:
    """How two pictures differ. reason: "" if they pass; map: (H, W) from 0 to 1, or None if there is none."""

    reason: str
    map: np.ndarray | None = None


def difference(picture, golden, exact=True):
    """The Difference of two arrays (H, W, C), both uint8 or both float32; exact=False compares mean colours of a grid."""
    if picture.dtype != golden.dtype:
        return Difference(f"its values are {picture.dtype}, those of the golden {golden.dtype}")
    if picture.shape != golden.shape:
        return Difference(f"its shape is {picture.shape}, that of the golden {golden.shape}")
    for what, array in (("it", picture), ("the golden", golden)):
        wrong = ~np.isfinite(array).all(axis=-1)
        if wrong.any():
            return Difference(f"{what} has {np.count_nonzero(wrong)} pixels that are not finite", wrong.astype(float))
    if np.array_equal(picture, golden):
        return Difference("")
    return by_flip(picture, golden) if exact else by_grid(picture, golden)


def by_flip(picture, golden):
    seen = flip(picture, golden)
    mean, largest = float(seen.mean()), float(seen.max())
    if mean <= MEAN and largest <= LARGEST:
        return Difference("")
    limits = f"limits {MEAN:g} and {LARGEST:g}"
    return Difference(f"FLIP sees a difference of {mean:.2g} on average and {largest:.2g} in a pixel, {limits}", seen)


def flip(picture, golden):
    """FLIP's map (H, W) from 0 to 1, with the difference of the alpha channels where that is larger."""
    import flip_evaluator

    linear = golden.dtype != np.uint8
    picture, golden = (a.astype(np.float32) / (1 if linear else 255) for a in (picture, golden))
    a, b = (np.ascontiguousarray(array[..., :3]) for array in (picture, golden))
    if linear and (b.max() <= 0 or min(a.min(), b.min()) < 0):
        # FLIP for linear light ends the process on a black golden, and knows no negative light
        seen = np.abs(a - b).max(axis=-1) / max(float(np.abs(b).max()), 1e-30)
    else:
        seen = flip_evaluator.evaluate(b, a, "HDR" if linear else "LDR", applyMagma=False, computeMeanError=False)[0]
    return np.clip(
        np.maximum(seen.reshape(b.shape[:2]), np.abs(picture - golden)[..., 3:].max(axis=-1, initial=0)), 0, 1
    )


def by_grid(picture, golden):
    """Difference of the mean colours in CELLS x CELLS parts, which other drivers hardly change."""
    a, b = (grid_means(array.astype(float)) for array in (picture, golden))
    cells = np.abs(a - b).max(axis=-1) / (255 if golden.dtype == np.uint8 else max(float(np.abs(golden).max()), 1e-30))
    if cells.max() <= CELL:
        return Difference("")
    return Difference(
        f"mean colours of its parts differ by up to {cells.max():.2g}, limit {CELL:g}", np.clip(cells, 0, 1)
    )


def grid_means(array):
    rows = [part for part in np.array_split(array, CELLS, axis=0) if part.size]
    return np.array([[c.mean(axis=(0, 1)) for c in np.array_split(r, CELLS, axis=1) if c.size] for r in rows])


# --- files -----------------------------------------------------------------------------------------------------------


def as_array(picture):
    """(H, W, 3 or 4) of uint8 or float32 of an array, a Pillow image or the path of a picture. Raises ValueError."""
    if isinstance(picture, str | Path):
        return read(Path(picture))
    if hasattr(picture, "convert"):  # of Pillow
        plain = picture.mode in ("RGB", "L", "1") and "transparency" not in picture.info
        picture = np.asarray(picture.convert("RGB" if plain else "RGBA"))
    picture = np.asarray(picture)
    if picture.ndim == 2:
        picture = np.stack([picture] * 3, axis=-1)
    if picture.ndim != 3 or picture.shape[2] not in (3, 4) or picture.size == 0:
        raise ValueError(f"an array of shape {picture.shape} is no picture: (H, W), (H, W, 3) or (H, W, 4) expected")
    if picture.dtype == np.uint8:
        return picture
    if picture.dtype.kind != "f":
        raise ValueError(f"an array of {picture.dtype} is no picture: uint8 or floats expected")
    return picture.astype(np.float32)


def read(path):
    if path.suffix.lower() == ".exr":
        import OpenEXR

        with OpenEXR.File(str(path)) as file:
            (pixels,) = (channel.pixels for channel in file.channels().values())
            return as_array(pixels.copy())
    from PIL import Image

    with Image.open(path) as image:
        return as_array(image)


def write(path, array):
    """Write .exr for floats, else .png."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if array.dtype == np.uint8:
        from PIL import Image

        Image.fromarray(np.ascontiguousarray(array)).save(path)
        return
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGBA"[: array.shape[2]]: np.ascontiguousarray(array)}).write(str(path))


def heat(map, shape):
    """A map (h, w) from 0 to 1 as colours (H, W, 3), dark to bright; its square root, so that small differences show."""
    rows, columns = (np.arange(n) * m // n for n, m in zip(shape, map.shape, strict=True))
    return np.round(255 * viridis(np.sqrt(map[rows][:, columns]))).astype(np.uint8)


# --- the fixture -----------------------------------------------------------------------------------------------------


def pytest_addoption(parser):
    group = parser.getgroup("pictures")
    group.addoption("--picture-update", action="store_true", help="write goldens that are missing or differ")


class PictureRegression:
    """Compares pictures with goldens/ beside a test's file; see the module."""

    def __init__(self, folder, update, written, rerun):
        self.goldens = folder / "goldens"
        self.failures = folder / "failures"
        self.update = update
        self.written = written
        self.rerun = rerun

    def check(self, picture, name, exact=True):
        """Fail the test if the picture differs from the golden of that name. Raises ValueError for what is no picture."""
        if not re.fullmatch(r"[\w.-]+", name):
            raise ValueError(f"{name!r} is no name for a golden: letters, digits, _ . and - expected")
        picture = as_array(picture)
        suffix = ".png" if picture.dtype == np.uint8 else ".exr"
        path = self.goldens / f"{name}{suffix}"
        found = None
        if path.exists():
            golden = read(path)
            found = difference(picture, golden, exact)
        if self.update and exact and (found is None or found.reason):
            if not np.isfinite(picture).all():
                pytest.fail(f"{name}: not written as a golden: it has pixels that are not finite", pytrace=False)
            write(path, picture)
            self.written.append(path)
            return
        if found is not None and not found.reason:
            return
        files = {self.failures / f"{name}-picture{suffix}": picture}
        if found is None:
            reason = f"there is no golden {path}; make it: {self.rerun}"
        else:
            reason = found.reason
            files[self.failures / f"{name}-expected{suffix}"] = golden
            if found.map is not None:
                files[self.failures / f"{name}-difference.png"] = heat(found.map, picture.shape[:2])
        for file, array in files.items():
            write(file, array)
        names = "".join(f"\n  {file}" for file in files)
        again = "" if found is None else f"\nIf the new one is right: {self.rerun}"
        pytest.fail(f"{name}: {reason}{names}{again}", pytrace=False)


WRITTEN = pytest.StashKey[list]()


def pytest_configure(config):
    config.stash[WRITTEN] = []


@pytest.fixture
def picture_regression(request):
    """`check(picture, name)` compares a picture with its golden; see brdf_explorer.compare."""
    rerun = f"pytest --picture-update '{request.node.nodeid}'"
    update = request.config.getoption("--picture-update")
    return PictureRegression(request.path.parent, update, request.config.stash[WRITTEN], rerun)


def pytest_terminal_summary(terminalreporter, config):
    if config.stash[WRITTEN]:
        terminalreporter.section("goldens written: look at them")
        for path in config.stash[WRITTEN]:
            terminalreporter.line(str(path))
