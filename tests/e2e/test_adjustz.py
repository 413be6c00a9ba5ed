"""kerf adjustz and --measured: heights of path drawings corrected by measured values, from lists and logs."""

import json
import re

import pytest
from path_drawing import circle, line, path, text

CLEAN = """%
G00 Z5.000
G01 Z0.800(=0.800+0.794*[#51-2.000]+0.206*[#52-2.000])
G01 F150.000 X10.000 Y0.000 Z-0.300(=-0.300+1.000*[#51-2.000])
  (Sum:  20 mm   ca.  1 min)
%
"""
LIST = "([1.000 2.000]/L:left/T=2.000) #51={}\n([3.000 4.000]/T=2.000) #52={}\n"


@pytest.fixture
def save(tmp_path):
    def write(name, content):
        (tmp_path / name).write_text(content, encoding="utf-8")
        return name

    return write


@pytest.fixture
def files(save):
    """Writes a_Clean.gcode and a_Z.txt with two measured values."""

    def write(first="2.1", second="1.85", clean=CLEAN):
        save("a_Clean.gcode", clean)
        save("a_Z.txt", LIST.format(first, second))

    return write


# ------------------------------------------------------------------------------------------- kerf adjustz


def test_formulas_become_numbers(kerf, files, tmp_path):
    # By hand: 0.8 + 0.794*0.1 + 0.206*(-0.15) = 0.8485; -0.3 + 0.1 = -0.2.
    files()
    for name in ("a", "a.dxf", "a_Z.txt", "a_Clean.gcode", "a.gcode"):
        (tmp_path / "a_Milling.gcode").unlink(missing_ok=True)
        assert kerf("adjustz", "/len", "/m0.9", name).status == 0
        rows = (tmp_path / "a_Milling.gcode").read_text().splitlines()
        assert rows[2] == "G01 Z0.849(==0.800+0.794*[#51-2.000]+0.206*[#52-2.000])"
        assert rows[3] == "G01 F150.000 X10.000 Y0.000 Z-0.200(==-0.300+1.000*[#51-2.000])"
        assert rows[0] == "%" and rows[1] == "G00 Z5.000" and rows[4].startswith("  (Sum:")


def test_options(kerf, files, tmp_path):
    files("2,1", " 1,85 ")
    for options in (["/m0,9"], ["-m", "0.9"], ["--max-correction=0.9"], ["/M", "0.9"]):
        assert kerf("adjustz", *options, "a").status == 0, options
        assert kerf("adjustz", *options, tmp_path / "a_Z.txt").status == 0
    for options in ([], ["/m"], ["/m0"], ["/m-1"], ["/mx"], ["/m1", "/q"], ["/h"],
                    ["/m1", "--work-offset", "1,2"]):
        run = kerf("adjustz", *options, *([] if options == ["/m"] else ["a"]))
        assert run.status == 2 and "/m ..." in run.err, options  # code adjustz_option
    assert kerf("adjustz", "/m1").status == 3
    run = kerf("adjustz", "/m1", "/media/none/a_Z.txt")
    assert run.status == 1 and "/media/none/a_Z.txt: cannot read" in run.err
    shown = kerf("adjustz", "/m1", "/x", "mm.*min", "a")
    assert shown.out == "  (Sum:  20 mm   ca.  1 min)\n"


@pytest.mark.parametrize("values, message", [
    (("", "2"), "a_Z.txt:1: Line does not have format '(comment) #...=value'"),
    (("2.x", "2"), "a_Z.txt:1: Value '2.x' for #51 is not a valid number"),
    (("2", "4"), "a_Z.txt:2: Value 2 for #52 differs from 4 by more than /m=1"),
])
def test_wrong_lists_write_nothing(kerf, files, tmp_path, values, message):
    files(*values)
    run = kerf("adjustz", "/len", "/m1", "a")
    assert run.status == 1 and message in run.err  # codes heights_format, heights_deviation
    assert not (tmp_path / "a_Milling.gcode").exists()


def test_german_messages(kerf, files):
    files("", "2")
    assert "Zeile hat nicht das Format" in kerf("adjustz", "/lde", "/m1", "a").err


def test_a_deviation_equal_to_the_maximum_is_allowed(kerf, files):
    files("3", "2")
    assert kerf("adjustz", "/m1", "a").status == 0


