"""Copies, levelling, transforms, resumed lines, passes and files per tool keep the state in force."""
import json
import math

import pytest

H = "G21 G90\nT1 M6\nS9000 M3\n"
MAP = "".join(f"{x} {y} {0.3 * math.sin(x / 8) * math.cos(y / 9):.4f}\n"
              for y in range(0, 50, 10) for x in range(0, 70, 10))


def lines(text):
    return text.replace("|", "\n") + "\n"


@pytest.fixture
def post(kerf, tmp_path):
    """post("program|with|lines", "--columns", 2): the steps of what is written, and the run."""

    def run(text, *options, to="linuxcnc", status=0):
        (tmp_path / "part.nc").write_text(lines(text))
        tools = ("--tool", "1=square d=6 flute=20", "--tool", "2=square d=3 flute=20")
        done = kerf("post", "--json", "--to", to, "part.nc", "-o", "out.nc", *tools, *options)
        assert done.status == status, done.err + done.out
        if status != 0:
            return done
        read = kerf("steps", "out.nc")
        assert read.status == 0, read.err
        done.steps = [json.loads(line) for line in read.out.splitlines()[1:]]
        done.text = (tmp_path / "out.nc").read_text()
        return done

    return run


def cuts(steps):
    """Each cut with the state in force: end, spindle, coolant, work offset, path mode."""
    state, made = {"spindle": "off", "rpm": 0, "coolant": (False, False), "system": 1, "mode": None}, []
    for s in steps:
        kind = s["step"]
        if kind == "spindle":
            state.update(spindle=s["turn"], rpm=s["rpm"])
        elif kind == "coolant":
            state["coolant"] = (s["mist"], s["flood"])
        elif kind == "workzero" and s["sets"] == "select":
            state["system"] = s["system"]
        elif kind == "pathmode":
            state["mode"] = s.get("kind")
        elif kind in ("cut", "arc"):
            made.append({"to": s["to"], **state})
    return made


def test_copies_start_with_the_spindle_on(post):
    run = post("G21 G90|T1 M6|S9000 M3|M8|G0 X10 Y10 Z5|G1 Z-1 F100|G1 X40|G0 Z5|M5|M9|G0 X0 Y0|M30",
               "--columns", "2", "--pitch", "60,0")
    made = cuts(run.steps)
    assert [c["to"] for c in made] == [[10, 10, -1], [40, 10, -1], [70, 10, -1], [100, 10, -1]]
    assert all(c["spindle"] == "cw" and c["rpm"] == 9000 and c["coolant"] == (False, True) for c in made)


def test_copies_start_in_their_work_offset(post):
    run = post("G21 G90|T1 M6|S9000 M3|G54|G0 X10 Y10 Z5|G1 Z-1 F100|G1 X40|G0 Z5|G55|G0 X5 Y5 Z5|G1 Z-2|"
               "G1 X9|G0 Z5|M30", "--columns", "2", "--pitch", "60,0")
    made = cuts(run.steps)
    assert [(c["system"], c["to"][0]) for c in made] == [
        (1, 10), (1, 40), (2, 5), (2, 9), (1, 70), (1, 100), (2, 65), (2, 69)]


AT_MACHINE = ("G21 G90 G17|G53 G0 Z0|T1 M6|S9000 M3|G0 X10 Y10|G0 Z5|G1 Z-1 F100|G1 X40|G0 Z5|G53 G0 Z-2|"
              "G0 X10 Y30|G0 Z5|G1 Z-1|G1 X40|G0 Z5|{}|M5|M30")


def machine_steps(run):
    return [(s["reference"], s["to"], s["unknown_axes"]) for s in run.steps if s.get("reference")]


