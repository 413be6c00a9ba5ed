"""What Kerf does not know: positions after probes, at the start and after homing; work offsets, tool lengths
and codes. `check` reports it as a finding; `post` writes words that are right whatever it is, or refuses."""
import re

import pytest

HEAD = "G21 G90\nT1 M6\nS10000 M3\n"
CHECK = ["check", "--json", "--stock", "100x60x12", "--tool", "square d=6 flute=20"]


def kinds(kerf, path, *options):
    run = kerf(*(options or CHECK), path)
    assert run.status == (3 if run.json["hazards"] else 0), run.out
    return {h["kind"]: h for h in run.json["hazards"]}


def posted(kerf, path, *options, post="linuxcnc"):
    """The motions and settings of the output, one line each: without comments, header and footer."""
    run = kerf("post", "-q", "--to", post, *options, path)
    assert run.status == 0, run.err
    lines = [line for line in run.out.splitlines() if not line.startswith("(")]
    return lines[1:]


def refused(kerf, path, *options, post="linuxcnc"):
    run = kerf("post", "--json", "--to", post, *options, path)
    assert run.status == 1, run.out
    return run.codes()


def steps_of(kerf, path):
    import json

    run = kerf("steps", "--json", path)
    assert run.status == 0, run.err
    return [json.loads(line) for line in run.out.splitlines()[1:]]


# ---- starts of cuts, and rapids from unknown positions


PLUNGE = "G21 G90\nM3 S10000\nG0 Z5\nG0 X10 Y10\nG0 Z-3\nG1 X60 F500\nG0 Z5\nM30\n"


def test_bounds_and_stock_contain_the_start_of_a_cut(kerf, program):
    """A cut from X10 to X60: the block that is assumed around it reaches from one tool radius below 10 on."""
    bounds = kerf("info", "--json", program(PLUNGE)).json["motion"]["cut_extent_mm"]
    assert bounds == [[10, 10, -3], [60, 10, -3]]
    run = kerf("check", "--json", "--tool", "square d=6 flute=20", program(PLUNGE))
    found = {h["kind"]: h for h in run.json["hazards"]}
    assert "rapid_in_stock" in found and found["rapid_in_stock"]["origin"]["line"] == 5
    assert found["rapid_in_stock"]["removed_mm3"] == pytest.approx(3 * 3.14159 * 9, rel=0.02)


@pytest.mark.parametrize("start, line", [
    ("G0 X50 Y30 Z-5\n", 4),
    ("G53 G0 Z0\nG0 X50 Y30\nG0 Z-5\n", 6),
    ("G28\nG0 X50 Y30\nG0 Z-5\n", 6),
])
def test_a_rapid_from_an_unknown_height_is_examined_at_its_end(kerf, program, start, line):
    found = kinds(kerf, program(HEAD + start + "G1 X60 F500\nG0 Z5\nM2\n"))
    assert found["rapid_in_stock"]["origin"]["line"] == line


def test_a_rapid_from_an_unknown_height_is_examined_in_a_bar(kerf, program):
    text = HEAD + "G0 X20 Y0 A0\nG0 Z8\nG1 X30 F500\nG0 Z30\nM2\n"
    bar = ["check", "--json", "--rotary", "d=20 length=60", "--tool", "square d=4 flute=20"]
    found = kinds(kerf, program(text), *bar)
    assert found["rapid_in_stock"]["origin"]["line"] == 5


def test_a_plunge_from_an_unknown_height_needs_a_tool_that_can(kerf, program):
    text = HEAD + "G28\nG0 X50 Y30\nG1 Z-5 F100\nG0 Z5\nM2\n"
    found = kinds(kerf, program(text), *CHECK[:-1], "square d=6 flute=20 plunges=false")
    assert found["plunge"]["origin"]["line"] == 6


@pytest.mark.parametrize("away", ["G28", "G30", "G53 G0 X0 Y0"])
def test_a_motion_to_a_machine_position_out_of_the_material_is_found(kerf, program, away):
    cut = HEAD + "G0 X10 Y10 Z5\nG1 Z-5 F100\nX20\n"
    assert kinds(kerf, program(cut + away + "\nM2\n"))["machine_move_low"]["origin"]["line"] == 7
    assert not kinds(kerf, program(cut + "G0 Z5\n" + away + "\nM2\n"))


