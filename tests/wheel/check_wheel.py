#!/usr/bin/env python3
"""Builds the wheel from pyproject.toml as pip does, installs it in a fresh virtual environment and runs the
Python tests against the installed modules.

Usage: check_wheel.py SOURCE FOLDER [--isolated]

FOLDER receives the build and both environments; if it is next to the ordinary build folder, relative paths
to the sources are the same, and the compiler cache of that build is used. The requirements of the build are
resolved in each run. By default they are installed in an environment of FOLDER instead of one with a random
name, so that a compiler cache works; --isolated leaves that to pip: exactly `pip install SOURCE`. Exit
status 77: a package could not be downloaded.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tomllib

SKIPPED = 77


def run(*words, **options):
    print("+", *words, flush=True)
    return subprocess.run([str(word) for word in words], **options).returncode


def create(environment):
    """A virtual environment without any package; returns its Python."""
    shutil.rmtree(environment, ignore_errors=True)
    subprocess.run([sys.executable, "-m", "venv", environment], check=True)
    return environment / "bin" / "python"


def pip(python, *words):
    return run(python, "-m", "pip", "--disable-pip-version-check", *words)


def install_by_parts(source, folder, python):
    """Installs the wheel, built in an environment that contains the build requirements alone."""
    with open(source / "pyproject.toml", "rb") as file:
        requirements = tomllib.load(file)["build-system"]["requires"]
    builder = create(folder / "builder")
    if pip(builder, "install", "--quiet", *requirements):
        return SKIPPED
    pip(builder, "list")
    wheels = folder / "dist"
    shutil.rmtree(wheels, ignore_errors=True)
    if pip(
        builder,
        "wheel",
        "--quiet",
        "--no-deps",
        "--no-build-isolation",
        "--wheel-dir",
        wheels,
        "--config-settings",
        f"build-dir={folder}",
        source,
    ):
        return 1
    return pip(python, "install", "--quiet", *wheels.glob("*.whl"))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--isolated", action="store_true")
    options = parser.parse_args()
    source, folder = options.source.resolve(), options.folder.resolve()
    for name in ("PYTHONPATH", "VIRTUAL_ENV"):
        os.environ.pop(name, None)
    folder.mkdir(parents=True, exist_ok=True)
    user = create(folder / "user")
    if pip(user, "install", "--quiet", "-r", source / "tests" / "requirements.txt"):
        print("the test requirements cannot be installed: no network?")
        return SKIPPED
    status = pip(user, "install", source) if options.isolated else install_by_parts(source, folder, user)
    if status:
        return status
    # From a folder without Kerf's sources: only the installed modules are found.
    where = subprocess.run(
        [user, "-c", "import kerf, cnc25d_api; print(kerf.__file__, cnc25d_api.__file__)"],
        cwd=folder,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    print(where)
    if any(not path.startswith(str(folder / "user")) for path in where.split()):
        print("the modules are not those of the wheel")
        return 1
    tests = sorted((source / "tests" / "python").glob("test_*.py"))
    return run(user, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", *tests, cwd=folder)


if __name__ == "__main__":
    sys.exit(main())