@pytest.mark.parametrize("options, ends", [
    (("--move", "100,0"), [[110, 10], [140, 10], [110, 30], [140, 30]]),
    (("--rotate", "90"), [[-10, 10], [-10, 40], [-30, 10], [-30, 40]]),
    (("--rotate", "90", "--move", "0,0,2"), [[-10, 10], [-10, 40], [-30, 10], [-30, 40]]),
    (("--mirror", "x"), [[-10, 10], [-40, 10], [-10, 30], [-40, 30]]),
    (("--align", "0,0=0,0; 10,0=0,10"), [[-10, 10], [-10, 40], [-30, 10], [-30, 40]]),
])
@pytest.mark.parametrize("end", ["G53 G0 Z0", "G91 G28 Z0|G90", "G28 G91 Z0|G90|G28 X0 Y0",
                                 "G53 G0 Z0|G53 G0 X-5 Y-5", "G53 G0 Z0|G53 G0 X-5"])
def test_machine_positions_stay_where_they_are(post, options, ends, end):
    """A retraction to the machine's Z0 and the way home do not depend on where the part lies."""
    run = post(AT_MACHINE.format(end), *options)
    made = [c["to"] for c in cuts(run.steps)]
    assert [to[:2] for to in made] == [pytest.approx(xy) for xy in ends]
    assert all(to[2] == (1 if "0,0,2" in options else -1) for to in made)
    found = machine_steps(run)
    assert found[0][1][2] == 0 and found[1][1][2] == -2  # in coordinates of the machine
    assert "G53 G0 Z-2" in run.text
    if end.endswith("X-5 Y-5"):
        assert "G53 G0 X-5 Y-5" in run.text
    if end.endswith("X-5"):
        assert run.text.count("G53 G0 X-5\n") == 1


@pytest.mark.parametrize("end", ["G53 G0 Z0", "G91 G28 Z0|G90", "G28 G91 Z0|G90|G28 X0 Y0",
                                 "G53 G0 Z0|G0 X0 Y0"])
def test_copies_are_retracted_once(post, end):
    run = post(AT_MACHINE.format(end), "--columns", "2", "--pitch", "60,0")
    made = [c["to"] for c in cuts(run.steps)]
    assert made == [[x + by, y, -1] for by in (0, 60) for y in (10, 30) for x in (10, 40)]
    assert run.text.count("G53 G0 Z-2") == 2  # within each copy
    assert run.text.count("G53 G0 Z0") == (2 if "G53" in end else 1)  # at the start and the end
    assert run.text.count("G28") == end.count("G28")
    last = [s["to"][:2] for s in run.steps if "to" in s][-1]
    assert last == ([0, 0] if "Y0" in end else [100, 30])
    first_of_copy = next(i for i, s in enumerate(run.steps) if s["step"] == "cut" and s["to"][0] == 70)
    crossing = [s for s in run.steps[:first_of_copy] if s["step"] == "rapid"][-2]
    assert crossing["to"] == [70, 10, 5] and "unknown_axes" not in crossing


@pytest.mark.parametrize("end, word", [
    ("G53 G0 X0 Y0|G1 Z-1 F100", "cuts at a position of the machine"),
    ("G28 X0 Y0|G91 G0 X5", "by a distance from a position of the machine"),
    ("G53 G1 X0 F100", "cuts at a position of the machine"),
])
@pytest.mark.parametrize("options", [("--move", "1,0"), ("--rotate", "90"),
                                     ("--columns", "2", "--pitch", "60,0")])
def test_what_starts_at_a_machine_position_is_refused(post, options, end, word):
    run = post(AT_MACHINE.format(end), *options, status=1)
    assert word in run.out


def test_copies_that_cannot_start_as_the_program_are_refused(post):
    run = post("G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G0 Z5|G10 L2 P1 X5|G0 X3|G1 Z-1|G0 Z5|M30",
               "--columns", "2", "--pitch", "60,0", status=1)
    assert "pass_refused" in run.codes()


