"""The files of tests/data/hazards: each has a program with one hazard, which is found in its line, and a near
miss of the same program, which is silent."""
import re
import shlex
from pathlib import Path

import pytest

CASES = sorted(Path(__file__).parents[1].joinpath("data", "hazards").glob("*.txt"))
assert len(CASES) > 30


def read_case(path):
    """Options, kind, line, the program with the hazard, the near miss."""
    form = r".+\ncheck (.+)\n(\w+) in line (\d+)\n--- hazard\n(.*)--- near miss\n(.*)"
    match = re.fullmatch(form, path.read_text(), re.DOTALL)
    options, kind, line, hazard, near_miss = match.groups()
    return shlex.split(options), kind, int(line), hazard, near_miss


@pytest.mark.parametrize("case", CASES, ids=lambda path: path.stem)
def test_the_hazard_is_found_and_the_near_miss_is_silent(kerf, program, case):
    options, kind, line, hazard, near_miss = read_case(case)
    found = kerf("check", "--json", *options, program(hazard))
    assert found.status == 3, found.out
    assert (kind, line) in [(h["kind"], h["origin"]["line"]) for h in found.json["hazards"]], found.out
    silent = kerf("check", "--json", *options, program(near_miss))
    assert silent.status == 0 and silent.json["hazards"] == [], silent.out
