"""Who imports whom: the contracts of pyproject.toml, and what a plain import may cost."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

SLOW = {"scipy", "matplotlib", "imgui_bundle", "glfw", "PIL", "OpenEXR", "moderngl", "rich"}
"""Packages that are imported where they are used, so that the library and the command line start without them."""


def test_layers():
    """import-linter keeps the contracts."""
    code = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(no_cache=True))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


def loaded_by(module):
    """The modules that importing one loads, in a process of its own."""
    code = f"import sys, {module}; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


@pytest.mark.parametrize(
    "module", ["brdf_explorer", "brdf_explorer.models", "brdf_explorer.state", "brdf_explorer.cli"]
)
def test_import_is_light(module):
    assert not loaded_by(module) & SLOW


def test_command_line_starts_without_the_window():
    assert not {name for name in loaded_by("brdf_explorer.cli") if name.startswith("brdf_explorer.ui")}


def test_package_alone_imports_nothing():
    assert {name for name in loaded_by("brdf_explorer") if name.startswith("brdf_explorer.")} == set()
