"""Every example of a cutting job is accepted by the rules of GRBL and by LinuxCNC's interpreter (rs274)."""
import importlib.util
from pathlib import Path

import pytest
from conftest import cut_operations

ROOT = Path(__file__).parents[2]
JOBS = sorted(path.stem for path in (ROOT / "examples").glob("*.toml"))
MILLED, LASERS = cut_operations(laser=False), cut_operations(laser=True)


@pytest.fixture(scope="module")
def rs274():
    spec = importlib.util.spec_from_file_location("rs274", ROOT / "tests" / "conformance" / "rs274.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_jobs_and_operations_are_there():
    assert {"pocket", "vcarve-floor", "raster"} <= set(MILLED) and {"laser-cut", "laser-test"} <= set(LASERS)
    assert {"adaptive", "inlay", "rest", "shell", "text"} <= set(JOBS)


def accepted(kerf, folder, job, rs274):
    """By GRBL's rules, which a post for it applies to what it writes, and by rs274."""
    grbl = kerf("cut", job, "--to", "grbl", "-o", "grbl.nc", "--json")
    assert grbl.status == 0, grbl.out
    assert [d for d in grbl.json["diagnostics"] if d["severity"] == "error"] == []
    assert max(len(line) for line in (folder / "grbl.nc").read_text().splitlines()) <= 80
    linuxcnc = kerf("cut", job, "--to", "linuxcnc", "-o", "linuxcnc.ngc")
    assert linuxcnc.status == 0, linuxcnc.err
    if not rs274.is_installed():
        pytest.skip("rs274 is not installed")
    text = (folder / "linuxcnc.ngc").read_text()
    numbers = sorted({int(word[1:]) for word in text.split() if word[0] == "T" and word[1:].isdigit()})
    tools = "".join(f"T{n} P{i + 1} D3\n" for i, n in enumerate(numbers))
    moves, error = rs274.moves_of(text, tools)
    assert error is None
    assert len(moves) > 3


@pytest.mark.parametrize("op", MILLED)
def test_the_example_of_an_operation(kerf, program, tmp_path, rs274, op):
    accepted(kerf, tmp_path, program(kerf("cut", "--example", op).out, "job.toml"), rs274)


@pytest.mark.parametrize("name", JOBS)
def test_a_job_of_the_examples(kerf, tmp_path, rs274, name):
    accepted(kerf, tmp_path, ROOT / "examples" / (name + ".toml"), rs274)


@pytest.mark.parametrize("op", LASERS)
def test_the_example_of_a_laser(kerf, program, op):
    file = program(kerf("cut", "--example", op).out, "job.toml")
    run = kerf("cut", file, "--to", "laser", "-o", "laser.nc", "--json")
    assert run.status == 0, run.out
    assert [d for d in run.json["diagnostics"] if d["severity"] == "error"] == []


def test_the_rest_of_a_pocket_leaves_what_the_small_tool_alone_leaves(kerf, program):
    """Simulated by two tools and by the small one alone, and compared as parts."""
    job = (ROOT / "examples" / "rest.toml").read_text()
    first, second = job.index("[[operation]]"), job.rindex("[[operation]]")
    alone = program(job[:first] + job[second:].replace("rest-tool = 1\n", ""), "alone.toml")
    both = kerf("simulate", "--json", program(job, "both.toml"), "--resolution", "0.1", "-o", "both.stl")
    one = kerf("simulate", "--json", alone, "--resolution", "0.1", "-o", "alone.stl")
    assert both.status == 0 and one.status == 0, both.out + one.out
    assert both.json["hazards"] == []
    assert both.json["removed_mm3"] == pytest.approx(one.json["removed_mm3"], rel=2e-4)
    large = program(job[:second], "large.toml")
    run = kerf("simulate", "--json", large, "--resolution", "0.1", "-o", "large.stl")
    assert run.json["removed_mm3"] < 0.99 * one.json["removed_mm3"]


def test_an_adaptive_pocket_in_one_deep_pass_is_free_of_hazards(kerf):
    job = ROOT / "examples" / "adaptive.toml"
    run = kerf("simulate", "--json", job)
    assert run.status == 0 and run.json["hazards"] == [], run.out
    # The polygon less the island and its own inner corners (radius 3, five square ones), 12 mm deep.
    area = 50 * 50 + 30 * 9 - 3.14159 * 36 - 6 * 9 * (1 - 3.14159 / 4)
    assert run.json["removed_mm3"] == pytest.approx(12 * area, rel=2e-3)
    assert kerf("check", job).status == 0
