"""kerf outline: outlines from files and scripts, cut and drawn."""
import json
import sys

import pytest

PLATE = {"unit": "mm", "outlines": [{
    "name": "plate", "closed": True, "first": {"at": [0, 0], "corner": 3},
    "segments": [{"to": [40, 0], "corner": 3}, {"to": [40, 20], "via": [45, 10], "corner": -2},
                 {"to": [0, 20], "corner": 300}]}]}
SCRIPT = """
print("text of the script")
import cnc25d_api
cnc25d_api.cnc_cut_outline([[0, 0, 0], [30, 0, 5], [30, 30, -5], [0, 30, 4], [0, 0, 0]], "box")
"""


@pytest.fixture
def plate(tmp_path):
    (tmp_path / "plate.json").write_text(json.dumps(PLATE))
    return "plate.json"


def test_a_file_is_cut_and_drawn(kerf, plate, tmp_path):
    run = kerf("outline", plate, "--svg", "plate.svg", "--dxf", "plate.dxf")
    assert run.status == 0
    assert "2 smoothed, 1 enlarged, 1 left sharp" in run.out
    assert "plate.3 stays sharp" in run.err and "too large" in run.err
    svg = (tmp_path / "plate.svg").read_text()
    assert svg.count("<circle") == 3  # the router bit at each changed corner
    assert "LWPOLYLINE" in (tmp_path / "plate.dxf").read_text()


def test_json_lists_every_corner(kerf, plate):
    run = kerf("outline", plate, "--json")
    outline = run.json["outlines"][0]
    assert outline["closed"] and [c["outcome"] for c in outline["corners"]] == [
        "smoothed", "smoothed", "enlarged", "sharp"]
    assert outline["corners"][3]["reason"] == "short_segment" and outline["corners"][3]["largest_mm"] > 5
    assert run.codes() == ["corner_too_large"]


def test_the_outlines_of_a_script_are_drawn(kerf, tmp_path):
    pytest.importorskip("cnc25d_api")
    (tmp_path / "box.py").write_text(SCRIPT)
    run = kerf("outline", "box.py", "--svg", "box.svg", "--json", env={"KERF_PYTHON": sys.executable})
    assert run.status == 0, run.err
    assert run.json["outlines"][0]["name"] == "box" and "text of the script" in run.err
    assert (tmp_path / "box.svg").exists()


def test_a_corner_of_a_script_is_warned_about_once(kerf, tmp_path):
    pytest.importorskip("cnc25d_api")
    (tmp_path / "box.py").write_text(SCRIPT.replace("30, 0, 5", "30, 0, 50"))
    run = kerf("outline", "box.py", env={"KERF_PYTHON": sys.executable})
    assert run.status == 0 and run.err.count("stays sharp") == 1, run.err


@pytest.mark.parametrize("text, code", [("{", "outline_file_syntax"), ("{}", "outline_file_content")])
def test_bad_files_are_refused(kerf, tmp_path, text, code):
    (tmp_path / "bad.json").write_text(text)
    run = kerf("outline", "bad.json", "--json", "--svg", "bad.svg")
    assert run.status == 1 and run.codes() == [code]
    assert not (tmp_path / "bad.svg").exists()


@pytest.mark.parametrize("text", ["raise SystemExit(3)", "pass"])
def test_scripts_that_fail_or_cut_nothing_are_errors(kerf, tmp_path, text):
    (tmp_path / "bad.py").write_text(text)
    run = kerf("outline", "bad.py", "--json", env={"KERF_PYTHON": sys.executable})
    assert run.status == 1 and run.codes() == ["script_failed"]


def test_a_missing_python_is_an_error(kerf, tmp_path):
    (tmp_path / "a.py").write_text("")
    run = kerf("outline", "a.py", "--json", env={"KERF_PYTHON": "/nowhere/python"})
    assert run.status == 1 and run.codes() == ["script_failed"] and "KERF_PYTHON" in run.out


def test_an_outline_that_is_not_finite_or_too_short_is_refused(kerf, tmp_path):
    plate = {"outlines": [{"first": {"at": [0, 0]}, "segments": []}]}
    (tmp_path / "a.json").write_text(json.dumps(plate))
    run = kerf("outline", "a.json", "--json")
    assert run.status == 1 and run.codes() == ["outline_malformed"]