def test_further_tools_start_above_the_copies(post):
    run = post("G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z9|G1 Z-1 F100|G0 Z1|T2 M6|M3|G0 X20 Y10|G0 Z2|G1 Z-1|"
               "G0 Z9|M30",
               "--columns", "2", "--pitch", "60,0")
    here, low = [0, 0, 0], []
    for s in run.steps:
        if s["step"] == "rapid" and s["to"][:2] != here[:2] and min(here[2], s["to"][2]) < 9:
            low.append((here, s["to"]))
        here = s.get("to", here)
    # From where the machine is, and as in the program, from where its first tool has stopped.
    assert low == [([0, 0, 0], [10, 10, 9]), ([10, 10, 1], [20, 10, 1]), ([70, 10, 1], [80, 10, 1])]


def test_levelled_rapids_from_an_unknown_height(post, tmp_path):
    (tmp_path / "map.txt").write_text(MAP)
    run = post("G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G0 Z5|G53 G0 Z0|T2 M6|M3|G0 X55 Y35 Z5|"
               "G1 Z-1|G0 Z5|M30", "--level", "map.txt")
    rapids = [s for s in run.steps if s["step"] == "rapid" and s["tool"] == 2]
    assert len(rapids) == 2 and all(abs(s["to"][2] - 5) < 0.35 for s in rapids)


@pytest.mark.parametrize("to", ["linuxcnc", "grbl", "mach3"])
def test_levelling_twice_is_refused(post, kerf, tmp_path, to):
    (tmp_path / "map.txt").write_text(MAP)
    program = H.replace("\n", "|") + "G0 X10 Y10 Z5|G1 Z-1 F100|G1 X40|G0 Z5|M30"
    text = post(program, "--level", "map.txt", to=to).text
    (tmp_path / "once.nc").write_text(text)
    again = kerf("post", "--json", "--to", to, "once.nc", "--level", "map.txt", "-o", "twice.nc")
    assert again.status == 1 and "level_twice" in again.codes()
    # Also after another post.
    assert kerf("post", "--to", "grbl", "once.nc", "-o", "other.nc").status == 0
    assert kerf("post", "--to", "grbl", "other.nc", "--level", "map.txt", "-o", "twice.nc").status == 1


def test_a_program_that_probes_its_zero_is_levelled_with_a_warning(post, tmp_path):
    (tmp_path / "map.txt").write_text(MAP)
    run = post("G21 G90|T1 M6|G0 X10 Y10 Z5|G38.2 Z-20 F50|G10 L20 P1 Z0|G0 Z5|S9000 M3|G1 Z-1 F100|G1 X40|"
               "G0 Z5|M30",
               "--level", "map.txt")
    assert "level_twice" in run.codes()


G18 = "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G18 G3 X20 Z-1 I5 K0|G17 G0 Z5|M2"
G19 = "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G19 G2 Y20 Z-1 J5 K0|G17 G0 Z5|M2"


def points_of(steps):
    """Points along all cuts, from the words of arcs alone."""
    made, here = [], None
    for s in steps:
        if s["step"] == "cut":
            made.append(s["to"])
        if s["step"] == "arc":
            # right-handed frames: XY, ZX, YZ
            u, v = {"XY": (0, 1), "XZ": (2, 0), "YZ": (1, 2)}[s["plane"]]
            centre = s["centre"] if s["plane"] != "XZ" else s["centre"][::-1]
            start = math.atan2(here[v] - centre[1], here[u] - centre[0])
            end = math.atan2(s["to"][v] - centre[1], s["to"][u] - centre[0])
            radius = math.hypot(here[v] - centre[1], here[u] - centre[0])
            sign = 1 if s["turn"] == "ccw" else -1
            sweep = (sign * (end - start)) % (2 * math.pi) or 2 * math.pi
            for k in range(1, 17):
                p = list(here)
                angle = start + sign * sweep * k / 16
                p[u], p[v] = centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)
                made.append(p)
        here = s.get("to", here)
    return made


@pytest.mark.parametrize("program", [G18, G19])
@pytest.mark.parametrize("options, mapped", [
    (("--rotate", "180"), lambda x, y: (-x, -y)), (("--rotate", "90"), lambda x, y: (-y, x)),
    (("--rotate", "-90"), lambda x, y: (y, -x)), (("--mirror", "x"), lambda x, y: (-x, y)),
    (("--mirror", "y"), lambda x, y: (x, -y)), (("--mirror", "x", "--rotate", "90"), lambda x, y: (-y, -x)),
    (("--move", "3,4,1"), lambda x, y: (x + 3, y + 4))])