def test_motions_in_machine_coordinates_are_examined_against_the_travel(kerf, program):
    program("travel_x = [-300, 0]\n", "mill.toml")
    check = [*CHECK, "--machine", "mill.toml"]
    far = HEAD + "G53 G0 Z0\nG53 G0 X-900\nM2\n"
    assert kinds(kerf, program(far), *check)["outside_machine"]["origin"]["line"] == 5
    assert "outside_machine" not in kinds(kerf, program(far.replace("900", "200")), *check)


# ---- probes


def probed(after):
    return HEAD + "G0 X10 Y10 Z5\nG38.2 Z-20 F50\n" + after + "M2\n"


@pytest.mark.parametrize("zero", ["G92 Z1.5", "G10 L20 P1 Z1.5"])
def test_what_follows_a_probe_is_written_from_the_probed_zero(kerf, program, zero):
    """The contact may be anywhere from Z5 to Z-20; after the zero is set there, heights are the program's."""
    text = probed(f"{zero}\nG0 Z5\nX20\nG1 Z-1 F100\nG0 Z5\n")
    lines = posted(kerf, program(text))
    assert lines[2:] == ["G0 X10 Y10 Z5", "G38.2 Z-20 F50", zero, "G0 Z5", "X20", "G1 Z-1 F100", "G0 Z5",
                         "M5", "M2"]


def test_a_retract_after_a_probe_is_relative_or_absolute_as_in_the_program(kerf, program):
    assert "G0 Z5" in posted(kerf, program(probed("G0 Z5\n")))
    lines = posted(kerf, program(probed("G91 G0 Z5\nG90\nG0 X20\n")))
    start = lines.index("G38.2 Z-20 F50")
    assert re.fullmatch(r"G91 G0 Z5\n(G90\n)G0 X20", "\n".join(lines[start + 1:start + 4]))


def test_values_from_a_probe_are_unknown(kerf, program):
    path = program(probed("G0 Z[#5063+5]\nG0 X20\n"))
    assert kinds(kerf, path)["value_unknown"]["origin"]["line"] == 6
    assert "post_cannot" in refused(kerf, path)


def test_conditions_on_a_probe_are_unknown(kerf, program):
    path = program(probed("o1 if [#5063 LT -3]\nG0 X40\no1 endif\n"))
    assert kinds(kerf, path)["value_unknown"]["origin"]["line"] == 6
    assert "post_cannot" in refused(kerf, path)


def test_the_contact_is_unknown_to_checks_and_arcs(kerf, program):
    arc = program(HEAD + "G0 X10 Y10 Z5\nG38.2 X20 F50\nG2 X10 Y20 I-5 J5 F100\nG0 Z5\nM2\n")
    assert kinds(kerf, arc)["not_checked"]["origin"]["line"] == 6
    assert "post_place_unknown" in refused(kerf, arc)


# ---- zeros set at unknown positions


def test_zeros_set_at_an_unknown_position_take_the_given_coordinates(kerf, program):
    """The tool is 20 mm or less below an unknown start; there Z becomes 15, so that Z5 more is 20."""
    text = ("G21 G91\nT1 M6\nS10000 M3\nG38.2 Z-20 F50\nG10 L20 P1 Z15\nG0 Z5\nG90\nG0 X0 Y0\n"
            "G1 Z-1 F100\nM2\n")
    rapids = [s for s in steps_of(kerf, program(text)) if s["step"] in ("rapid", "cut")]
    assert [s["to"][2] for s in rapids] == [20, 20, -1]
    assert "G0 Z20" in posted(kerf, program(text))


@pytest.mark.parametrize("zero, to, length", [
    ("G10 L20 P1 X10 Y10 Z0", "G1 X11 F100", 1),
    ("G92 X100 Y0 Z0", "G1 X101 F100", 1),
])
def test_zeros_set_at_the_start_of_the_program(kerf, program, zero, to, length):
    path = program(HEAD + zero + "\n" + to + "\nM2\n")
    assert kerf("info", "--json", path).json["motion"]["cut_mm"] == pytest.approx(length, abs=1e-9)
    assert posted(kerf, path)[2:4] == [zero, to]


# ---- work offsets


