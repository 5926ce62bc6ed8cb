"""OpenGL contexts without a window, and functions evaluated over tables."""

import ctypes.util
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from brdf_explorer.glsl import Signature
from brdf_explorer.gpu import offscreen
from brdf_explorer.models import MODELS

WO, WI = np.array([0.6, 0.0, 0.8]), np.array([[-0.6, 0.0, 0.8], [0.0, 0.28, 0.96]])
VALUES = """
import sys
from brdf_explorer.gpu import offscreen
from brdf_explorer.models import MODELS
import numpy as np
with offscreen() as gpu:
    wo, wi = np.array([0.6, 0.0, 0.8]), np.array([[-0.6, 0.0, 0.8], [0.0, 0.28, 0.96]])
    np.save(sys.argv[1], gpu.f(MODELS["microfacet"](), wo, wi))
"""


@pytest.mark.skipif(not ctypes.util.find_library("OSMesa"), reason="libOSMesa is not installed")
def test_osmesa_serves_where_egl_is_missing(gpu, tmp_path):
    environment = os.environ | {"GLCONTEXT_LINUX_LIBEGL": "missing.so", "PYTHONPATH": str(Path(__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-c", VALUES, tmp_path / "f.npy"], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    np.testing.assert_allclose(np.load(tmp_path / "f.npy"), gpu.f(MODELS["microfacet"](), WO, WI), rtol=1e-5)


def test_offscreen_within_offscreen_is_the_same(gpu):
    with offscreen() as inner:
        assert inner is gpu
    np.testing.assert_allclose(gpu.f(MODELS["microfacet"](), WO, WI), MODELS["microfacet"]().f(WO, WI), rtol=1e-5)


@pytest.mark.parametrize("shape", [(), (1,), (2500,), (3, 1, 7)])
def test_values_have_the_shape_of_their_arguments(gpu, shape):
    model = MODELS["microfacet"]()
    wi = np.broadcast_to(WI[0], (*shape, 3))
    f, pdf = gpu.f(model, WO, wi), gpu.pdf(model, WO, wi)
    assert f.shape == (*shape, 3) and pdf.shape == shape and f.dtype == np.float32
    np.testing.assert_allclose(f, model.f(WO, wi), rtol=1e-5)
    drawn, weight = gpu.sample_f(model, WO, np.full((*shape, 2), 0.3))
    assert drawn.shape == weight.shape == (*shape, 3)


def test_a_signature_is_what_it_says():
    signature = Signature("vec3 sample_f(vec3 wo, vec2 u, out vec3 wi)")
    assert [kind.components for kind in signature.outputs] == [3, 3]


def test_targets_are_kept_while_their_form_stays(gpu):
    first = gpu.target("test", (8, 4))
    assert gpu.target("test", (8, 4)) is first
    assert not np.any(gpu.pixels(first))  # new ones are clear
    assert gpu.target("test", (4, 4)) is not first
