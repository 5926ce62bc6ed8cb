"""What the tests share: strict numpy, and one offscreen GL context."""

import numpy as np
import pytest

from brdf_explorer.gpu import offscreen

np.seterr(all="raise")


@pytest.fixture(scope="session")
def gpu():
    with offscreen() as gpu:
        yield gpu