def test_posts_keep_work_offsets(kerf, program):
    cut = "G0 X10 Y10 Z5\nG1 Z-1 F100\nX20\nG0 Z5\n"
    assert "G55" in posted(kerf, program(HEAD + "G55\n" + cut + "M2\n"))
    lines = posted(kerf, program(HEAD + "G54\n" + cut + "G55\n" + cut + "M2\n"))
    assert lines[2:] == ["G54", *cut.split("\n")[:-1], "G55", "G0 X10 Y10 Z5", "G1 Z-1", "X20", "G0 Z5",
                         "M5", "M2"]
    lines = posted(kerf, program(HEAD + "G10 L2 P1 X-200 Y-100 Z-50\n" + cut + "M2\n"))
    assert lines[2:7] == ["G10 L2 P1 X-200 Y-100 Z-50", *cut.split("\n")[:-1]]


def test_several_work_offsets_of_unknown_distance_are_a_finding(kerf, program):
    cut = "G0 X10 Y10 Z5\nG1 Z-1 F100\nX20\nG0 Z5\n"
    found = kinds(kerf, program(HEAD + "G54\n" + cut + "G55\n" + cut + "M2\n"))
    assert found["offset_unknown"]["origin"]["line"] == 9
    both = "G10 L2 P1 X0 Y0 Z0\nG10 L2 P2 X30 Y0 Z0\n"
    assert not kinds(kerf, program(HEAD + both + "G54\n" + cut + "G55\n" + cut + "M2\n"))


def test_a_post_without_the_offset_refuses_what_depends_on_it(kerf, program):
    cut = "G0 X10 Y10 Z5\nG1 Z-1 F100\nX20\nG0 Z5\n"
    text = HEAD + "G54\n" + cut + "G59.3\n" + cut + "M2\n"
    assert "post_cannot" in refused(kerf, program(text), post="grbl")


# ---- tool changes


def test_the_file_of_a_further_tool_starts_above_the_work(kerf, program, tmp_path):
    program(HEAD + "G0 X10 Y10 Z5\nG1 Z-1 F100\nX20\nM5\nT2 M6\nM3\nG0 Z5\nG0 X40\nG1 Z-1\nG0 Z5\nM2\n")
    assert kerf("post", "--to", "grbl", "--tool-change", "files", "part.nc", "-o", "out.nc").status == 0
    second = (tmp_path / "out-T2.nc").read_text()
    motions = re.findall(r"^(?:G[01] )?[XYZ].*$", second, re.M)
    assert motions[0] == "G0 Z5" and motions[1].startswith("X20 Y10")


def test_a_further_tool_that_starts_with_a_cut_is_refused(kerf, program):
    program(HEAD + "G0 X10 Y10 Z5\nG1 Z-1 F100\nX20\nM5\nT2 M6\nM3\nG1 X40\nG0 Z5\nM2\n")
    assert "post_cannot" in refused(kerf, "part.nc", "--tool-change", "files", "-o", "out.nc", post="grbl")


@pytest.mark.parametrize("stop", ["T2 M6\nS1000 M3", "M0"])
@pytest.mark.parametrize("options", [[], ["--shorten-rapids"]])
def test_the_approach_after_a_stop_stays_as_it_is(kerf, program, stop, options):
    """The operator may have moved the tool: X and Y first, as in the program, then Z."""
    cut = "G0 X10 Y10 Z5\nG1 Z-1 F100\nG0 Z5\n"
    path = program(HEAD + cut + stop + "\nG0 X10 Y10\nZ5\nG1 Z-2\nG0 Z5\nM2\n")
    lines = posted(kerf, path, *options)
    cut = next(i for i, line in enumerate(lines) if "Z-2" in line)
    approach = [re.sub("^G0 ", "", line) for line in lines[:cut]]
    assert approach[-2:] == ["X10 Y10", "Z5"] if not options else "X10 Y10" in approach[-2:]


def test_a_motion_in_machine_and_in_work_coordinates_is_not_halved(kerf, program):
    text = "G21 G90\nT4 M6\nS10000 M3\nG0 X0 Y0 Z5\nG41.1 D4\nG1 X20 F100\nY20\nG40\nG53 G0 Z0\nG0 X50\nM2\n"
    assert "post_cannot" in refused(kerf, program(text))


def test_the_number_of_the_tool_is_no_tool_change(kerf, program):
    text = "G21 G90\nM61 Q6\nS1000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM2\n"
    lines = posted(kerf, program(text))
    assert "M61 Q6" in lines and not any("M6 " in line + " " for line in lines)


@pytest.mark.parametrize("length", ["G43.1 Z-7.5", "G43", "G43 H1"])
def test_tool_lengths_are_kept(kerf, program, length):
    lines = posted(kerf, program(HEAD + length + "\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM2\n"))
    assert lines.count(length) == 1 and "\n".join(lines).count("G43") == 1


