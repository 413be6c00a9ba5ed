"""The library in other projects: installed with its CMake package and its pkg-config file, or as a folder."""
import json
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

BUILD = Path(os.environ["KERF"]).resolve().parent
SOURCE = Path(__file__).parents[2]
EXAMPLE = SOURCE / "examples" / "cxx" / "plate.cpp"
PROGRAM = SOURCE / "examples" / "plate.gcmc"
STRICT = ["-Wall", "-Wextra", "-Werror"]

LISTS = """cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
{find}
add_executable(plate "{example}")
target_compile_options(plate PRIVATE -Wall -Wextra -Werror)
target_link_libraries(plate PRIVATE kerf::kerf)
"""


def run(*words, cwd=None, timeout=300):
    done = subprocess.run([str(w) for w in words], cwd=cwd, capture_output=True, text=True, timeout=timeout)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


def makes_the_part(program, folder):
    """The example writes G-code and a picture and names its time."""
    out = run(program, PROGRAM, "plate.nc", "plate.png", cwd=folder)
    assert "steps, about 0.3 minutes" in out
    assert (folder / "plate.png").read_bytes().startswith(b"\x89PNG")


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    if not (BUILD / "cmake_install.cmake").exists() or shutil.which("cmake") is None:
        pytest.skip("the command is not in its build folder, or CMake is missing")
    run("cmake", "--build", BUILD, "--target", "kerf_archive")
    folder = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", BUILD, "--prefix", folder, "--component", "library")
    return folder


def test_an_installed_library_is_found_by_cmake(prefix, tmp_path):
    find = "find_package(kerf REQUIRED)"
    (tmp_path / "CMakeLists.txt").write_text(LISTS.format(find=find, example=EXAMPLE))
    run("cmake", "-S", tmp_path, "-B", tmp_path / "out", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "out")
    makes_the_part(tmp_path / "out" / "plate", tmp_path)


def test_an_installed_library_is_found_by_pkg_config(prefix, tmp_path):
    if shutil.which("pkg-config") is None:
        pytest.skip("pkg-config is missing")
    path = next(prefix.glob("lib*/**/kerf.pc")).parent
    words = ["pkg-config", "--static", "--cflags", "--libs", "kerf"]
    done = subprocess.run(words, capture_output=True, text=True,
                          check=True, env={**os.environ, "PKG_CONFIG_PATH": str(path)})
    flags = done.stdout.split()
    run(os.environ.get("CXX", "g++"), *STRICT, EXAMPLE, "-o", "plate", *flags, cwd=tmp_path)
    makes_the_part(tmp_path / "plate", tmp_path)


def test_each_public_header_compiles_alone(prefix):
    include = prefix / "include"
    headers = sorted((include / "kerf").rglob("*.h"))
    assert len(headers) > 40

    def messages(header):
        words = ["g++", "-std=c++20", "-fsyntax-only", *STRICT, f"-I{include}", "-include", header]
        done = subprocess.run([*words, "-x", "c++", os.devnull], capture_output=True, text=True, timeout=120)
        return done.stderr

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        assert "".join(pool.map(messages, headers)) == ""


def test_a_project_adds_the_folder(tmp_path):
    """Its own program is compiled; the library, which takes minutes, is only planned."""
    if shutil.which("ninja") is None:
        pytest.skip("ninja is missing")
    find = f'add_subdirectory("{SOURCE}" kerf)'
    (tmp_path / "CMakeLists.txt").write_text(LISTS.format(find=find, example=EXAMPLE))
    out = tmp_path / "out"
    run("cmake", "-G", "Ninja", "-S", tmp_path, "-B", out, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    commands = json.loads((out / "compile_commands.json").read_text())
    (own,) = [c for c in commands if c["file"] == str(EXAMPLE)]
    (out / "CMakeFiles/plate.dir").joinpath(*EXAMPLE.parent.parts[1:]).mkdir(parents=True, exist_ok=True)
    run("sh", "-c", own["command"], cwd=own["directory"])
    assert "libkerf.a" in run("ninja", "-C", out, "-t", "inputs", "plate")
    built = run("ninja", "-C", out, "-t", "targets", "all")
    assert "test_base" not in built and "_kerf.cpython" not in built
