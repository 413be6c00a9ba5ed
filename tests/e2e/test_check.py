"""kerf check: exit status 3 with the hazards of the path and of the material; 0 for a valid one."""
import pytest
from conftest import VALID


def kinds(run):
    return sorted({h["kind"] for h in run.json["hazards"]})


def test_a_valid_program(kerf, program, files):
    run = kerf("check", "--json", program())
    assert run.status == 0, run.out
    assert run.json["hazards"] == []
    assert files() == ["part.nc"]
    text = kerf("check", program())
    assert text.status == 0 and "no hazard found" in text.out
    assert kerf("check", "-q", program()).out == ""


@pytest.mark.parametrize("old, new, kind", [
    ("F100\nG1 X20 F400", "\nG1 X20", "no_feed"),
    ("M6 T102\n", "", "no_tool"),
    ("M3 S10000\n", "", "spindle_off"),
    ("M3 S10000\n", "M3 S10000\nM5\n", "spindle_off"),
    ("M2\n", "", "no_program_end"),
    ("G0 Z5\nM5", "G0 X30\nG0 Z5\nM5", "rapid_in_stock"),
    ("G1 Z-1", "G1 Z-8", "below_floor"),
])
def test_each_hazard_is_found_with_its_kind(kerf, program, old, new, kind):
    assert old in VALID
    run = kerf("check", "--json", program(VALID.replace(old, new)))
    assert run.status == 3, run.out
    assert kind in kinds(run)
    for hazard in run.json["hazards"]:
        assert set(hazard) >= {"kind", "at", "depth_mm", "removed_mm3", "origin", "message", "step"}
        assert len(hazard["at"]) == 3 and hazard["origin"]["line"] > 0


@pytest.mark.parametrize("board, status", [("1.9mm", 3), ("2", 0), ("0.08in", 0), ("0", 3)])
def test_cuts_into_the_spoilboard_are_not_hazards(kerf, program, board, status):
    """The stock of the program is 6 mm thick: Z-8 is 2 mm below its floor."""
    path = program(VALID.replace("G1 Z-1", "G1 Z-8"))
    flute = ("-t", "square d=3 flute=12")
    assert kerf("check", *flute, "--spoilboard", board, path).status == status
    simulated = kerf("simulate", "--json", *flute, "--spoilboard", board, path)
    assert bool(simulated.json["hazards"]) == (status == 3)


def test_the_result_is_the_same_for_any_number_of_threads(kerf, program):
    path = program(VALID.replace("G0 Z5\nM5", "G0 X30\nG0 Z5\nM5"))
    one, four = (kerf("check", "--json", "--threads", n, path).json for n in ("1", "4"))
    assert one == four and one["hazards"]


SMALL_MILL = "travel_x = [0, 8]\nspindle = [100, 8000]\n"


@pytest.mark.parametrize("old, new, options, kind, line, hint", [
    ("F100\nG1 X20 F400", "\nG1 X20", [], "no_feed", 8, "F word"),
    ("M6 T102\n", "", [], "no_tool", 7, "--tool"),
    ("I0 J5", "I0 J5.02", [], "arc_radii", 10, "decimals"),
    ("", "", ["--machine", "mill.toml"], "outside_machine", 9, "zero"),
    ("", "", ["--machine", "mill.toml"], "spindle_range", 6, "change S"),
    ("M3 S10000\n", "", [], "spindle_off", 7, "M3"),
    ("G0 Z5\nM5\n", "M5\nM6 T201\nG0 Z5\n", [], "tool_change_low", 12, "retract"),
    ("", "", ["-t", "square d=3 flute=12 plunges=false"], "plunge", 8, "ramp"),
    ("F400", "F8000", ["--material", "steel"], "chip_load", 9, "feed"),
    ("M2\n", "", [], "no_program_end", 12, "M2"),
    ("G0 Z5\nM5", "G0 X30\nG0 Z5\nM5", [], "rapid_in_stock", 11, "retract"),
    ("G1 Z-1", "G1 Z-8", [], "below_floor", 8, "--stock"),
])
def test_each_hazard_has_its_line_and_a_hint(kerf, program, old, new, options, kind, line, hint):
    program(SMALL_MILL, "mill.toml")
    run = kerf("check", "--json", *options, program(VALID.replace(old, new) if old else VALID))
    assert run.status == 3, run.out
    found = next(h for h in run.json["hazards"] if h["kind"] == kind)
    assert found["origin"]["line"] == line
    assert hint in found["hint"]


