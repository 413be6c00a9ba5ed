"""Words to which controllers give their own meaning, by their manuals."""
import json

import pytest

HEAD = "G21 G90\nT1 M6\nS9000 M3\n"


def motions(kerf, path, *options):
    run = kerf("steps", "--json", *options, path)
    assert run.status == 0, run.err
    return [s for s in map(json.loads, run.out.splitlines()[1:]) if s["step"] in ("rapid", "cut", "arc")]


def lines_of(kerf, path, *options, post="linuxcnc"):
    run = kerf("post", "-q", "--to", post, *options, path)
    assert run.status == 0, run.err
    return [line for line in run.out.splitlines() if not line.startswith("(")]


# ---- spindles


@pytest.mark.parametrize("post, code", [("grbl", "M3"), ("grbl", "M4"), ("grblhal", "M4"), ("carbide", "M3"),
                                        ("linuxcnc", "M4"), ("mach3", "M3")])
def test_a_start_without_a_speed_stays_without_one(kerf, program, post, code):
    path = program(f"G21 G90\nT1 M6\n{code}\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM2\n")
    lines = [line for line in lines_of(kerf, path, post=post) if line.split()[0] == code]
    assert lines == [code]


SURFACE = ("G21 G90\nT1 M6\nG96 D2500 S200 M3\nG0 X10 Y0 Z5\nG1 Z-1 F100\nG97 S900\nG1 X20\nG0 Z5\n"
           "M2\n")
UNLIMITED = SURFACE.replace("D2500 ", "")


def spindle_steps(kerf, path):
    steps = map(json.loads, kerf("steps", "--json", path).out.splitlines()[1:])
    return [(s["turn"], s["rpm"], s.get("surface_speed", 0)) for s in steps if s["step"] == "spindle"]


def test_a_constant_cutting_speed_is_spindle_state(kerf, program):
    path = program(SURFACE)
    assert spindle_steps(kerf, path)[:2] == [("cw", 2500, 200_000), ("cw", 900, 0)]
    found = kerf("check", "--json", path).json["hazards"]
    assert [h["origin"]["line"] for h in found if h["kind"] == "value_unknown"] == [3]
    assert "2500" not in kerf("info", path).out  # a limit is no speed


@pytest.mark.parametrize("units, speed", [("G21", 200_000), ("G20", 200 * 304.8)])
def test_a_cutting_speed_is_in_metres_or_feet(kerf, program, units, speed):
    path = program(SURFACE.replace("G21", units))
    assert spindle_steps(kerf, path)[0] == ("cw", 2500, pytest.approx(speed))


@pytest.mark.parametrize("unit", ["mm", "inch"])
def test_a_constant_cutting_speed_is_written_and_read_back(kerf, program, unit):
    path = program(SURFACE)
    lines = lines_of(kerf, path, "--" + unit, post="linuxcnc")
    if unit == "mm":
        assert "G96 D2500 M3 S200" in lines and "G97 M3 S900" in lines
    again = program("\n".join(lines) + "\n", "again.ngc")
    for now, was in zip(spindle_steps(kerf, again), spindle_steps(kerf, path), strict=True):
        assert now[0] == was[0] and now[1:] == pytest.approx(was[1:], rel=1e-4)


@pytest.mark.parametrize("post, text", [("grbl", SURFACE), ("grblhal", SURFACE), ("mach3", SURFACE),
                                        ("grbl", UNLIMITED)])
def test_a_constant_cutting_speed_is_refused_by_other_controllers(kerf, program, post, text):
    run = kerf("post", "--json", "--to", post, program(text))
    refused = [d["origin"]["line"] for d in run.json["diagnostics"] if d["name"] == "post_cannot"]
    assert run.status == 1 and 3 in refused


def test_mach3_takes_a_cutting_speed_without_a_limit(kerf, program):
    assert "G96 M3 S200" in lines_of(kerf, program(UNLIMITED), post="mach3")


def test_a_speed_after_g97_without_s_is_unknown(kerf, program):
    path = program(SURFACE.replace("G97 S900", "G97"))
    assert spindle_steps(kerf, path)[:2] == [("cw", 2500, 200_000), ("cw", 0, 0)]
    assert "G97 M3" in lines_of(kerf, path, post="linuxcnc")


def test_a_feed_per_turn_of_an_unknown_speed_is_unknown(kerf, program):
    path = program(SURFACE.replace("G1 Z-1 F100", "G95 G1 Z-1 F0.1"))
    found = kerf("check", "--json", path).json["hazards"]
    assert [h["origin"]["line"] for h in found if h["kind"] == "no_feed"] == [5]


# ---- Mach3


