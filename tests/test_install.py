"""What a person installs works: the wheel by itself, away from the checkout, and the script `run`."""

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).parents[1]
RUN = ROOT / "run"


def call(*command, **options):
    """Output of a command, both streams; fails the test with that output when the command fails."""
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300, **options)
    assert done.returncode == 0, f"{command} ended with {done.returncode}:\n{done.stdout}"
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from the source archive: what is missing from the archive is missing here too."""
    folder = tmp_path_factory.mktemp("dist")
    call(sys.executable, "-m", "build", "--outdir", str(folder), str(ROOT))
    (path,) = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Folder of the commands of a new environment that holds the wheel, and borrows only what it depends on."""
    folder = tmp_path_factory.mktemp("new")
    venv.create(folder, symlinks=True)
    scripts = folder / "bin"
    call(sys.executable, "-m", "pip", "--python", str(scripts / "python"), "install", "-q", "--no-deps", str(wheel))
    # Folders named in a .pth file come after the environment's own, and .pth files inside them are not read:
    # the checkout, which this environment knows by such a file, cannot be imported there.
    (site,) = folder.glob("lib/python*/site-packages")
    borrowed = [path for path in sys.path if path.endswith("-packages")]
    (site / "borrowed.pth").write_text("\n".join(borrowed) + "\n")
    return scripts


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """An empty working folder, with nothing in the environment that leads back to the checkout."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYTHONPATH", raising=False)
    return tmp_path


def test_wheel_holds_shaders_and_presets(wheel):
    held = set(ZipFile(wheel).namelist())
    for pattern in ("shaders/**/*.glsl", "shaders/**/*.frag", "shaders/**/*.vert", "presets/**/*.toml"):
        sources = [path.relative_to(ROOT).as_posix() for path in ROOT.glob(pattern)]
        assert sources
        assert {f"brdf_explorer/{name}" for name in sources} <= held


def test_wheel_leaves_out_the_checkout(wheel):
    tops = {name.split("/")[0] for name in ZipFile(wheel).namelist()}
    assert {name for name in tops if not name.endswith(".dist-info")} == {"brdf_explorer"}


def test_installed_package_is_the_wheels(installed, elsewhere):
    where = Path(call(installed / "python", "-c", "import brdf_explorer; print(brdf_explorer.__file__)").strip())
    assert where.is_relative_to(installed.parent)


def test_installed_command_renders(installed, elsewhere):
    call(installed / "brdf-explorer", "render", "gold", "--view", "sphere", "--size", "64x64", "-o", "x.png")
    with Image.open("x.png") as picture:
        assert picture.size == (64, 64)
        pixels = np.asarray(picture.convert("RGB"), dtype=float)
    assert pixels.std() > 5.0  # of 255: a sphere has light, shade and an outline
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50


@pytest.mark.parametrize("shell", ("sh", "dash", "bash"))
def test_run_parses(shell):
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell}")
    call(shell, "-n", RUN)


@pytest.fixture
def project(elsewhere):
    """A project folder with `run` and an environment that looks installed and only prints what it was given."""
    folder = elsewhere / "its own folder"
    scripts = folder / ".venv" / "bin"
    scripts.mkdir(parents=True)
    shutil.copy(RUN, folder)
    shutil.copy(ROOT / "pyproject.toml", folder)
    for stamp in ("installed", "installed-test"):
        shutil.copy(ROOT / "pyproject.toml", folder / ".venv" / stamp)
    (scripts / "pip").write_text(f"#!{folder.resolve()}/.venv/bin/python\n")
    for name in ("python", "brdf-explorer"):
        (scripts / name).write_text('#!/bin/sh\necho "$PWD|$*"\n')
        (scripts / name).chmod(0o755)
    return folder


def test_run_is_found_through_links_and_keeps_the_working_folder(project, elsewhere):
    (elsewhere / "one").symlink_to(Path(project.name) / "run")
    (elsewhere / "deep").mkdir()
    (elsewhere / "deep" / "two").symlink_to("../one")
    there = elsewhere.resolve() / "deep"
    environment = os.environ | {"CDPATH": str(elsewhere)}
    started = call("./two", "a", "b c", cwd=there, env=environment).splitlines()[-1]
    assert started == f"{there}|{project.resolve()}/.venv/bin/brdf-explorer a b c"
    tested = call("./two", "test", "-k", "x", cwd=there, env=environment).splitlines()[-1]
    assert tested == f"{project.resolve()}|-m pytest -k x"


@pytest.mark.parametrize("damage", ("moved", "no stamp", "old stamp", "no python", "killed while installing"))
def test_run_never_starts_a_doubtful_environment(project, elsewhere, damage):
    environment = project / ".venv"
    if damage == "moved":
        project = project.rename(elsewhere / "moved")
    elif damage == "no stamp":
        (environment / "installed").unlink()
    elif damage == "old stamp":
        (environment / "installed").write_text("[project]\n")
    elif damage == "no python":
        (environment / "bin" / "python").unlink()
        (environment / "bin" / "python").symlink_to(elsewhere / "gone")
    else:
        (environment / "installing").write_text("none\n")
    # With no Python and no network in reach `run` cannot mend it, and must say so.
    tools = elsewhere / "tools"
    tools.mkdir()
    for name in ("sh", "cat", "cmp", "cp", "dirname", "env", "grep", "id", "mkdir", "readlink", "rm", "sleep", "uname"):
        (tools / name).symlink_to(shutil.which(name))
    if damage in ("no stamp", "old stamp"):
        (environment / "bin" / "python").write_text('#!/bin/sh\n[ "$1 $2" != "-m pip" ]\n')
        expected = "pip failed"
    else:
        expected = "needs Python 3.11 or newer"
    done = subprocess.run([project / "run"], env={"PATH": str(tools)}, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert expected in done.stderr
    assert done.stdout == ""