@pytest.mark.parametrize("machine, kind", [
    ("travel_x = [0, 5]\n", "outside_machine"),
    ("spindle = [100, 8000]\n", "spindle_range"),
])
def test_hazards_of_the_machine(kerf, program, machine, kind):
    run = kerf("check", "--json", "--machine", program(machine, "m.toml"), program())
    assert run.status == 3, run.out
    assert kinds(run) == [kind]
    assert all(h["hint"] for h in run.json["hazards"])


def test_hazards_of_the_material(kerf, program):
    fast = program(VALID.replace("F400", "F8000"))
    assert kinds(kerf("check", "--json", "--material", "steel", fast)) == ["chip_load"]
    assert kerf("check", "--material", "cheese", fast).status == 2


def test_a_tool_change_in_the_stock(kerf, program):
    run = kerf("check", "--json", program(VALID.replace("G0 Z5\nM5\n", "M5\nM6 T201\nG0 Z5\n")))
    assert "tool_change_low" in kinds(run)


def test_a_cut_deeper_than_the_flute(kerf, program):
    text = VALID.replace("-6.00mm", "-30.00mm").replace("G1 Z-1", "G1 Z-20")
    run = kerf("check", "--json", program(text))
    assert run.status == 3
    assert {"over_flute", "shank_contact"} & set(kinds(run))


def test_hazards_as_text_name_file_and_line(kerf, program):
    path = program(VALID.replace("M3 S10000\n", ""))
    run = kerf("check", path)
    assert run.status == 3
    assert f"{path}:7" in run.out and "[spindle_off]" in run.out


def test_hazards_of_path_and_material_are_in_the_order_of_steps(kerf, program):
    run = kerf("check", "--json", program(VALID.replace("G0 Z5\nM5\nM2\n", "G0 X30\nM5\nG1 X31\n")))
    steps = [h["step"] for h in run.json["hazards"]]
    assert steps == sorted(steps) and len(steps) >= 3


def test_errors_of_the_program_come_before_hazards(kerf, program):
    run = kerf("check", "--json", program(VALID.replace("F400", "Fnan")))
    assert run.status == 1
    assert any(d["severity"] == "error" for d in run.json["diagnostics"])


def test_an_unknown_tool_is_a_hazard_and_the_rest_is_checked(kerf, program):
    two = VALID.replace("G0 Z5\nM5", "G0 X30\nG0 Z5\nM6 T77\nM3 S9000\nG1 Z-1\nG1 X35 Z-20\nG0 Z5\nM5")
    run = kerf("check", "--json", program(two))
    assert run.status == 3
    assert kinds(run) == ["below_floor", "rapid_in_stock", "unknown_tool"]  # with the assumed tool
    unknown = run.json["hazards"][1]
    assert unknown["origin"]["line"] == 15 and unknown["steps"] == 2
    assert '--tool 77="square d=3.175"' in unknown["hint"]
    assert "not_simulated" not in run.codes()


def test_a_program_with_an_unknown_tool_only(kerf, program):
    path = program(VALID.replace("T102", "T77"))
    run = kerf("check", "--json", path)
    assert run.status == 3
    assert kinds(run) == ["unknown_tool"]
    assert kerf("check", path, "--tool", "77=102").status == 0


def test_an_empty_program_is_an_error(kerf, program):
    run = kerf("check", "--json", program("%\n%\n"))
    assert run.status == 1
    assert "nothing_to_cut" in run.codes()


def test_without_a_tool_the_material_is_checked_with_an_assumed_one(kerf, program):
    no_tool = VALID.replace("M6 T102\n", "")
    run = kerf("check", "--json", program(no_tool))
    assert run.status == 3
    assert kinds(run) == ["no_tool"]
    crash = kerf("check", "--json", program(no_tool.replace("G0 Z5\nM5", "G0 X30\nG0 Z5\nM5")))
    assert kinds(crash) == ["no_tool", "rapid_in_stock"]


# 9.5 mm deep; --tool "square d=3" has no flute length, so Kerf assumes 3 diameters.
DEEP = VALID.replace("-6.00mm", "-12.00mm").replace("G1 Z-1", "G1 Z-9.5")