def test_mach3_references_axes_by_g28_1(kerf, program):
    path = program(HEAD + "G0 X10 Y10 Z5\nG28.1 X0 Y0\nG0 X20 Y20\nG1 Z-1 F100\nG0 Z5\nM30\n")
    moved = motions(kerf, path, "--dialect", "mach3")
    assert moved[1]["reference"] == "end_switches" and moved[1]["unknown_axes"] == ["X", "Y"]
    assert "G28.1 X0 Y0" in lines_of(kerf, path, "--dialect", "mach3", post="mach3")
    assert "G28.1" not in "\n".join(lines_of(kerf, path, "--dialect", "mach3", post="grbl"))


def test_a_stored_home_is_no_referencing_on_mach3(kerf, program):
    """The stored height is unknown, so that the motion to it stays a G28."""
    stored = HEAD + "G0 X10 Y10\nG28.1\nG0 X20 Z5\nG1 Z-1 F100\nG0 Z5\n{}M2\n"
    assert kerf("post", "--to", "mach3", program(stored.format("G28\n"))).status == 1
    assert "G28.1" not in "\n".join(lines_of(kerf, program(stored.format("")), post="mach3"))
    assert "G28.1" in lines_of(kerf, program(stored.format("G28\n")), post="linuxcnc")


@pytest.mark.parametrize("post", ["linuxcnc", "mach3"])
def test_no_length_is_cancelled_that_the_program_does_not_cancel(kerf, program, post):
    text = HEAD + "{}G0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM2\n"
    assert "G49" not in "\n".join(lines_of(kerf, program(text.format("")), post=post))
    assert "\n".join(lines_of(kerf, program(text.format("G49\n")), post=post)).count("G49") == 1


# ---- Fanuc and Haas


@pytest.mark.parametrize("dialect", ["fanuc", "haas"])
@pytest.mark.parametrize("words, end", [
    ("X10 Y10 P0.5", [15, 10, 5]),
    ("X10 Y10 Z0 P500", [15, 10, 2.5]),
    ("X0 Y0 P2.", [40, 20, 5]),
    ("I2. J1. K1. X10", [30, 10, 5]),
    ("P2.", [40, 20, 5]),  # about the present position, X0 Y0 Z5
])
def test_scaling_about_a_centre(kerf, program, dialect, words, end):
    path = program(HEAD + f"G0 X0 Y0 Z5\nG51 {words}\nG0 X20 Y10 Z5\nG50\nG0 X20\nM30\n")
    moved = motions(kerf, path, "--dialect", dialect)
    assert moved[1]["to"] == end and moved[2]["to"][0] == 20


@pytest.mark.parametrize("words", ["X10 Y10", "X10 P2", "P0"])
def test_scaling_without_a_usable_factor_is_an_error(kerf, program, words):
    path = program(HEAD + f"G0 X0 Y0 Z5\nG51 {words}\nG0 X20\nM30\n")
    assert kerf("steps", "--json", "--dialect", "haas", path).status == 1


def test_scaling_stays_by_factors_on_mach3(kerf, program):
    path = program(HEAD + "G0 X0 Y0 Z5\nG51 X10 Y10\nG0 X20\nM30\n")
    assert motions(kerf, path, "--dialect", "mach3")[1]["to"][0] == 200


def test_mirror_by_a_factor_without_a_decimal_point(kerf, program):
    """Fanuc: the factors of G51 count thousandths, those of I J K too."""
    path = program(HEAD + "G0 X10 Y0 Z5\nG51 X0 Y0 I-1000 J1000\nG0 X20\nG50\nM30\n")
    assert motions(kerf, path, "--dialect", "fanuc")[1]["to"][0] == -20
    path = program(HEAD + "G0 X10 Y0 Z5\nG51 X0 Y0 I-1 J1\nG0 X20\nG50\nM30\n")
    assert "thousandths" in kerf("steps", "--dialect", "fanuc", path).err


@pytest.mark.parametrize("dialect, wanted", [("fanuc", [10, 20]), ("haas", [10, 20]), ("mach3", [-10, 20])])
def test_rotation_without_a_centre(kerf, program, dialect, wanted):
    """Fanuc, B-63194EN: the position at G68 is the centre. Mach3's manual: A and B are 0."""
    path = program(HEAD + "G0 X10 Y10 Z5\nG68 R90\nG0 X20 Y10\nG69\nM30\n")
    assert motions(kerf, path, "--dialect", dialect)[1]["to"][:2] == pytest.approx(wanted)
    path = program(HEAD + "G0 X10\nG68 R90\nG0 X20 Y10\nG69\nM30\n")
    refused = dialect != "mach3"
    assert ("unknown here" in kerf("steps", "--dialect", dialect, path).err) == refused


def holes(kerf, path, *options):
    return [s["to"] for s in motions(kerf, path, *options) if s["step"] == "cut" and s["to"][2] == -10]


