# SPDX-License-Identifier: BSD-3-Clause
"""The wheel: made of this build by the backend of pyproject.toml, installed without network into a fresh environment, used."""
import csv
import os
import pathlib
import subprocess
import sys
import zipfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["HELIXNAV_PROGRAM"]).parents[1]

pytest.importorskip("ensurepip")


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    assert done.returncode == 0, done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """With the system's NumPy, without the module."""
    folder = tmp_path_factory.mktemp("wheel") / "environment"
    run(sys.executable, "-m", "venv", "--system-site-packages", folder)
    return folder / "bin" / "python"


def test_the_wheel_installs_without_network_and_navigates(environment, tmp_path):
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    pip = (environment, "-m", "pip", "--no-input", "--disable-pip-version-check")
    run(*pip, "wheel", SOURCE, "--no-deps", "--no-index", "--no-build-isolation", "-w", tmp_path,
        "--config-settings", f"build-dir={BUILD}", env=clean)
    wheel, = tmp_path.glob("helixnav-*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert "helixnav/py.typed" in names and "helixnav/__init__.pyi" in names
    metadata, = (name for name in names if name.endswith("dist-info/METADATA"))
    licenses = [line.split()[1] for line in zipfile.ZipFile(wheel).read(metadata).decode().splitlines()
                if line.startswith("License-File:")]
    assert licenses == ["LICENSE", "copyright"]
    assert b"libClp" in zipfile.ZipFile(wheel).read(metadata.replace("METADATA", "copyright"))
    record, = (name for name in names if name.endswith("RECORD"))
    rows = csv.reader(zipfile.ZipFile(wheel).read(record).decode().splitlines())
    assert sorted(row[0] for row in rows) == sorted(names)
    run(*pip, "install", "--no-index", "--no-deps", wheel, env=clean)
    said = run(environment, "-c", "import helixnav; print(helixnav.__file__); "
               "print(len(helixnav.replay(helixnav.simulate('circuit', seed=1)).map))", env=clean, cwd=tmp_path)
    assert said.startswith(str(environment.parents[1])) and int(said.split()[-1]) > 10
    run(environment, SOURCE / "examples/python/tutorial.py", tmp_path / "picture.svg", env=clean, cwd=tmp_path)
    assert (tmp_path / "picture.svg").stat().st_size > 10_000
    run(*pip, "uninstall", "-y", "helixnav", env=clean)