def test_a_cut_beyond_an_assumed_flute_is_a_warning(kerf, program):
    path = program(DEEP)
    run = kerf("check", "--json", "-t", "square d=3", path)
    assert run.status == 0 and run.json["hazards"] == []
    warning, = [d for d in run.json["diagnostics"] if d["name"] == "flute_assumed"]
    assert warning["severity"] == "warning" and warning["origin"]["line"] == 9
    assert "0.5 mm deeper" in warning["message"] and "assuming 9 mm (3 diameters)" in warning["message"]
    assert "flute=20" in warning["hint"]
    given = kerf("check", "--json", "-t", "square d=3 flute=9", path)
    assert given.status == 3 and kinds(given) == ["over_flute"]
    shank = kerf("check", "--json", "-t", "square d=3 shank=6", path)
    assert shank.status == 3 and kinds(shank) == ["shank_contact"]
    assert all("flute=" in h["hint"] for h in shank.json["hazards"])


def test_simulate_and_info_report_an_assumed_flute_too(kerf, program):
    path = program(DEEP)
    simulated = kerf("simulate", "--json", "--resolution", "0.5", "-t", "square d=3", path)
    assert simulated.json["hazards"] == [] and "flute_assumed" in simulated.codes()
    info = kerf("info", "-t", "square d=3", path)
    assert "flute 9 mm assumed (3 diameters)  <- deeper" in info.out
    assert kerf("info", "--json", "-t", "square d=3", path).json["tools"][0]["flute_assumed"] is True
    assert "flute 12.7 mm assumed (usual for its size)" in kerf("info", "-t", "square d=3.175", path).out
    assert "assumed" not in kerf("info", path).out


# The same part for a machine whose Z counts downwards.
DOWNWARDS = """G21 G90 G17
M3 S10000
G0 Z-5
G0 X10 Y10
G1 Z1 F100
G1 X20 F400
G0 Z-5
G0 X0 Y0
M5
M2
"""


def test_z_downwards_is_one_hazard(kerf, program):
    tool = ["-t", "square d=3 flute=12"]
    run = kerf("check", "--json", *tool, program(DOWNWARDS))
    assert run.status == 3
    hazard, = run.json["hazards"]
    assert hazard["kind"] == "z_downwards" and hazard["origin"]["line"] == 4 and hazard["hint"]
    assert "Z downwards" in hazard["message"]
    simulated = kerf("simulate", "--json", "--resolution", "0.5", *tool, program(DOWNWARDS))
    assert [h["kind"] for h in simulated.json["hazards"]] == ["z_downwards"]
    assert "Z downwards" in kerf("info", *tool, program(DOWNWARDS)).err


def test_a_program_stopped_at_a_limit_has_no_missing_end(kerf, program):
    run = kerf("check", "--json", program("M6 T102\nM3 S1000\nO1 while [1]\nG0 X1\nO1 endwhile\n"))
    assert run.status == 1
    assert run.json["hazards"] == [] and run.codes() == ["too_many_steps"]


def test_inverse_time_without_a_feed_is_a_hazard(kerf, program):
    run = kerf("check", "--json", program(VALID.replace("G1 X20 F400", "G93 G1 X15 F2\nG1 X20\nG94 F400")))
    assert run.status == 3 and kinds(run) == ["no_feed"]
    assert [h["origin"]["line"] for h in run.json["hazards"]] == [10]


@pytest.mark.parametrize("code, dialect", [("G65 P100", "linuxcnc"), ("G12 I5", "grbl")])
def test_an_unknown_g_code_is_a_hazard(kerf, program, code, dialect):
    part = program(VALID.replace("G1 Z-1", f"{code}\nG1 Z-1"))
    run = kerf("check", "--json", "--dialect", dialect, part)
    assert run.status == 3, run.out
    found = next(h for h in run.json["hazards"] if h["kind"] == "left_out")
    line = 1 + part.read_text().splitlines().index(code)
    assert found["origin"]["line"] == line and code.split()[0] in found["message"]
    assert not [d for d in run.json["diagnostics"] if d["name"] == "unknown_g_code"]  # reported once
    assert "no hazard found" not in kerf("check", part).out


def test_an_unknown_m_code_is_a_finding(kerf, program):
    run = kerf("check", "--json", program(VALID.replace("G1 Z-1", "M77\nG1 Z-1")))
    assert run.status == 3, run.out
    hazard, unknown_start = run.json["hazards"]
    assert unknown_start["kind"] == "not_checked"  # it may have moved the tool
    assert hazard["kind"] == "left_out" and hazard["origin"]["line"] == 8 and "M77" in hazard["message"]