@pytest.mark.parametrize("dialect", ["fanuc", "haas"])
@pytest.mark.parametrize("cycle", ["G83 Q4.", "G81", "G73 Q4.", "G82 P100"])
def test_repeats_of_a_cycle(kerf, program, dialect, cycle):
    text = HEAD + "G0 X0 Y0 Z5\nG91 " + cycle + " X10 Z-12 R-3 {} F100\nG80 G90\nM30\n"
    for repeats, count in (("K3", 3), ("L3", 3), ("", 1), ("K0", 0)):
        if dialect == "haas" and "G73" in cycle and "K" in repeats:
            continue  # K of Haas' G73 is a depth, see test_pecks_that_are_not_read_are_refused
        found = holes(kerf, program(text.format(repeats)), "--dialect", dialect)
        assert [x for x, _, _ in found] == [10 * (k + 1) for k in range(count)]


@pytest.mark.parametrize("units, q, z, cuts", [
    ("G21", "Q5000", 10, 2), ("G21", "Q5.", 10, 2), ("G21", "Q5", 10, 2), ("G20", "Q2500", 0.5, 2)])
def test_a_peck_without_a_decimal_point(kerf, program, units, q, z, cuts):
    path = program(f"{units} G90\nT1 M6\nS900 M3\nG0 X0 Y0 Z1\nG83 Z-{z} R0 {q} F10\nG80\nM30\n")
    moved = motions(kerf, path, "--dialect", "fanuc")
    assert len([s for s in moved if s["step"] == "cut"]) == cuts


# ---- senders, GRBL


@pytest.mark.parametrize("sign", "?!~")
@pytest.mark.parametrize("rest", ["", " ", "  ; status", " (status)", "\t"])
def test_a_realtime_command_is_no_error(kerf, program, sign, rest):
    run = kerf("check", "--json", program(HEAD + sign + rest + "\nG0 X0 Y0 Z5\nM30\n"))
    assert run.status != 1 and "sender_line" in run.codes()


@pytest.mark.parametrize("line", ["$110 = 5000.000    (x)", "$110=5000", "$110=5000.000 (x max rate, mm/min)",
                                  "$110: 5000", "$110\t5000\tX max rate", "  [$110=5000.000]",
                                  "<< $110=5000 ; x"])
def test_settings_of_grbl_in_any_layout(kerf, program, line):
    settings = {110: 5000, 111: 5000, 112: 5000, 120: 100, 121: 100, 122: 100}
    lines = [line.replace("110", str(n)).replace("5000", str(v)) for n, v in settings.items()]
    machine = program("\n".join(lines), "grbl.txt")
    path = program(HEAD + "G0 X0 Y0 Z5\nG1 X500 F5000\nM30\n")
    run = kerf("info", "--json", "--machine", machine, path)
    assert run.status == 0, run.err
    slow = program("$110=500\n$111=500\n$112=500\n$120=100\n$121=100\n$122=100\n", "slow.txt")
    usual = program("$110=5000\n$111=5000\n$112=5000\n$120=100\n$121=100\n$122=100\n", "usual.txt")
    times = [kerf("info", "--json", "--machine", m, path).json["time_s"] for m in (machine, usual, slow)]
    assert times[0] == times[1] != times[2]


@pytest.mark.parametrize("cycle", ["G98 G81 X5 Y5 Z-3 R2 F100\n", "G1 Z-3 F100\nG0 Z5\n"])
@pytest.mark.parametrize("options", [[], ["--dialect", "grbl"], ["--dialect", "fanuc"]])
def test_axis_words_after_g80(kerf, program, cycle, options):
    path = program(HEAD + "G0 X10 Y10 Z5\n" + cycle + "G80\nZ15.\nX0 Y0\nM30\n")
    assert [m["to"] for m in motions(kerf, path, *options)][-2:][1] == [0, 0, 15]


def test_linuxcnc_refuses_axis_words_after_g80(kerf, program):
    path = program(HEAD + "G0 X10 Y10 Z5\nG81 X5 Y5 Z-3 R2 F100\nG80\nZ15.\nM30\n")
    run = kerf("steps", "--dialect", "linuxcnc", path)
    assert run.status == 1 and "--dialect fanuc" in run.err


# ---- comments


@pytest.mark.parametrize("text, words", [
    ("T1 D=6. CR=0. - ZMIN=-5. - right hand tap", "a tap"), ("T1 D=6. CR=0. - ZMIN=-5. - reamer", "a reamer"),
    ("T1 D=6. CR=0. - ZMIN=-5. - boring bar", "a boring bar"),
    ("T1 D=6. CR=0. - ZMIN=-5. - counter sink", "90 degrees")])