def test_arcs_in_upright_planes_are_transformed(post, program, options, mapped):
    before, after = points_of(post(program).steps), points_of(post(program, *options).steps)
    assert len(before) == len(after)
    for (x, y, z), p in zip(before, after):
        assert p == pytest.approx([*mapped(x, y), z + (1 if "--move" in options else 0)], abs=2e-3)


def resumed(post, text, line, *options):
    return post(text, "--from-line", str(line), "--safe-z", "20", *options)


def test_rotary_axes_turn_before_the_descent(post):
    run = resumed(post, H.replace("\n", "|") + "G0 X10 Y10 Z5 A0|G1 Z-1 F100|G1 X20 A90|G1 X30|G0 Z5|M30", 7)
    seen = [(s["to"], s.get("abc")) for s in run.steps if "to" in s]
    turned = next(i for i, (_, abc) in enumerate(seen) if abc and abc[0] == 90)
    assert seen[turned][0][2] == 20
    assert all(to[2] >= 20 for to, _ in seen[:turned])
    assert all(abc and abc[0] == 90 for to, abc in seen[turned:])


SUB = "O100 sub|G91 G1 Z-3 F100|G1 X5|G0 Z3|G90|O100 endsub|"


def ends(run):
    return [s["to"] for s in run.steps if s["step"] == "cut"]


def test_a_line_with_a_call_resumes_at_the_call(post):
    text = SUB + "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z2|O100 call|G0 X40 Y10 Z2|O100 call|G0 Z9|M30"
    assert text.split("|")[10] == "O100 call"
    run = resumed(post, text, 11)
    assert ends(run) == [[10, 10, 2], [10, 10, -1], [15, 10, -1], [40, 10, -1], [45, 10, -1]]
    second = resumed(post, text, 13)
    assert ends(second) == [[40, 10, 2], [40, 10, -1], [45, 10, -1]]
    inside = resumed(post, text, 3)  # G1 X5 of the subroutine
    assert ends(inside) == [[10, 10, -1], [15, 10, -1], [40, 10, -1], [45, 10, -1]]
    assert any("subroutine" in d["message"] and ":11" in d["message"] for d in inside.json["diagnostics"])


def test_a_subroutine_behind_the_program_is_not_repeated(post):
    text = "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|M98 P100|G0 X40 Y10 Z5|G1 Z-1 F100|G1 X50|G0 Z5|M30|" \
           "O100|G1 Z-3 F100|G1 X15|G0 Z5|M99"
    run = resumed(post, text, 8)
    assert ends(run) == [[40, 10, -1], [50, 10, -1]]


def test_of_a_loop_the_first_pass_is_run_with_a_note(post):
    text = "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|#1=1|O1 while [#1 LE 3]|G1 Z[-#1] F100|G1 X[10+#1]|" \
           "#1=[#1+1]|O1 endwhile|G0 Z5|M30"
    run = resumed(post, text, 8)
    assert ends(run) == [[10, 10, -1], [11, 10, -1], [11, 10, -2], [12, 10, -2], [12, 10, -3], [13, 10, -3]]
    assert any("several times" in d["message"] for d in run.json["diagnostics"])


def deepest(steps):
    """The largest depth that a cut takes where the tool has not been before, of cuts along X at one Y."""
    floor, worst, here = {}, 0, None
    for s in steps:
        if s["step"] == "cut" and here and s["to"][0] != here[0]:
            for x in range(math.ceil(min(here[0], s["to"][0])), math.floor(max(here[0], s["to"][0])) + 1):
                z = max(here[2], s["to"][2])
                worst = max(worst, floor.get(x, 0) - z)
                floor[x] = min(floor.get(x, 0), z)
        here = s.get("to", here)
    return worst, floor