@pytest.mark.parametrize("formula", ["1+[#53-2]", "1+", "1+[#51-2", "(1", "1/0", "#", "1 2",
                                     "(" * 300 + "1" + ")" * 300])
def test_wrong_formulas_write_nothing(kerf, files, tmp_path, formula):
    files(clean=f"G01 Z1.000(={formula})\nG01 Z1\n")
    run = kerf("adjustz", "/m1", "a")
    # A formula whose parentheses do not close is none, as for the original.
    if formula.count("(") == formula.count(")"):
        assert run.status == 1 and "a_Clean.gcode:1:" in run.err  # code heights_formula
        assert not (tmp_path / "a_Milling.gcode").exists()


def test_the_list_of_the_document(kerf, files, save, tmp_path):
    files()
    save("a_Z.txt", "@ [138.000|299.000] #51=2,1\n@[242.000|264.000] #52= 1.85\n")
    assert kerf("adjustz", "/m0.9", "a").status == 0
    assert "Z0.849(==" in (tmp_path / "a_Milling.gcode").read_text()
    save("a_Z.txt", "@ [138.000|299.000] #51=3,1\n@[242.000|264.000] #52= 1.85\n")
    assert kerf("adjustz", "/m0.9", "a").status == 1  # 3.1 instead of the 2.000 of the formula


def test_missing_and_repeated_variables(kerf, files, save):
    files()
    save("a_Z.txt", LIST.format(2, 2) + "([1 2]/T=2.000) #51=2\n")
    assert kerf("adjustz", "/m1", "a").status == 1
    assert kerf("adjustz", "/m1", "missing").status == 1


def test_a_failed_file_stops_later_output(kerf, files, save, tmp_path):
    files("", "")
    save("b_Clean.gcode", CLEAN)
    save("b_Z.txt", LIST.format(2, 2))
    assert kerf("adjustz", "/m1", "a", "b").status == 1
    assert not (tmp_path / "b_Milling.gcode").exists()


# ------------------------------------------------------------------------------------ controllers' files


@pytest.fixture
def probed(kerf, save):
    """The files of a drawing with probes at (0, 20) and (10, 20) of work coordinates."""
    probes = circle(0, 20, 6, "PHANTOM") + text(0, 20, "Lleft") + circle(10, 20, 6, "PHANTOM")
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0) + probes))
    assert kerf("pathdxf", "/f150", "/v500", "/s15", name).status == 0
    return name


LOG = """Grbl 1.1h ['$' for help]
>>> $#
[G54:-100.000,-50.000,-10.000]
[G55:0.000,0.000,0.000]
[G92:0.000,0.000,0.000]
[TLO:0.000]
[PRB:0.000,0.000,0.000:0]
ok
>>> G38.3 Z0
[PRB:-90.000,-30.003,-8.200:1]
[PRB:-100.002,-30.000,-7.900:1]
ok
"""


@pytest.mark.parametrize("log", [
    LOG,  # machine coordinates and the work offset of $#
    "<Idle|MPos:0,0,0|WCO:-100,-50,-10>\n[PRB:-90,-30,-8.2:1]\n[PRB:-100,-30,-7.9:1]\n",
    "0 20 2.1 0 0 0 0 0 0\n10.001 20 1.8 0 0 0 0 0 0\n",  # PROBEOPEN
    "x,y,z\n0;20;2.1\n10;20;1.8\n",
])
def test_heights_by_position(kerf, probed, save, tmp_path, log):
    save("log.txt", log)
    assert kerf("adjustz", "/m1", "--measured", "log.txt", probed).status == 0, kerf(
        "adjustz", "/m1", "--measured", "log.txt", probed).err
    # Weights 0.528 (left, distance 20) and 0.472 (22.361): 1 + 0.528*0.1 - 0.472*0.2 = 0.9584.
    assert "G01 Z0.958(==1.000+0.528*[#51-2.000]" in (tmp_path / "8999.1P_Milling.gcode").read_text()


def test_logs_that_cannot_be_used(kerf, probed, save):
    def fails(log, *more):
        save("log.txt", log)
        return kerf("adjustz", "/m1", "--measured", "log.txt", *more, probed)

    no_offset = "[PRB:-90,-30,-8.2:1]\n[PRB:-100,-30,-7.9:1]\n"
    assert fails(no_offset).status == 1
    assert fails(no_offset, "--work-offset", "-100,-50,-10").status == 0
    assert fails(LOG.replace("-8.200:1", "-8.200:0")).status == 1  # no contact
    assert fails("0 20 2.1\n").status == 1  # one probe is missing
    assert fails("0 20 2.1\n10 20 5\n").status == 1  # deviates by 3 mm
    assert fails("0 20 2.1\n10 20 x\n").status == 1
    assert "none of the program's probes" in fails("0 20 2.1\n10 20 2\n40 40 2\n").err