def test_a_tool_comment_whose_shape_is_assumed_is_reported(kerf, program, text, words):
    path = program("G21 G90\n(" + text + ")\nT1 M6\nS900 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM30\n")
    found = [h for h in kerf("check", "--json", path).json["hazards"] if h["kind"] == "unknown_shape"]
    assert len(found) == 1 and words in found[0]["message"] and found[0]["origin"]["line"] == 2


@pytest.mark.parametrize("text", ["Tool 1: 6 mm tap", "Tool 1: 6mm countersink"])
def test_words_in_no_known_form_leave_the_tool_unknown(kerf, program, text):
    path = program("G21 G90\n(" + text + ")\nT1 M6\nS900 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM30\n")
    assert [h["kind"] for h in kerf("check", "--json", path).json["hazards"]] == ["unknown_tool"]


@pytest.mark.parametrize("text", ["T1 D=6. CR=0. TAPER=45DEG - chamfer mill", "T1 D=6. CR=0. - flat end mill",
                                  "T1 D=10. CR=0. TAPER=41DEG - counter sink"])
def test_a_tool_comment_that_gives_the_shape_is_not(kerf, program, text):
    path = program("G21 G90\n(" + text + ")\nT1 M6\nS900 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM30\n")
    assert not [h for h in kerf("check", "--json", path).json["hazards"] if h["kind"] == "unknown_shape"]


def test_comments_that_linuxcnc_carries_out_are_kept(kerf, program):
    text = (HEAD + "(LOGOPEN, f.txt)\nG0 X0 Y0 Z5\n(PROBEOPEN p.txt)\nG38.2 Z-5 F50\n(LOG, height #5063)\n"
            "(PROBECLOSE)\n(LOGCLOSE)\nG0 Z5\nM2\n")
    run = kerf("post", "--to", "linuxcnc", program(text))
    assert run.status == 0, run.err
    comments = ("LOGOPEN, f.txt", "PROBEOPEN p.txt", "LOG, height #5063", "PROBECLOSE", "LOGCLOSE")
    assert [run.out.splitlines().count(f"({comment})") for comment in comments] == [1] * 5
    other = kerf("post", "--json", "--to", "grbl", program(text), "-o", "out.nc")
    assert other.status == 0 and "post_left_out" in other.codes()


# ---- RepRapFirmware


PRINT = "M104 S200\nG28\n{}\nG1 X5 Y5 Z0.2 F3000\nG1 X20 E1\nM104 S0\n"


def test_g10_l2_sets_a_work_offset_on_reprapfirmware(kerf, program):
    path = program(PRINT.format("G10 L2 P1 X10"), "a.gcode")
    assert motions(kerf, path, "--dialect", "reprapfirmware")[-1]["to"][:2] == [15, 5]
    assert "G10 L2 P1 X10" in kerf("post", "--to", "reprapfirmware", "--dialect", "reprapfirmware", path).out


def test_the_offset_of_a_tool_is_not_lost_in_silence(kerf, program):
    path = program(PRINT.format("G10 P1 X-10 Y2"), "a.gcode")
    run = kerf("post", "--json", "--to", "reprapfirmware", "--dialect", "reprapfirmware", path)
    assert run.status == 1 and "value_unknown" in run.codes()


def test_t_minus_1_deselects_the_tools(kerf, program):
    path = program(PRINT.format("T0\nT-1"), "a.gcode")
    assert kerf("post", "--to", "reprapfirmware", "--dialect", "reprapfirmware", path).status == 0


# ---- arcs


@pytest.mark.parametrize("off, status", [(1.5, 1), (0.6, 1), (0.3, 0)])
def test_an_arc_whose_radii_differ(kerf, program, off, status):
    path = program(HEAD + f"G0 X0 Y0 Z5\nG1 Z-1 F100\nG2 X{20 + off} Y0 I10 J0\nG0 Z5\nM2\n")
    assert kerf("post", "--to", "grbl", path).status == status


# ---- Haas

HAAS = [10, 13, 31, 33, 34, 35, 41, 73, 81, 83, 88, 89, 138, 159]


def test_idle_m_codes_of_haas_are_no_findings(kerf, program):
    path = program(HEAD + "".join(f"M{m}\n" for m in HAAS) + "G0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM30\n")
    run = kerf("post", "--to", "linuxcnc", "--dialect", "haas", path)
    assert run.status == 0 and "M31 does not change the toolpath" in run.err and "warning" not in run.err
    assert kerf("post", "--to", "linuxcnc", "--dialect", "fanuc", path).status == 1


def test_a_time_without_a_machine_counts_probing(kerf, program):
    """100 mm at 50 mm/min are two minutes."""
    text = HEAD + "G0 X0 Y0 Z50\n{}G0 Z50\nM30\n"
    times = [kerf("info", "--json", program(text.format(word))).json["time_s"]["cutting"]
             for word in ("", "G38.2 Z-50 F50\n")]
    assert times == [0, pytest.approx(120)]