def test_passes_where_rapids_carry_the_depth(post):
    run = post("G21 G90|T1 M6|S9000 M3|G0 X-10 Y10 Z5|G0 Z-9|G1 X110 F300|G0 Z5|M30", "--step-down", "2")
    worst, floor = deepest(run.steps)
    assert worst <= 2 + 1e-9 and set(floor.values()) == {-9}
    assert len(cuts(run.steps)) == 5


def test_passes_of_a_cut_with_a_spindle_word(post):
    run = post(H.replace("\n", "|") + "G0 X0 Y10 Z5|G1 Z-6 F100|G1 X50|S12000 M3|G1 X100|G0 Z5|M30",
               "--step-down", "2")
    worst, floor = deepest(run.steps)
    assert worst <= 2 + 1e-9 and set(floor.values()) == {-6}
    for c in cuts(run.steps):
        assert c["rpm"] == (12000 if c["to"][0] > 50 else 9000), c


def test_passes_of_a_cut_behind_a_pause_are_refused(post):
    run = post(H.replace("\n", "|") + "G0 X0 Y10 Z5|G1 Z-6 F100|G1 X50|M0|G1 X100|G0 Z5|M30",
               "--step-down", "2", status=1)
    assert run.codes() == ["pass_refused"]


def test_coolant_that_starts_after_the_plunge_is_in_all_passes(post):
    run = post(H.replace("\n", "|") + "G0 X0 Y10 Z5|G1 Z-6 F100|M8|G1 X100|G0 Z5|M9|M30", "--step-down", "2")
    made = cuts(run.steps)
    along = [c for c in made if c["to"][0] == 100]
    assert [c["to"][2] for c in along] == [-2, -4, -6]
    assert all(c["coolant"] == (False, True) for c in along)
    assert all(c["coolant"] == (False, False) for c in made if c["to"][0] == 0)


DOWN = "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z-5|G1 Z1 F100|G1 X40|G0 Z-5|G0 X0 Y0|M30"


@pytest.mark.parametrize("options", [
    ("--columns", "2", "--pitch", "60,0"), ("--step-down", "0.5"), ("--order",),
    ("--from-line", "6", "--safe-z", "5"), ("--lead", "2"), ("--tab-height", "0.5"), ("--level", "map.txt")])
def test_heights_are_not_added_to_programs_that_count_z_downwards(post, tmp_path, options):
    (tmp_path / "map.txt").write_text(MAP)
    run = post(DOWN, *options, status=1)
    assert run.codes() == ["pass_refused"]
    assert "downwards" in run.json["diagnostics"][0]["message"]


def test_a_helix_after_a_probe_is_not_divided(post):
    text = "G21 G90|T1 M6|M3 S900|G0 X0 Y0 Z5|G38.2 Z-20 F50|G2 X0 Y0 Z-1 I5 J0 F100|G0 Z5|M30"
    for to in ("linuxcnc", "grbl"):
        run = post(text, to=to)
        arcs = [line for line in run.text.splitlines() if "G2" in line.split()]
        assert len(arcs) == 1 and "Z-1" in arcs[0] and "I5" in arcs[0], arcs
        assert "10.5" not in run.text
    several = text.replace("I5 J0", "I5 J0 P3")
    assert "post_place_unknown" in post(several, status=1).codes()


def test_files_per_tool_start_in_the_modes_of_the_program(post, kerf, tmp_path):
    (tmp_path / "part.nc").write_text(lines(
        "G21 G90|G64 P0.05|G55|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G0 Z5|T2 M6|M3|"
        "G0 X20 Y10 Z5|G1 Z-2|G0 Z5|M30"))
    done = kerf("post", "--to", "linuxcnc", "--tool-change", "files", "part.nc", "-o", "out.nc")
    assert done.status == 0, done.err
    for tool in (1, 2):
        text = (tmp_path / f"out-T{tool}.nc").read_text()
        assert "G55" in text and "G64 P0.05" in text and "M3 S9000" in text