def test_steps_and_post_take_measured_values(kerf, probed, save, tmp_path):
    save("values.txt", "([0.000 20.000]/T=2.000) #51=2.1\n([10.000 20.000]/T=2.000) #52=1.8\n")
    rows = kerf("steps", "--measured", "values.txt", probed).out.splitlines()
    steps = [json.loads(row) for row in rows][1:]
    assert not any("z_correction" in s for s in steps)
    heights = [s["to"][2] for s in steps if s["step"] == "cut"]
    assert heights[0] == pytest.approx(0.9584, abs=6e-4)
    # The way back starts at X10: the weights are exchanged, 1 + 0.472*0.1 - 0.528*0.2.
    assert heights[1] == pytest.approx(0.9584, abs=6e-4)
    assert kerf("post", "--to", "grbl", "--measured", "values.txt", probed, "-o", "out.nc").status == 0
    assert "(=" not in (tmp_path / "out.nc").read_text()
    assert kerf("simulate", "--json", "--measured", "values.txt", probed).status == 0
    save("values.txt", "0 20 9\n10 20 2\n")
    assert kerf("steps", "--measured", "values.txt", probed).status == 1
    assert kerf("steps", "--measured", "none.txt", probed).status == 1


def test_post_writes_formulas_that_adjustz_reads(kerf, probed, save, tmp_path):
    run = kerf("post", "--json", "--to", "grbl", probed, "-o", "a_Clean.gcode")
    assert run.status == 0 and "heights_uncorrected" in run.codes()
    assert re.search(r"Z1(\.0*)?\(=1.000\+0.528\*\[#51-2.000\]", (tmp_path / "a_Clean.gcode").read_text())
    save("a_Z.txt", LIST.format(2.1, 1.8))
    assert kerf("adjustz", "/m1", "a").status == 0
    assert "0.958(==" in (tmp_path / "a_Milling.gcode").read_text()
    assert kerf("post", "--inch", "--to", "grbl", probed, "-o", "b.nc").status == 1


def test_measured_values_of_a_program_without_probes(kerf, program, save):
    save("map.txt", "0 0 1\n")
    run = kerf("info", "--json", "--measured", "map.txt", program())
    assert run.status == 0 and "heights_unmatched" in run.codes()


def test_a_list_corrects_a_program_once(kerf, probed, save, tmp_path):
    """The program of kerf adjustz, and one posted with --measured, follow the list's heights already."""
    values = "([0.000 20.000]/L:left/T=2.000) #51=2.1\n([10.000 20.000]/T=2.000) #52=1.8\n"
    save("8999.1P_Z.txt", values)
    assert kerf("adjustz", "/m1", probed).status == 0
    assert kerf("post", "--to", "grbl", "--measured", "8999.1P_Z.txt", probed, "-o", "posted.nc").status == 0
    level = ("post", "--json", "--to", "grbl", "--level")
    for program in ("8999.1P_Milling.gcode", "posted.nc"):
        run = kerf(*level, "8999.1P_Z.txt", program, "-o", "twice.nc")
        assert run.status == 1 and "level_twice" in run.codes(), (program, run.out)
        save("map.txt", "0 20 0.1\n10 20 -0.2\n")
        run = kerf(*level, "map.txt", program, "-o", "other.nc")
        assert run.status == 0 and "level_twice" in run.codes(), (program, run.out)
    for measured, same in (("8999.1P_Z.txt", "8999.1P_Z.txt"), ("8999.1P_Z.txt", "./8999.1P_Z.txt")):
        run = kerf(*level, same, "--measured", measured, probed, "-o", "twice.nc")
        assert run.status == 2 and "level_twice" in run.codes()
    save("same.txt", values)
    run = kerf(*level, "8999.1P_Z.txt", "--measured", "same.txt", probed, "-o", "twice.nc")
    assert run.status == 1 and "level_twice" in run.codes()
    assert not (tmp_path / "twice.nc").exists()