def test_no_tool_length_is_added(kerf, program):
    assert "G43" not in "\n".join(posted(kerf, program(HEAD + "G0 X0 Y0 Z5\nG1 Z-1 F100\nG0 Z5\nM2\n")))


def test_the_length_of_another_tool_is_a_finding(kerf, program):
    text = HEAD + "G43 H12\nG0 X10 Y10 Z5\nG1 Z-1 F100\nX20\nG0 Z5\nM2\n"
    assert kinds(kerf, program(text))["tool_length"]["origin"]["line"] == 4
    assert not kinds(kerf, program(text.replace("H12", "H1")))
    assert "G43 H12" in posted(kerf, program(text))


# ---- rotary axes


def test_turns_of_arcs_are_spread_over_their_segments(kerf, program):
    """A full circle in two half circles: A turns by half in each."""
    text = HEAD + "G0 X10 Y0 Z5 A0\nG2 X10 Y0 I-10 J0 A360 F100\nM2\n"
    arcs = [line for line in posted(kerf, program(text)) if "I" in line]
    assert [re.search(r"A(\S+)", line).group(1) for line in arcs] == ["180", "360"]


def test_rotary_words_of_unknown_axes_are_written(kerf, program):
    lines = posted(kerf, program(HEAD + "G0 A0\nG0 X0 Y0 Z5\nG1 X5 A90 F100\nG91 G28 A0\nG90\nG0 A90\nM2\n"))
    text = "\n".join(lines)
    assert "G0 A0" in lines and "G91 G28 A0\nG90" in text and "X0 Y0 Z0 A0" not in text
    assert lines[lines.index("G90") + 1] == "G0 A90"


def test_an_axis_at_home_is_unknown_until_it_is_named_again(kerf, program):
    """LinuxCNC's G28 without axis words moves all axes, B too. A and C are in no line: the machine may not
    have them."""
    text = HEAD + "G0 X1 Y1 Z5 B0\nG28\nG0 X1\nG0 B-17\nM2\n"
    motions = [step.get("unknown_axes", []) for step in steps_of(kerf, program(text)) if "to" in step]
    assert motions[1:] == [[], ["X", "Y", "Z", "B"], ["Y", "Z", "B"], ["Y", "Z"]]


def test_a_home_with_a_known_and_an_unknown_axis_is_one_motion(kerf, program):
    """G28.1 stores X10 Y10 and a Z that is not known yet: G28 goes there from X20 along both axes."""
    text = HEAD + "G0 X10 Y10\nG28.1\nG0 Z5\nG0 X20\nG28\nM2\n"
    lines = posted(kerf, program(text))
    assert lines[lines.index("G91 G28 X0 Z0") - 1] == "X20"


def test_inverse_time_from_an_unknown_angle_has_no_feed(kerf, program):
    assert "post_no_feed" in refused(kerf, program(HEAD + "G0 X0 Y0 Z5\nG93 G1 A0 F2\nM2\n"))


def test_rotary_feeds_are_degrees_per_minute(kerf, program):
    """90 degrees in half a minute (F2 of G93) are 180 degrees a minute; in inches too."""
    for units in ("", "G20\n"):
        text = HEAD + units + "G0 X0 Y0 Z5 A0\nG93 G1 A90 F2\nM2\n"
        assert "G1 A90 F180" in posted(kerf, program(text), "--mm")


# ---- what is not understood


@pytest.mark.parametrize("line", ["G31 Z-30 F55", "G65 P9811 Z-8. X3", "G28.2 X50 Y60"])
def test_axis_words_of_codes_that_are_left_out_move_nothing(kerf, program, line):
    path = program(HEAD + "G0 X0 Y0 Z5\n" + line + "\nG0 X20\nG0 Z5\nM2\n")
    ends = [s["to"] for s in steps_of(kerf, path) if s["step"] in ("rapid", "cut")]
    assert ends[:2] == [[0, 0, 5], [20, 0, 5]]
    assert kinds(kerf, path)["left_out"]["origin"]["line"] == 5


def test_skip_is_a_probe_on_mach3(kerf, program):
    path = program(HEAD + "G0 X0 Y0 Z5\nG31 Z-30 F55\nG92 Z0\nG0 Z5\nM2\n")
    steps = [s["step"] for s in steps_of(kerf, path)]
    assert "probe" not in steps
    run = kerf("steps", "--json", "--dialect", "mach3", path)
    assert '"probe"' in run.out
    assert kerf("post", "-q", "--to", "mach3", "--dialect", "mach3", path).out.count("G31 Z-30 F55") == 1


