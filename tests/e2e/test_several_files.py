"""kerf check and kerf info with several files, and the forms of check for other tools."""
import json

import pytest
from conftest import VALID

BAD = VALID.replace("F100\nG1 X20 F400", "\nG1 X20")


@pytest.fixture
def two(program):
    return str(program(VALID, "good.nc")), str(program(BAD, "bad.nc"))


def test_each_file_is_an_object_on_a_line(kerf, two):
    good, bad = two
    run = kerf("check", "--json", good, bad)
    assert run.status == 3
    objects = [json.loads(line) for line in run.out.splitlines()]
    assert [o["source"] for o in objects] == [good, bad]
    assert objects[0]["hazards"] == []
    assert {h["kind"] for h in objects[1]["hazards"]} == {"no_feed"}
    run = kerf("info", "--json", good, bad)
    assert [json.loads(line)["source"] for line in run.out.splitlines()] == [good, bad]


def test_the_worst_status_counts(kerf, two, tmp_path):
    good, bad = two
    assert kerf("check", good, good).status == 0
    assert kerf("check", bad, good).status == 3
    missing = kerf("check", bad, str(tmp_path / "missing.nc"), good)
    assert missing.status == 1
    assert "missing.nc" in missing.err and "no hazard found" in missing.out
    assert kerf("info", good, str(tmp_path / "missing.nc")).status == 1


def test_a_file_that_cannot_be_read_has_its_line(kerf, two):
    good, bad = two
    for command in ("check", "info"):
        run = kerf(command, "--json", good, "missing.nc", bad)
        objects = [json.loads(line) for line in run.out.splitlines()]
        assert run.status == 1 and run.err == ""
        assert [o["source"] for o in objects] == [good, "missing.nc", bad]
        assert [d["name"] for d in objects[1]["diagnostics"]] == ["file_unreadable"]


def test_a_hazard_has_a_severity_word(kerf, two):
    line = next(line for line in kerf("check", two[1]).out.splitlines() if "no_feed" in line)
    assert line.startswith(two[1] + ":") and ": hazard: " in line


def test_lines_of_a_compiler(kerf, two):
    run = kerf("check", "--format", "gcc", *two)
    assert run.status == 3
    lines = [line for line in run.out.splitlines() if "[no_feed]" in line]
    assert len(lines) == 1
    file, line, column, severity, _ = lines[0].split(":", 4)
    assert file == two[1] and int(line) == 1 + BAD.splitlines().index("G1 Z-1 ") and int(column) >= 1
    assert severity == " error"


def test_annotations_of_a_workflow(kerf, program):
    file = str(program(BAD, "a,b%c.nc"))
    lines = kerf("check", "--format", "github", file).out.splitlines()
    line = next(line for line in lines if "no_feed" in line)
    assert line.startswith("::error file=") and "a%2Cb%25c.nc,line=" in line and ",title=no_feed::" in line


def test_a_log_of_sarif(kerf, two):
    log = json.loads(kerf("check", "--format", "sarif", *two).out)
    assert log["version"] == "2.1.0" and len(log["runs"]) == 1
    run = log["runs"][0]
    assert run["tool"]["driver"]["name"] == "kerf"
    rules = {rule["id"] for rule in run["tool"]["driver"]["rules"]}
    assert rules == {result["ruleId"] for result in run["results"]} and "no_feed" in rules
    found = next(r for r in run["results"] if r["ruleId"] == "no_feed")
    assert found["level"] == "error" and found["message"]["text"]
    region = found["locations"][0]["physicalLocation"]["region"]
    assert region["startLine"] >= 1


def test_a_log_has_what_sarif_requires(kerf, two):
    """The required properties of SARIF 2.1.0, sections 3.13, 3.14, 3.18, 3.27, 3.28, 3.29, 3.30 and 3.49."""
    log = json.loads(kerf("check", "--format", "sarif", *two, "with blank.nc").out)
    assert set(log) <= {"$schema", "version", "runs"} and isinstance(log["runs"], list)
    driver = log["runs"][0]["tool"]["driver"]
    assert isinstance(driver["name"], str) and isinstance(driver["version"], str)
    ids = [rule["id"] for rule in driver["rules"]]
    assert len(ids) == len(set(ids))
    for result in log["runs"][0]["results"]:
        assert result["level"] in ("none", "note", "warning", "error")
        assert isinstance(result["message"]["text"], str) and result["message"]["text"]
        for location in result["locations"]:
            physical = location["physicalLocation"]
            assert " " not in physical["artifactLocation"]["uri"]
            assert all(isinstance(n, int) and n >= 1 for n in physical.get("region", {}).values())
    uris = {r["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
            for r in log["runs"][0]["results"]}
    assert "with%20blank.nc" in uris  # a reference by RFC 3986
    assert json.loads(kerf("check", "--format", "sarif", two[0]).out)["runs"][0]["results"] is not None


def test_an_unknown_form_is_refused(kerf, two):
    run = kerf("check", "--format", "xml", two[0])
    assert run.status == 2 and "sarif" in run.err
    assert kerf("check", "--format", "gcc", "--json", two[0]).status == 2