@pytest.mark.parametrize("change, first", [
    ("G55|T2 M6", "G0 Z7"), ("T2 M6|G55", "G0 Z7"), ("G53 G0 Z-1|T2 M6", "G53 G0 Z-1"),
    ("G53 G0 Z-1|G55|T2 M6", "G53 G0 Z-1"), ("G91 G28 Z0|G90|T2 M6", "G91 G28 Z0"),
    ("T2 M6|G53 G0 Z-1", "G53 G0 Z-1"),
])
def test_files_per_tool_start_with_a_rise(post, kerf, tmp_path, change, first):
    """The tool may be anywhere: it was changed by hand. Its first motion is one of Z alone, upwards."""
    (tmp_path / "part.nc").write_text(lines(
        f"G21 G90|G54|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G0 Z5|{change}|M3|"
        "G0 X20 Y15|G0 Z7|G1 Z-2|G0 Z7|M30"))
    done = kerf("post", "--to", "grbl", "--tool-change", "files", "part.nc", "-o", "out.nc")
    assert done.status == 0, done.err
    written = (tmp_path / "out-T2.nc").read_text().splitlines()
    across = next(i for i, line in enumerate(written) if "X20" in line)
    before = [line for line in written[:across] if "Z" in line and not line.startswith("(")]
    assert before == [first]
    assert "Z7" in written[across + 1]  # in the coordinates of the file


def test_a_file_per_tool_at_an_unknown_height_is_refused(post):
    run = post("G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G0 Z5|G55|T2 M6|M3|G0 X20 Y15|G1 Z-2|"
               "G0 Z7|M30", "--tool-change", "files", status=1)
    assert "starts at an unknown height" in run.out


def length_and_plunges(steps):
    """The length of all cuts seen from above, and the feeds of those straight down below Z0."""
    length, feeds, here = 0, [], None
    for s in steps:
        if s["step"] == "cut" and here:
            length += math.dist(here[:2], s["to"][:2])
            if s["to"][:2] == here[:2] and s["to"][2] < here[2] - 1e-6:
                feeds.append(s["feed"])
        if s["step"] == "arc":
            (u, v), (x, y) = s["centre"], here[:2]
            a, b = (x - u, y - v), (s["to"][0] - u, s["to"][1] - v)
            sweep = math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
            sweep = sweep if s["turn"] == "ccw" else -sweep
            length += math.hypot(*a) * (sweep if sweep > 1e-9 else sweep + 2 * math.pi)
        here = s.get("to", here)
    return length, feeds


@pytest.mark.parametrize("shape", ["rectangular", "triangular"])
@pytest.mark.parametrize("entry", ["plunge", "ramp"])
def test_tabs_add_no_way_to_a_contour_and_no_fast_plunge(kerf, tmp_path, shape, entry):
    """Over many sizes: the ends of tabs lie on any part of the arcs at the corners."""
    for width in range(23, 55, 3):
        job = (f'[[shape]]\nrectangle = [0, 0, {width}, {50 if width > 30 else 20}]\n[tools]\n'
               f'1 = "square d=6 flute=20"\n[[operation]]\nop = "contour"\ntool = 1\ndepth = 4\nfeed = 2000\n'
               f'plunge = 300\nrpm = 9000\nentry = "{entry}"\n')
        (tmp_path / "plain.toml").write_text(job)
        (tmp_path / "held.toml").write_text(job + f'tab-height = 1.5\ntabs = 6\ntab-shape = "{shape}"\n')
        found = []
        for name in ("plain", "held"):
            assert kerf("cut", f"{name}.toml", "--to", "linuxcnc", "-o", f"{name}.nc").status == 0
            read = kerf("steps", f"{name}.nc").out.splitlines()[1:]
            found.append(length_and_plunges([json.loads(line) for line in read]))
        assert found[1][0] == pytest.approx(found[0][0], abs=0.05), width
        assert all(feed <= 300 for feed in found[1][1]), width


def removed(kerf, *arguments):
    run = kerf("simulate", "--json", "--stock", "100x60x12", "--resolution", "0.5", *arguments)
    assert run.status == 0, run.err + run.out
    return json.loads(run.out)["removed_mm3"]