def test_macros_of_the_program_are_called_with_their_arguments(kerf, program):
    """Letters are #1 to #26 as on Fanuc's controls: X is #24, Q is #17."""
    text = ("%\nO0001\nG21 G90\nT1 M6\nS1000 M3\nG0 X0 Y0 Z5\nG65 P200 X30 Q2 A7\nG0 Z5\nM30\n"
            "O0200\nG1 X#24 Y#1 F100\nG1 Z-#17\nM99\n%\n")
    run = kerf("steps", "--json", "--dialect", "fanuc", program(text))
    assert run.status == 0, run.err
    assert '"to":[30.0,7.0,5.0]' in run.out and '"to":[30.0,7.0,-2.0]' in run.out


@pytest.mark.parametrize("text, kind", [
    ("G91\nG0 X10\nG1 Z-5 F100\nG0 Z5\n", "not_checked"),
    ("M150\nG0 X10 Y10 Z5\nG1 Z-1 F100\nG0 Z5\n", "left_out"),
    ("G0 X500 Y500 Z5\nG1 Z-1 F100\nG0 Z5\n", "stock_untouched"),
    ("G0 X10 Y10 Z5 A0\nG1 Z-1 A90 F100\nG0 Z5\n", "not_checked"),
])
def test_what_is_not_examined_is_a_finding(kerf, program, text, kind):
    assert kind in kinds(kerf, program(HEAD + text + "M2\n"))


# ---- messages and dwells


def test_comments_that_controllers_obey_are_not_made(kerf, program):
    lines = kerf("post", "-q", "--to", "linuxcnc",
                 program(HEAD + "(MSG, LOGOPEN, file)\n(MSG, hello)\nG0 X0 Y0 Z5\nM2\n")).out.splitlines()
    assert "(MSG, LOGOPEN, file)" in lines and "(MSG, hello)" in lines
    assert not any(line.startswith("(LOGOPEN") for line in lines)


@pytest.mark.parametrize("word, seconds", [("P500", 0.5), ("P1.5", 1.5), ("X2.5", 2.5), ("U3", 3)])
def test_dwells_of_fanuc(kerf, program, word, seconds):
    """P without a decimal point is in milliseconds; X, U and numbers with a point are seconds."""
    run = kerf("steps", "--json", "--dialect", "fanuc", program(HEAD + f"G4 {word}\nG0 X0 Y0 Z5\nM2\n"))
    assert f'"seconds":{float(seconds)}' in run.out, run.out


TURNED = "G21 G90 G18\nG97 S900 M3\nT1 M6\nG95 G0 X10 Z5\nG1 Z-20 F0.1\nG0 X12\nM2\n"


def test_a_turning_program_is_named(kerf, program):
    def names_a_lathe(text):
        return any("lathe" in h["message"] for h in kerf(*CHECK, program(text)).json["hazards"])

    assert names_a_lathe(TURNED)
    assert not names_a_lathe(TURNED.replace("G0 X10 Z5", "G0 X10 Y2 Z5"))


@pytest.mark.parametrize("first, second", [("#5063 GT 99", "1 GT 0"), ("1 GT 2", "#5063 LT 99")])
def test_a_choice_by_a_probed_value_is_unresolved(kerf, program, first, second):
    """Whichever of the conditions that are evaluated depends on the probe, the first or the last."""
    text = (f"G21 G90\nG0 X0 Y0 Z5\nG38.2 Z-5 F50\no1 if [{first}]\nG0 X1\no1 elseif [{second}]\nG0 X2\n"
            "o1 endif\nG0 Z5\nM2\n")
    found = [s for s in steps_of(kerf, program(text)) if s["step"] == "unresolved"]
    assert [s["text"] for s in found] == ["the flow of the program"]
    assert refused(kerf, program(text))


def test_known_conditions_after_a_probed_one_are_resolved(kerf, program):
    text = ("G21 G90\nG0 X0 Y0 Z5\nG38.2 Z-5 F50\no1 if [#5063 GT 99]\no1 endif\no2 if [1 GT 0]\nG0 X2\n"
            "o2 endif\no3 repeat [2]\nG91 G0 X1\no3 endrepeat\nM2\n")
    assert sum(s["step"] == "unresolved" for s in steps_of(kerf, program(text))) == 1
