#!/usr/bin/env python3
"""Makes sdist and wheel, installs the wheel in a fresh virtual environment, and runs what a user runs: the
commands of README, `kerf run`, `kerf view`, and the Python tests.

Usage: check_wheel.py SOURCE FOLDER [--isolated] [--wheel FILE]

FOLDER receives the build and the environments; see cmake/package/make_wheel.py, also for --isolated and exit
status 77. --wheel checks a wheel that has been made before.
"""

import argparse
import email
import importlib.util
import os
import pathlib
import subprocess
import sys
import urllib.request
import zipfile


def load_maker(source):
    """The module make_wheel, which is not part of a package."""
    spec = importlib.util.spec_from_file_location("make_wheel", source / "cmake/package/make_wheel.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def expect(condition, what):
    print("ok    " if condition else "WRONG ", what, flush=True)
    if not condition:
        raise SystemExit(f"check_wheel: {what}")


def output(folder, *words, status=0, **options):
    """The standard output of a command that must end with this status."""
    command = [str(word) for word in words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, **options)
    expect(done.returncode == status, f"{' '.join(command)}: status {done.returncode} {done.stderr[-500:]}")
    return done.stdout


def check_contents(wheel, version):
    """Metadata by PEP 639, the command with its documents, and the licences of all that is inside."""
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = email.message_from_bytes(archive.read(next(n for n in names if n.endswith("/METADATA"))))
    expect((metadata["Name"], metadata["Version"]) == ("kerf-cam", version), "name and version")
    expect(metadata["License-Expression"] == "Apache-2.0", "License-Expression")
    licences = metadata.get_all("License-File")
    expect({"LICENSE", "NOTICE", "licences/three.js.txt"} <= set(licences), "License-File")
    for name in licences:
        expect(any(n.endswith(f".dist-info/licenses/{name}") for n in names), f"the text of {name}")
    # Each library that auditwheel has added, libfmt-0a1b2c.so.9, has its licence.
    others = {"crypto": "openssl", "ssl": "openssl", "hwy": "highway", "bz2": "bzip2", "z": "zlib",
              "png16": "libpng", "jpeg": "libjpeg-turbo",
              "brotlicommon": "brotli", "brotlidec": "brotli", "brotlienc": "brotli"}
    for name in names:
        if ".libs/lib" not in name:
            continue
        library = pathlib.PurePath(name).name[len("lib"):].split(".")[0].rsplit("-", 1)[0]
        expect(f"licences/{others.get(library, library)}.txt" in licences, f"the licence of {library}")
    for ending in ("kerf_cam/bin/kerf", "kerf_cam/stand_in/openscad.py", "share/man/man1/kerf.1.gz",
                   "share/bash-completion/completions/kerf", "share/doc/kerf/docs/manual/command.md",
                   "share/kerf/machines/grbl_router.toml"):
        expect(any(n.endswith(ending) for n in names), ending)
    expect("openscad.py" not in names, "the stand-in is not where a real openscad would be installed")


def check_modules(python, folder, version):
    """The modules are those of the environment, and the stand-in makes way for a real module."""
    code = "import kerf, kerf_cam, cnc25d_api, gcodepreview; print(kerf.__version__)\n"
    code += "print(kerf.__file__, cnc25d_api.__file__, kerf_cam.command())"
    first, second = output(folder, python, "-c", code).splitlines()
    expect(first == version, "kerf.__version__")
    own = [path.startswith(str(python.parents[1])) for path in second.split()]
    expect(all(own), "the modules of the wheel")
    name = "import openscad; print(openscad.__file__)"
    expect("stand_in" in output(folder, python, "-c", name), "a stand-in for openscad")
    site = output(folder, python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip()
    real = pathlib.Path(site, "openscad.py")
    real.write_text("")
    expect(output(folder, python, "-c", name).strip() == str(real), "a real openscad wins")
    real.unlink()


def check_view(kerf, folder, source):
    """Starts the server, gets the page, and stops it."""
    words = [kerf, "view", source / "examples/demo.nc"]
    server = subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, text=True)
    try:
        address = server.stdout.readline().strip()
        page = urllib.request.urlopen(address, timeout=60).read().decode()
        expect("<script" in page, f"the page of {address.split('?')[0]}")
        expect("full page" in output(folder, kerf, "--version"), "the page with its controls")
    finally:
        server.terminate()
    expect(server.wait(timeout=60) is not None, "kerf view ends")


def check_command(python, folder, source, version):
    kerf = python.parent / "kerf"
    for words in ([kerf], [python, "-m", "kerf"], [python, "-m", "kerf_cam"]):
        expect(output(folder, *words, "--version").splitlines()[0] == f"kerf {version}", "the version")
    script = folder / "part.py"
    script.write_text("import kerf, numpy, sys\nprint(sys.prefix)\n")
    # Without an activated environment: the script runs with the Python that has the modules.
    prefix = output(folder, kerf, "run", script).strip()
    expect(prefix == str(python.parents[1]), "kerf run uses the Python of the wheel")
    expect("grbl" in output(folder, kerf, "post", "--list"), "posts")
    output(folder, kerf, "info", "--machine", "grbl_router", source / "examples/demo.nc")
    check_view(kerf, folder, source)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--isolated", action="store_true")
    parser.add_argument("--wheel", type=pathlib.Path)
    options = parser.parse_args()
    source, folder = options.source.resolve(), options.folder.resolve()
    for name in ("PYTHONPATH", "VIRTUAL_ENV", "KERF_PYTHON"):
        os.environ.pop(name, None)
    folder.mkdir(parents=True, exist_ok=True)
    maker = load_maker(source)
    status, wheel = 0, options.wheel
    if wheel is None:
        status, _, wheel = maker.make(source, folder, options.isolated)
    if status:
        return status
    version = (source / "VERSION").read_text().strip()
    check_contents(wheel, version)
    user = maker.create(folder / "user")
    if maker.pip(user, "install", "--quiet", wheel):
        return 1
    check_modules(user, folder, version)
    check_command(user, folder, source, version)
    if maker.pip(user, "install", "--quiet", "-r", source / "tests" / "requirements.txt"):
        print("the test requirements cannot be installed: no network?")
        return maker.SKIPPED
    tests = sorted((source / "tests" / "python").glob("test_*.py"))
    tests += [source / "tests" / "e2e" / name for name in ("test_readme.py", "test_version.py")]
    return maker.run(user, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", *tests, cwd=folder,
                     env={**os.environ, "KERF": str(user.parent / "kerf")})


if __name__ == "__main__":
    sys.exit(main())
