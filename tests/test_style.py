"""The code is formatted and linted by ruff."""

import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize("command", [("check",), ("format", "--check")])
def test_ruff(command):
    pytest.importorskip("ruff")
    root = Path(__file__).parents[1]
    done = subprocess.run([sys.executable, "-m", "ruff", *command, "--no-cache", root], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