SQUARE = "S9000 M3|G0 X10 Y10 Z5|G1 Z-3 F100|G1 X80 F600|G1 Y40|G0 Z5|M30"


@pytest.mark.parametrize("target", ["grbl", "linuxcnc", "mach3", "carbide"])
def test_the_tool_of_a_program_without_a_tool_change_stays(kerf, tmp_path, target):
    """70 and 30 mm of slots by a 6 mm mill, 3 deep: twice what the assumed mill of 3.175 mm removes."""
    (tmp_path / "part.nc").write_text(lines("G21 G90|" + SQUARE))
    tool = ("--tool", "square d=6 flute=20")
    slots = 3 * (6 * 100 + 9 * math.pi - 9 + 9 * math.pi / 4)  # two round ends, and the corner between
    assert kerf("post", "part.nc", "--to", target, "-o", "out.nc", *tool).status == 0
    for program, options in (("part.nc", tool), ("out.nc", ())):
        assert removed(kerf, program, *options) == pytest.approx(slots, rel=0.002)
    assert json.loads(kerf("info", "--json", "out.nc").out)["tools"]


def test_a_described_tool_of_a_program_without_a_tool_change_stays(kerf, tmp_path):
    (tmp_path / "part.nc").write_text(lines("(6mm Endmill)|G21 G90|" + SQUARE))
    assert kerf("post", "part.nc", "--to", "grbl", "-o", "out.nc").status == 0
    assert removed(kerf, "out.nc") == pytest.approx(removed(kerf, "part.nc"), rel=1e-6)


def test_passes_leave_what_undercutting_tools_cut(kerf, tmp_path):
    """A dovetail goes in from the side: a pass above would cut away the neck of the slot."""
    text = lines("G21 G90|T1 M6|S9000 M3|G0 Z20|G0 X-20 Y30|G0 Z-6|G1 X120 F300|G0 Z20|M30")
    (tmp_path / "part.nc").write_text(text)
    tool = ("--tool", "1=dovetail d=12 flute=8 angle=14")
    run = kerf("post", "part.nc", "--to", "linuxcnc", "--step-down", "2", "-o", "out.nc", *tool)
    assert run.status == 0 and "wider below" in run.err
    assert removed(kerf, "out.nc", *tool) == pytest.approx(removed(kerf, "part.nc", *tool), rel=1e-6)


def test_the_name_of_a_program_does_not_name_its_controller(kerf, tmp_path):
    text = lines("G21 G90|" + SQUARE.replace("M30", "G4 P5|M30"))
    (tmp_path / "mach3_part.nc").write_text(text)
    run = kerf("post", "mach3_part.nc", "--dialect", "rs274", "--to", "linuxcnc", "-o", "out.nc")
    assert run.status == 0, run.err
    assert kerf("check", "out.nc").err.count("Mach3") == 0
    steps = [json.loads(line) for line in kerf("steps", "out.nc").out.splitlines()[1:]]
    assert max(s["seconds"] for s in steps if s["step"] == "dwell") == pytest.approx(5)


@pytest.mark.parametrize("option", ["--tabs", "--tab-length", "--align-probe", "--entry-angle"])
def test_an_option_without_effect_is_an_error(kerf, tmp_path, option):
    (tmp_path / "part.nc").write_text(lines("G21 G90|" + SQUARE))
    run = kerf("post", "part.nc", "--to", "grbl", option, "4")
    assert run.status == 2 and option in run.err


def test_a_beam_that_starts_at_power_0_is_a_laser(kerf, tmp_path):
    """A spindle's dwell after M3 would burn a hole."""
    text = "G21 G90|M4 S0|G0 X0 Y0|G1 X40 F1000 S500|G1 Y20|G0 X0|G1 Y0 S300|M5|M2"
    (tmp_path / "engrave.nc").write_text(lines(text))
    assert kerf("post", "engrave.nc", "--to", "grbl", "-o", "out.nc").status == 0
    assert "G4" not in (tmp_path / "out.nc").read_text()
    assert "no_tool" not in kerf("check", "--json", "engrave.nc").out