def test_no_tool_names_the_option_without_a_number(kerf, program):
    text = VALID.replace("M6 T102\n", "")
    run = kerf("check", "--json", "-t", "1=square d=3", "-t", "2=square d=6", program(text))
    hazard = next(h for h in run.json["hazards"] if h["kind"] == "no_tool")
    assert "without a number" in hazard["hint"] and '--tool "square' in hazard["hint"]


def test_a_stock_that_is_cut_away_wholly_is_a_warning(kerf, tmp_path):
    path = tmp_path / "all.nc"
    path.write_text("G21 G90\nT1 M6\nM3 S9000\nG0 X-5 Y5 Z5\nG1 Z-1 F200\nG1 X15\nG0 Z5\nM5\nM30\n")
    for depth, warned in ((1, True), (2, False)):
        run = kerf("simulate", path, "--tool", "1=square d=40 flute=20", "--stock", f"10x10x{depth}",
                   "-o", tmp_path / "part.stl", "--json")
        assert ("nothing_left" in run.codes()) == warned


def test_a_program_beside_its_stock_is_reported(kerf, tmp_path):
    path = tmp_path / "beside.nc"
    path.write_text("G21 G90\nT1 M6\nM3 S9000\nG0 X500 Y5 Z5\nG1 Z-3 F200\nG1 X540\nG0 Z5\nM5\nM30\n")
    options = ("--tool", "1=square d=6 flute=20", "--stock", "60x40x20")
    assert "stock_untouched" in kerf("simulate", path, *options, "--json").codes()
    run = kerf("check", path, *options, "--json")
    assert run.status == 3 and kinds(run) == ["stock_untouched"]
    assert kerf("check", path, *options[:2], "--json").status == 0
    between = tmp_path / "between.nc"  # narrower than the distance of the columns, not beside the stock
    between.write_text("G21 G90\nT1 M6\nM3 S9000\nG0 X2 Y2 Z5\nG1 Z-1 F200\nG1 X8\nG0 Z5\nM5\nM30\n")
    run = kerf("simulate", between, "--tool", "1=square d=3 flute=20", "--stock", "10x10x5",
               "--resolution", "10", "--json")
    warning = next(d for d in run.json["diagnostics"] if d["name"] == "stock_untouched")
    assert "--resolution" in warning["hint"]
    inside = tmp_path / "inside.nc"
    inside.write_text(path.read_text().replace("X500", "X10").replace("X540", "X40"))
    assert kinds(kerf("check", inside, *options, "--json")) == []


@pytest.mark.parametrize("resolution", [0.5, 0.2, 0.05])
@pytest.mark.parametrize("tool", ["V d=9 angle=60", "V d=6 angle=20", "drill d=6 angle=118", "ball d=6",
                                  "square d=6"])
def test_the_depth_of_a_hazard_is_that_of_the_tip(kerf, program, tool, resolution):
    """Straight down, along a slope, and a touch of 0.1 mm; the tip is between the columns."""
    path = program("""G21 G90
T1 M6
M3 S9000
G0 X0.013 Y0.007 Z5
G0 Z-1
G0 Z5
G0 X10
G0 Z1
G0 X16 Z-2
G0 Z5
G0 X21.01
G0 Z-0.1
G0 Z5
M5
M30
""")
    run = kerf("check", "--json", "--resolution", resolution, "--stock", "-10,-10,-6 to 40,10,0", "--tool",
               f"1 = {tool} flute=12", path)
    depths = {h["origin"]["line"]: h["depth_mm"] for h in run.json["hazards"]
              if h["kind"] == "rapid_in_stock"}
    # A slope is lowest at its end; the column there may be half a column short of it.
    assert depths[5] == pytest.approx(1.0, abs=1e-3)
    assert depths[9] == pytest.approx(2.0, abs=2.0 / 6.0 * resolution)
    assert depths[12] == pytest.approx(0.1, abs=1e-3)


def test_a_tool_that_cannot_plunge_goes_down_beside_the_stock(kerf, program):
    """4 mm beside it with a dovetail of 12 mm: nothing is cut; 4 mm from its edge it is."""
    for x, found in ((-10, False), (-4, True), (5, True)):
        moves = f"G0 X{x} Y5 Z5\nG1 Z-5 F100\nG1 X30 F300\nG0 Z5\n"
        path = program(f"G21 G90\nT1 M6\nM3 S9000\n{moves}M5\nM30\n")
        run = kerf("check", "--json", "--tool", "dovetail d=12 flute=8 angle=14", "--stock",
                   "0,0,-9 to 20,10,0", path)
        assert ("plunge" in [h["kind"] for h in run.json["hazards"]]) == found, x
