"""kerf cut without a feed: by the chip load in a material. The figures are computed by hand from the table of
data/materials.toml (MDF: 0.42 mm at 6 mm): half of it, two teeth, 16000 rpm."""
import re

import pytest

JOB = """stock = "-2,-2,-20 to 62,42,0"

[tools]
1 = "square d=6 flute=20 teeth=2"

[[shape]]
rectangle = [0, 0, 60, 40]

[[operation]]
op = "pocket"
tool = 1
depth = 12
stepdown = 3
rpm = 16000
material = "MDF"
"""


def words(path, letter):
    code = re.sub(r"\(.*?\)|;.*", "", path.read_text())
    return {float(value) for value in re.findall(letter + r"([0-9.]+)", code)}


@pytest.mark.parametrize("change, feed, part", [
    (("", ""), 6720, "0.21 mm per tooth in MDF"),                        # 0.42 / 2 * 2 * 16000
    (("teeth=2", "teeth=3"), 10080, "with 3 teeth"),
    (("stepdown = 3", "stepdown = 12"), 5040, "less by 25% for the depth"),   # two diameters: three quarters
    (("d=6", "d=3"), 3200, "0.1 mm per tooth"),                          # 0.2 / 2 * 2 * 16000, depth 3 = d
])
def test_the_feed_is_that_of_the_chip_load(kerf, program, tmp_path, change, feed, part):
    file = program(JOB.replace(*change, 1), "job.toml")
    run = kerf("cut", file, "--json", "-o", "part.nc")
    assert run.status == 0, run.out
    notes = [d for d in run.json["diagnostics"] if d["name"] == "cut_job_key"]
    assert len(notes) == 1 and notes[0]["severity"] == "note", run.out
    assert part in notes[0]["message"] and notes[0]["hint"] == f"feed = {feed}"
    assert max(words(tmp_path / "part.nc", "F")) == feed
    # Half of what the check regards as the maximum.
    assert kerf("check", file, "--material", "MDF").status == 0


def test_teeth_that_are_not_given_are_assumed_with_a_warning(kerf, program):
    file = program(JOB.replace(" teeth=2", ""), "job.toml")
    run = kerf("cut", file, "--json", "-o", "part.nc")
    warnings = [d for d in run.json["diagnostics"] if d["severity"] == "warning"]
    assert len(warnings) == 1 and "2 teeth (assumed)" in warnings[0]["message"]
    assert "teeth=2" in warnings[0]["hint"] and "feed = 6720" in warnings[0]["hint"]


def test_the_machine_limits_feed_and_plunge(kerf, program, tmp_path):
    (tmp_path / "router.toml").write_text("$110=2000\n$111=2500\n$112=400\n$30=24000\n$31=8000\n")
    file = program(JOB + 'machine = "router.toml"\n', "job.toml")
    run = kerf("cut", file, "--json", "-o", "part.nc")
    assert run.status == 0, run.out
    assert "feed 2000 mm/min, the limit of the machine" in run.out
    assert max(words(tmp_path / "part.nc", "F")) == 2000
    assert kerf("cut", program(JOB + 'machine = "grbl_router"\n', "named.toml"), "-o", "named.nc").status == 0
    assert max(words(tmp_path / "named.nc", "F")) == 3000  # its rate
    fast = program(JOB.replace("16000", "30000") + 'machine = "router.toml"\n', "fast.toml")
    run = kerf("cut", fast, "--json", "-o", "fast.nc")
    assert run.status == 1 and "30000 rpm is above" in run.out
    assert not (tmp_path / "fast.nc").exists()


@pytest.mark.parametrize("change, message", [
    (('material = "MDF"\n', ""), "feed is missing"),
    (("rpm = 16000", ""), "needs the spindle speed"),
    (('"MDF"', '"unobtainium"'), "unknown material"),
    (('"MDF"', "5"), "material must be a text"),
    (('material = "MDF"', 'material = "MDF"\nmachine = "none.toml"'), "none.toml"),
    (("rpm = 16000", "rpm = -1"), "rpm must be"),
])
def test_what_is_missing_is_an_error(kerf, program, change, message):
    run = kerf("cut", program(JOB.replace(*change, 1), "job.toml"), "--json", "-o", "part.nc")
    assert run.status == 1
    assert message in run.out


def test_the_command_takes_a_material(kerf, program):
    art = program('<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">'
                  '<rect x="5" y="5" width="50" height="30" fill="none" stroke="red"/></svg>', "art.svg")
    run = kerf("cut", art, "--op", "pocket", "--tool", "square d=6 teeth=2", "--depth", "3", "--rpm", "16000",
               "--material", "mdf", "-o", "part.nc", "--json")
    assert run.status == 0, run.out
    assert "feed 6720 mm/min" in run.json["diagnostics"][0]["message"]
    bare = kerf("cut", art, "--op", "pocket", "--tool", "square d=6", "--depth", "3", "--rpm", "16000",
                "--json")
    assert bare.status != 0 and "feed is missing" in bare.out + bare.err