def test_the_tool_at_the_start_is_no_tool_change(kerf, tmp_path):
    """Its comment describes the tool. Written again for a changer, the program still does not call it."""
    (tmp_path / "part.nc").write_text(lines("G21 G90|" + SQUARE))
    tool = ("--tool", "square d=6 flute=20")
    for target in ("grbl", "linuxcnc"):
        assert kerf("post", "part.nc", "--to", target, "-o", "out.nc", *tool).status == 0
        assert '"step":"tool"' not in kerf("steps", "out.nc").out
        assert kerf("post", "out.nc", "--to", "linuxcnc", "-o", "again.nc").status == 0
        text = (tmp_path / "again.nc").read_text()
        assert "M6" not in text and "(tool 1 at the start: square, diameter 6 mm" in text
        assert kerf("simulate", "part.nc", *tool, "-o", "part.kerf").status == 0
        assert kerf("post", "part.kerf", "--to", "linuxcnc", "-o", "kept.nc").status == 0
        assert "M6" not in (tmp_path / "kept.nc").read_text()


@pytest.mark.parametrize("own, rise", [
    ("G0 X0 Y0|G43 H2 Z5", ["G43 H2", "G0 Z50", "X20 Y10", "X0 Y0"]),
    ("G43 H2|G0 X0 Y0 Z5", ["G43 H2", "G0 Z5", "X20 Y10"]),
    ("G43 H2|G0 Z5", ["G43 H2", "G0 Z5", "X20 Y10"]),
])
@pytest.mark.parametrize("first", ["G43 H1|", ""])
def test_a_file_per_tool_rises_with_the_length_of_its_tool(post, kerf, tmp_path, first, own, rise):
    """With the length of the tool before it, or with none, the rise could end in the work. It cuts where the
    program does, wherever the tool is at the start of the file."""
    (tmp_path / "part.nc").write_text(lines(
        f"G21 G90|T1 M6|S9000 M3|{first}G0 X10 Y10 Z50|G1 Z-1 F100|G1 X20|G0 Z50|M5|T2 M6|S8000 M3|{own}|"
        "G1 Z-1|G1 X30|G0 Z50|M30"))
    done = kerf("post", "--to", "linuxcnc", "--tool-change", "files", "part.nc", "-o", "out.nc")
    assert done.status == 0, done.err
    written = [line for line in (tmp_path / "out-T2.nc").read_text().splitlines() if line[0] in "GXYZ"]
    assert written[1:1 + len(rise)] == rise
    assert "H1" not in " ".join(written)


def test_a_file_per_tool_that_rises_by_itself_moves_across_before_it_descends(post, kerf, tmp_path):
    (tmp_path / "part.nc").write_text(lines(
        "G21 G90|T1 M6|S9000 M3|G0 X10 Y10 Z5|G1 Z-1 F100|G0 Z5|T2 M6|M3|G53 G0 Z-1|G0 X40|G0 Z2|"
        "G1 Z-2|G0 Z5|M30"))
    done = kerf("post", "--to", "grbl", "--tool-change", "files", "part.nc", "-o", "out.nc")
    assert done.status == 0, done.err
    motions = [line for line in (tmp_path / "out-T2.nc").read_text().splitlines() if set(line) & set("XYZ")
               and line[0] != "("]
    assert motions[:4] == ["G53 G0 Z-1", "G0 X10 Y10", "X40", "Z2"]


def test_a_thread_keeps_its_pitch_where_the_speed_is_set_by_hand(post):
    run = post("G21 G90|T1 M6|M3|G0 X0 Y0 Z5|G33 Z-5 K1.5|G0 Z5|M30")
    assert "G33 Z-5 K1.5" in run.text
    tap = post("G21 G90|T1 M6|M3|G0 X0 Y0 Z5|G33.1 Z-5 K1.25|G0 X9|M30")
    assert "G33.1 Z-5 K1.25" in tap.text
