"""kerf gcmc: options, messages and exit statuses of the drop-in, and gcmc programs as input."""
import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

KERF = os.environ["KERF"]
MOVE = "feedrate(100); goto([1, 2, 3]); move([4]);\n"
WORDS = "F100.00000000\nG0 X1.00000000 Y2.00000000 Z3.00000000\nG1 X4.00000000\n"


def test_default_output(kerf, program):
    run = kerf("gcmc", program(MOVE, "p.gcmc"))
    assert run.status == 0 and run.err == ""
    assert WORDS in run.out
    assert re.match(r"\(gcmc compiled code, do not change\)\n\(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\)\n", run.out)
    assert run.out.endswith("(-- epilogue begin --)\nM30 (-- epilogue end --)\n")


def test_standard_input_and_clusters(kerf):
    assert kerf("gcmc", "-qP2", stdin=b"move([1in]);").out == "G1 X25.40\n"
    run = kerf("gcmc", "-qi", "--prec=3", stdin=b"move([1in]); message(1);")
    assert run.out == "G1 X1.000\n" and run.err == "--stdin--:1:23: Runtime message(): 1\n"


def test_as_ngcgui_calls_it(kerf, program, tmp_path):
    program("move([size, -, 1]); message(\"hello\");\n", "part.gcmc")
    run = kerf("gcmc", "--include", ".", "--output", "part.ngc", "--gcode-function", "part",
               "--define=size=2.0", "part.gcmc")
    assert run.status == 0
    assert re.search(r"^part\.gcmc:1:36: Runtime message\(\): hello$", run.err, re.M)
    assert (tmp_path / "part.ngc").read_text() == (
        "(gcmc compiled function: part, do not change)\no<part> sub\nG1 X2.00000000 Z1.00000000\n"
        "o<part> endsub\nM2\n")


def test_includes(kerf, program, tmp_path):
    (tmp_path / "inc").mkdir()
    (tmp_path / "inc" / "a.inc.gcmc").write_text("message(\"in a\");\n")
    run = kerf("gcmc", "-q", "-I", "inc", stdin=b'include("a.inc.gcmc");')
    assert run.err == "inc/a.inc.gcmc:1:15: Runtime message(): in a\n"
    run = kerf("gcmc", "-q", stdin=b'include("no.gcmc");')
    assert run.err.endswith("Include file 'no.gcmc' cannot be found\n")


@pytest.mark.parametrize("library", ["canned_drill", "tracepath", "tracepath_comp", "engrave", "varcs",
                                     "vbezier"])
def test_the_library_is_in_the_program(kerf, library):
    run = kerf("gcmc", "-q", stdin=f'include("{library}.inc.gcmc");'.encode())
    assert (run.status, run.out, run.err) == (0, "", "")


@pytest.mark.parametrize("arguments, words", [
    (["-P", "16"], "Number of decimals out of range (1..15)"),
    (["-P", "x"], "Invalid number of decimals"),
    (["-r", "-x", "1"], "Offsets must be zero when using relative addressing"),
    (["--svg", "--dxf"], "Only one output format specifier allowed"),
    (["-x", "1deg"], "Invalid units for global X-offset"),
    (["-a", "1mm"], "Invalid units for global A-offset"),
    (["-y", "2e6"], "Global Y-offset out of range"),
    (["-z", "abc"], "Invalid global Z-offset 'abc'"),
    (["--svg", "-q"], "Prologue and epilogue options are only allowed with G-code output"),
    (["--nonsense"], "unrecognized option '--nonsense'"),
    (["--svg-no"], "ambiguous option '--svg-no'"),
    (["-k"], "invalid option -- 'k'"),
    (["-o"], "option requires an argument -- 'o'"),
    (["--output"], "option '--output' requires an argument"),
    (["--bare=1"], "option '--bare' doesn't allow an argument"),
    (["-p", "ZX"], "Active plane must be one of 0, 1, 2, XY, XZ or YZ"),
    (["--gcode-function", "A b"], "G-code function name may only contain [a-z0-9_-]"),
    (["--svg-opacity", "2"], "SVG opacity out of range (0.0..1.0)"),
    (["--svg-toolwidth", "-1"], "Invalid SVG toolwidth"),
    (["--compat", "2.0"], "Unknown version '2.0' of gcmc, expected 1.8 or 1.9"),
])
def test_wrong_options(kerf, arguments, words):
    run = kerf("gcmc", *arguments, stdin=b"")
    assert run.status == 1 and words in run.err and run.out == ""


def test_offsets(kerf):
    run = kerf("gcmc", "-q", "-P1", "-x1in", "--offset-z=2", "-c", "3.14159265358979rad", "-U",
               "--offset-v", "5", stdin=b"goto([1, 1, 1, 0, 0, 0, 1, 1, 1]);")
    assert run.out == "G0 X26.4 Y1.0 Z3.0 A0.0 B0.0 C180.0 U1.0 V6.0 W1.0\n"


def test_help_and_version(kerf):
    run = kerf("gcmc", "-h")
    assert run.status == 1 and run.out == "" and "--gcode-function fn" in run.err
    run = kerf("gcmc", "--version")
    assert run.status == 0 and len(run.out.splitlines()) == 2


def test_own_prologue_and_epilogue(kerf, program):
    program("(head)\n", "h")
    program("(end)\n", "e")
    assert kerf("gcmc", "-q", "-G", "h", "-g", "e", stdin=MOVE.encode()).out == "(head)\n" + WORDS + "(end)\n"
    assert kerf("gcmc", "-G", "missing", stdin=b"").status == 1


@pytest.mark.parametrize("text, status", [
    ("return 3;", 3), ("error(1); return 3;", 1), ("x = ;", 1), ("x = y;", 1), ("warning(1);", 0),
    ("x = 1mm+1deg;", 0)])
def test_exit_status(kerf, text, status):
    assert kerf("gcmc", "-q", stdin=text.encode()).status == status


def test_warnings_as_errors(kerf):
    run = kerf("gcmc", "-qW", "-P1", stdin=b"x = 1mm + 1deg; move([x]);")
    assert run.status == 1 and run.out == "G1 X2.0\n"
    assert run.err.endswith("error: Runtime warnings considered to be errors\n")
    run = kerf("gcmc", "-qW", "-P1", stdin=b"warning(1); move([1]);")  # the program's own count as well
    assert run.status == 1 and run.out == "G1 X1.0\n"
    assert run.err.endswith("error: Runtime warnings considered to be errors\n")
    assert kerf("gcmc", "-qW", stdin=b"message(1);").status == 0


def test_a_file_appears_whole_or_not_at_all(kerf, program, files, tmp_path):
    program("old\n", "out.ngc")
    assert kerf("gcmc", "-o", "out.ngc", stdin=b"move([1]); x = 1/0;").status == 1
    assert (tmp_path / "out.ngc").read_text() == "old\n" and files() == ["out.ngc"]
    assert kerf("gcmc", "-qo", "out.ngc", stdin=b"error(\"reported\"); move([1]);").status == 1
    assert (tmp_path / "out.ngc").read_text() == "G1 X1.00000000\n" and files() == ["out.ngc"]
    run = kerf("gcmc", "-o", "no/such/folder.ngc", stdin=b"")
    assert run.status == 1 and "cannot write" in run.err


@pytest.mark.parametrize("text", ["move([1]);", "while(1) { move([1, 2]); }"])
def test_a_write_that_fails_ends_the_program(kerf, text):
    run = kerf("gcmc", "-qo", "/dev/full", stdin=text.encode())
    assert run.status == 1 and run.err.startswith("kerf gcmc: /dev/full: ") and "cannot write" in run.err
    with open("/dev/full", "wb") as full:
        run = subprocess.run([KERF, "gcmc", "-q"], input=text.encode(), stdout=full, stderr=subprocess.PIPE,
                             timeout=60)
    assert run.returncode == 1 and run.stderr == b"kerf gcmc: cannot write to standard output\n"


def test_output_is_limited(kerf, program, files):
    program("while(1) {\n  move([1, 2]);\n}\n", "p.gcmc")
    run = kerf("gcmc", "-q", "--max-output", "1", "p.gcmc")
    assert run.status == 1 and 2**20 <= len(run.out) < 2**21
    assert run.err.startswith("p.gcmc:2:") and "error: More than 1 MB of output" in run.err
    assert kerf("gcmc", "-q", "--max-output=1", "-o", "out.ngc", "p.gcmc").status == 1
    assert files() == ["p.gcmc"]  # no partial output
    run = kerf("gcmc", "--max-output", "0", "p.gcmc")
    assert run.status == 1 and "Output limit must be a number of MB" in run.err


def test_devices_and_links_stay_what_they_are(kerf, program, tmp_path):
    assert kerf("gcmc", "-qo", "/dev/stdout", stdin=b"move([1]);").out == "G1 X1.00000000\n"
    assert Path("/dev/stdout").is_symlink()
    (tmp_path / "link.ngc").symlink_to("real.ngc")
    assert kerf("gcmc", "-qo", "link.ngc", stdin=b"move([1]);").status == 0
    assert (tmp_path / "link.ngc").is_symlink() and (tmp_path / "real.ngc").exists()


def test_the_program_itself_is_not_overwritten(kerf, program, tmp_path):
    program(MOVE, "p.gcmc")
    run = kerf("gcmc", "-o", "./p.gcmc", "p.gcmc")
    assert run.status == 1 and "would replace the input" in run.err
    assert (tmp_path / "p.gcmc").read_text() == MOVE


def test_an_included_file_is_not_overwritten(kerf, program, tmp_path):
    program(MOVE, "part.inc.gcmc")
    program('include("part.inc.gcmc");', "p.gcmc")
    run = kerf("gcmc", "-o", "part.inc.gcmc", "p.gcmc")
    assert run.status == 1 and "would replace the input" in run.err
    assert (tmp_path / "part.inc.gcmc").read_text() == MOVE


def test_an_endless_program_can_be_stopped(tmp_path):
    run = subprocess.Popen([KERF, "gcmc", "-o", "out.ngc"], stdin=subprocess.PIPE, stderr=subprocess.PIPE,
                           cwd=tmp_path)
    run.stdin.write(b"i = 0; while(1) { move([i++ % 100]); }")
    run.stdin.close()
    time.sleep(1.0)
    run.send_signal(signal.SIGINT)
    assert run.wait(timeout=20) == 1
    assert b"Interrupted" in run.stderr.read()
    assert list(tmp_path.iterdir()) == []


def test_drawings(kerf):
    program = b'layerstack("holes"); goto([1, 1]); layer("holes"); circle_cw([5, 5]); move([9, 1]);'
    svg = kerf("gcmc", "--svg", "--svg-toolwidth=1", "--svg-opacity", "1", "--svg-no-grid", stdin=program)
    assert svg.status == 0 and 'inkscape:label="holes"' in svg.out and "A 5.656854,5.656854" in svg.out
    dxf = kerf("gcmc", "--dxf", stdin=program)
    assert dxf.status == 0 and "\nCIRCLE\n" in dxf.out and "\nholes\n" in dxf.out
    assert "path1" not in kerf("gcmc", "--dxf", "--hex-handles", stdin=program).out


def test_check_for_editors(kerf, program):
    program("x = 3\nfoo bar;\n", "bad.gcmc")
    run = kerf("gcmc", "--check", "--json", "bad.gcmc")
    found = json.loads(run.out)["diagnostics"]
    assert run.status == 1 and run.err == ""
    assert found[0] == {"severity": "error", "code": 8002, "name": "gcmc_syntax", "file": "bad.gcmc",
                        "line": 2, "column": 4, "message": "';' expected", "hint": ""}
    run = kerf("gcmc", "--check", "bad.gcmc")
    assert run.status == 1 and "bad.gcmc:2:4: error: ';' expected" in run.err
    assert json.loads(kerf("gcmc", "--check", "--json", stdin=MOVE.encode()).out) == {"diagnostics": []}


def test_explanations(kerf, program):
    program("function f() {\n\tx = raduis;\n}\nradius = 1;\nf();\n", "p.gcmc")
    run = kerf("gcmc", "-q", "--explain", "p.gcmc")
    assert run.err == ("p.gcmc:2:12: error: Variable 'raduis' undefined\n"
                       "    \tx = raduis;\n    \t          ^\n  p.gcmc:5:3: note: in the call of f()\n")
    assert kerf("gcmc", "-q", "p.gcmc").err == "p.gcmc:2:12: error: Variable 'raduis' undefined\n"
    assert "hint: did you mean 'feedrate'?" in kerf("gcmc", "--explain", stdin=b"feedrat(1);").err


def test_programs_beyond_a_limit_end(kerf):
    assert "nested too deeply" in kerf("gcmc", stdin=b"function f() { f(); } f();").err
    assert "more than 2048 MB" in kerf("gcmc", stdin=b"s = \"a\"; while(1) { s += s; }").err


def test_gcmc_programs_are_read_by_steps_and_info(kerf, program):
    program("toolchange(102); spindle(10000); feedrate(400); goto([0, 0, 5]); move([0, 0, -1]); move([10]);"
            "goto([-, -, 5]);\n", "p.gcmc")
    steps = [json.loads(line) for line in kerf("steps", "p.gcmc").out.splitlines()]
    kinds = [s["step"] for s in steps[1:]]
    assert kinds == ["tool", "spindle", "rapid", "cut", "cut", "rapid", "spindle", "end"]  # M30 stops it
    assert steps[5]["to"] == [10, 0, -1] and steps[5]["feed"] == 400
    assert steps[5]["origin"]["line"] == 1
    assert kerf("info", "--json", "p.gcmc").json["motion"]["lines"] == 2


def test_a_hazard_names_the_line_and_the_calls(kerf, program):
    program("""include("tracepath.inc.gcmc");
comment("stockMin:0.00mm, 0.00mm, -6.00mm");
comment("stockMax:40.00mm, 30.00mm, 0.00mm");
toolchange(102); spindle(10000); feedrate(400);
function sink() {
  goto([10, 10, -3]);
}
goto([10, 10, 5]);
sink();
""", "p.gcmc")
    run = kerf("check", "p.gcmc")
    assert run.status == 3
    assert re.search(r"p\.gcmc:6:\d+: .*\n    hint: .*\n  called from p\.gcmc:9:\d+\n", run.out)
    hazard = kerf("check", "--json", "p.gcmc").json["hazards"][0]
    assert hazard["origin"]["line"] == 6 and [c["line"] for c in hazard["callers"]] == [9]
    simulated = kerf("simulate", "--json", "p.gcmc").json
    assert simulated["stock"]["source"] == "program" and simulated["hazards"][0]["origin"]["line"] == 6


def test_includes_are_found_beside_the_program(kerf, tmp_path):
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "lib.inc.gcmc").write_text("function f() { move([1, 2, -1]); }\n")
    (folder / "p.gcmc").write_text('include("lib.inc.gcmc"); f();\n')
    assert kerf("steps", "parts/p.gcmc").out.count('"cut"') == 1
    assert "cannot be found" in kerf("gcmc", "parts/p.gcmc").err  # only the working folder


def test_a_link_named_gcmc_is_gcmc(tmp_path):
    link = tmp_path / "gcmc"
    link.symlink_to(Path(KERF).resolve())
    run = subprocess.run([link, "-q", "-P1"], input=b"move([1]);", capture_output=True, timeout=60)
    assert run.returncode == 0 and run.stdout == b"G1 X1.0\n"


def test_a_pipe_as_output_stays_one(program, tmp_path):
    pipe, taken = tmp_path / "pipe", tmp_path / "taken"
    os.mkfifo(pipe)
    (tmp_path / "link.ngc").symlink_to(pipe)
    with open(taken, "wb") as file, subprocess.Popen(["cat", pipe], stdout=file) as reader:
        path = program("goto([1mm, 2mm]);\n", "part.gcmc")
        done = subprocess.run([KERF, "gcmc", path, "-o", tmp_path / "link.ngc"], timeout=60)
        assert done.returncode == 0 and reader.wait(timeout=60) == 0
    assert pipe.is_fifo() and (tmp_path / "link.ngc").is_symlink()
    assert b"G0 X1" in taken.read_bytes()


def test_an_endless_loop_is_stopped_at_an_adjustable_limit(kerf, program):
    path = program("a = [1]; while(1) { a += a; }\n", "loop.gcmc")
    run = kerf("gcmc", "--max-steps", "2", path)
    assert run.status == 1 and "No output or message in 2 million loop steps" in run.err
    assert kerf("gcmc", "--max-steps", "0", path).status == 1


XZ_ARC = "plane(PLANE_XZ); arc_cw([10, -, 0], 6); arc_ccw([0, -, 0], 6);\n"


def test_versions_put_arcs_of_xz_on_different_sides(kerf, program):
    program(XZ_ARC, "p.gcmc")
    old = kerf("gcmc", "-qP2", "--compat", "1.8", "p.gcmc")
    assert (old.out, old.err) == ("G18\nG2 X10.00 Z0.00 I5.00 K-3.32\nG3 X0.00 Z0.00 I-5.00 K-3.32\n", "")
    new = kerf("gcmc", "-qP2", "--compat=1.9.2", "p.gcmc")
    assert (new.out, new.err) == ("G18\nG2 X10.00 Z0.00 I5.00 K3.32\nG3 X0.00 Z0.00 I-5.00 K3.32\n", "")
    run = kerf("gcmc", "-qP2", "p.gcmc")
    assert run.out == new.out
    assert run.err.count("warning") == 1
    assert run.err.startswith("p.gcmc:1:38: warning: arc_cw() in the XZ plane")


def test_half_circles_and_circles_of_xz_are_the_same_in_all_versions(kerf):
    run = kerf("gcmc", stdin=b"plane(1); arc_cw([10, -, 0], 5); circle_cw([5, -, 0]);")
    assert run.status == 0 and run.err == ""


def test_versions_take_angles_without_unit_differently(kerf, program):
    program("move([-, -, -, 0, 180deg]);\nmove([-, -, -, 1]);\nmove([-, -, -, 2]);\n", "p.gcmc")
    run = kerf("gcmc", "-P3", "p.gcmc")
    assert "G1 A1.000\nG1 A2.000\n" in run.out and run.err.count("warning") == 1
    assert run.err.startswith("p.gcmc:2:18: warning: move() argument 1 has an angle without unit")
    for option, words in ((["--compat", "1.8"], "G1 A1.000"), (["--compat", "1.9"], "G1 A57.296"),
                          (["--compat", "1.9", "--degrees"], "G1 A1.000"), (["--degrees"], "G1 A1.000")):
        run = kerf("gcmc", "-P3", *option, "p.gcmc")
        assert words in run.out and "B180.000" in run.out and run.err == ""
    assert kerf("gcmc", "-q", "p.gcmc").err == ""  # bare text, and the messages of the real program only
    assert "angle without unit" in kerf("gcmc", "-q", "--explain", "p.gcmc").err


def test_version_1_8_does_not_follow_a_helix(kerf):
    helix = b"circle_ccw([5, 0, 3]); message(position());"
    run = kerf("gcmc", "-qP1", "-z", "1", "--compat", "1.8", stdin=helix)
    assert run.out == "G3 X0.0 Y0.0 Z2.0 I5.0 J0.0\n" and run.err.endswith("[0.0mm,0.0mm,0.0mm]\n")
    run = kerf("gcmc", "-qP1", "-z", "1", "--compat", "1.9", stdin=helix)
    assert run.out == "G3 X0.0 Y0.0 Z4.0 I5.0 J0.0\n" and run.err.endswith("[0.0mm,0.0mm,3.0mm]\n")
    run = kerf("gcmc", "-q", "--compat", "1.8", stdin=b"move([5, 5, 5]); arc_cw_r([2, -], 1);")
    assert run.status == 1 and "(D=-6.250000e+00)" in run.err


def test_the_version_is_that_of_the_option(kerf):
    assert re.match(r"gcmc version 1\.9\.0, as implemented by Kerf \d+\.\d+\.\d+\n.*Apache.*\n$",
                    kerf("gcmc", "-V", "--compat", "1.9").out)
    version = b"message(GCMC_VERSION_STR, \" \", GCMC_VERSION);"
    assert "1.8.0 1008000" in kerf("gcmc", "--compat", "1.8", stdin=version).err
    assert "1.9.0 1009000" in kerf("gcmc", "--compat", "1.9", stdin=version).err


def test_other_commands_take_the_version(kerf, program):
    program("feedrate(100); goto([0, 0, 0]); " + XZ_ARC, "p.gcmc")
    centres = {}
    for option in ((), ("--compat", "1.8"), ("--compat", "1.9")):
        run = kerf("steps", *option, "p.gcmc")
        steps = [json.loads(line) for line in run.out.splitlines()]
        centres[option] = [s["centre"][1] for s in steps if s.get("step") == "arc"]
        assert ("in the XZ plane" in run.err) == (option == ())
    assert centres[()] == centres["--compat", "1.9"]
    assert centres["--compat", "1.8"][0] == -centres[()][0] != 0
    assert kerf("steps", "--compat", "3", "p.gcmc").status != 0


SQUARE = """include("tracepath_comp.inc.gcmc");
feedrate(100);
goto([0, 0, 5]);
function trace(path, side) {
  tracepath_comp(path * 1mm, 2mm, side | TPC_CLOSED | TPC_ARCIN | TPC_ARCOUT);
}
"""


@pytest.mark.parametrize("call, warnings", [
    # The tool of radius 2 starts on the side that ends in the corner: it cuts its whole radius into it.
    ("trace({[0, 0, -1], [0, 20], [20, 20], [20, 0]}, TPC_RIGHT);",
     ["cuts 2mm"]),
    ("trace({[0, 0, -1], [0, 20], [20, 20], [20, 0]}, TPC_LEFT);", []),
    ("trace({[0, 10, -1], [0, 20], [20, 20], [20, 0], [0, 0]}, TPC_RIGHT);", []),
    # The passage between X10 and X13 has four corners; the tool is 4 mm wide.
    ("trace({[5, 0, -1], [10, 0], [10, 20], [13, 20], [13, 0], [30, 0], [30, -9], [0, -9], [0, 0]},"
     "TPC_RIGHT);",
     ["cuts 1mm"] * 4),
])
def test_gouges_of_tracepath_comp_are_named(kerf, program, call, warnings):
    program(SQUARE + call + "\n", "p.gcmc")
    for arguments in (["gcmc", "p.gcmc"], ["gcmc", "--check", "p.gcmc"], ["steps", "p.gcmc"]):
        run = kerf(*arguments)
        found = re.findall(r"p\.gcmc:5:\d+: warning: tracepath_comp\(\) (cuts .*?) into its path", run.err)
        assert found == warnings
        assert run.status == 0
    diagnostics = json.loads(kerf("gcmc", "--check", "--json", "p.gcmc").out)["diagnostics"]
    assert [(d["name"], d["line"]) for d in diagnostics] == [("gcmc_gouge", 5)] * len(warnings)


def test_corners_that_are_left_out_are_named(kerf, program):
    trace = SQUARE + "tracepath_comp({[0, 0, -1], [9, 0], [5, 2], [20, 0]} * 1mm, 9mm, TPC_LEFT);\n"
    program(trace, "p.gcmc")
    assert re.search(r"p\.gcmc:7:\d+: warning: tracepath_comp\(\) does not reach the inside corner \[",
                     kerf("gcmc", "p.gcmc").err)
    program(trace.replace("TPC_LEFT)", "TPC_LEFT | TPC_QUIET)"), "p.gcmc")
    assert "does not reach" not in kerf("gcmc", "p.gcmc").err


def test_check_runs_the_program_and_writes_nothing(kerf, program, tmp_path):
    program("message(1); move([1, 2, 3]); x = 1 / 0;\n", "p.gcmc")
    run = kerf("gcmc", "--check", "-o", "p.ngc", "p.gcmc")
    assert (run.status, run.out, run.err) == (1, "", "p.gcmc:1:39: error: Divide by zero\n")
    assert not (tmp_path / "p.ngc").exists()
    assert kerf("gcmc", "--check", stdin=b"return 3;").status == 0


NGCGUI_FILE = """// ngcgui: info: Holes on a circle
// ngcgui: -P 4  // four decimals
//ngcgui: --compat 1.8;
// ngcgui: holes = 6, number of holes
//ngcgui: radius = 20;
// ngcgui: depth = -3, depth of the holes
feedrate(100.0);
message("holes: ", to_int(holes));
if(radius < 1) { error("the radius is too small"); }
repeat(holes; i) {
  goto([radius * cos(to_rad(360deg) * i / holes), radius * sin(to_rad(360deg) * i / holes)]);
  move([-, -, depth]);
  goto([-, -, 5]);
}
"""


def call_of_ngcgui(text, file, entries, output, name):
    """The command of NGCGUI for a gcmc file, from its `//ngcgui:` lines and the values of its entry boxes."""
    options, variables = [], {}
    for line in text.splitlines():
        if re.match(r" *// *ngcgui *: *info *:", line):
            continue
        if option := re.match(r" *// *ngcgui *: *(-.*)$", line):
            options += option[1].split("//")[0].split(";")[0].strip().split(" ")[:2]
        elif variable := re.match(r" *// *ngcgui *: *(.*?) *= *(.*?) *(?:,|$)", line):
            variables[variable[1]] = variable[2].split(";")[0]
    variables.update(entries)
    return (["--include", str(file.parent), "--output", str(output), "--gcode-function", name] + options
            + [f"--define={key}={float(value)}" for key, value in variables.items()] + [str(file)])


def test_ngcgui_compiles_a_file_and_linuxcnc_calls_the_subroutine(kerf, program, tmp_path):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "gcmc").symlink_to(KERF)  # NGCGUI searches PATH for an executable file gcmc
    program(NGCGUI_FILE, "holes.gcmc")
    output = tmp_path / "tmpgcmc_1.ngc"
    arguments = call_of_ngcgui(NGCGUI_FILE, tmp_path / "holes.gcmc", {"holes": "4"}, output, output.stem)
    assert arguments[6:10] == ["-P", "4", "--compat", "1.8"] and "--define=holes=4.0" in arguments
    run = subprocess.run([tmp_path / "bin" / "gcmc", *arguments], capture_output=True, text=True, cwd="/")
    assert (run.returncode, run.stdout) == (0, "")
    assert re.findall(r".*Runtime message\(\): *(.*)", run.stderr) == ["holes: 4"]
    assert run.stderr.count("\n") == 1
    text = output.read_text()
    assert text.startswith(
        "(gcmc compiled function: tmpgcmc_1, do not change)\no<tmpgcmc_1> sub\nF100.0000\n")
    assert text.endswith("o<tmpgcmc_1> endsub\nM2\n") and text.count("G1 Z-3.0000") == 4
    program("G21 G90 G17\nG0 Z5\no<tmpgcmc_1> call\nM2\n", "auto.ngc")
    steps = [json.loads(line) for line in kerf("steps", "auto.ngc").out.splitlines()]
    assert [s["to"][2] for s in steps if s.get("step") == "cut"] == [-3.0] * 4


def test_errors_for_ngcgui(kerf, program, tmp_path):
    program(NGCGUI_FILE, "holes.gcmc")
    file, output = tmp_path / "holes.gcmc", tmp_path / "out.ngc"
    run = kerf("gcmc", *call_of_ngcgui(NGCGUI_FILE, file, {"radius": "0.5"}, output, "f"))
    assert run.status == 1
    assert re.findall(r".*Runtime error\(\): *(.*)", run.err) == ["the radius is too small"]


OPERATIONS = 'include("operations.inc.gcmc");\ngoto([-, -, 20]);\ncutter(1, "square d=4");\nspindle(9000);\n'
JOB = """[[shape]]
name = "outside"
rectangle = [0, 0, 50, 30]
[[shape]]
name = "island"
rectangle = [20, 10, 30, 20]
[tools]
1 = "square d=4"
[[operation]]
op = "pocket"
tool = 1
depth = 3
stepdown = 1.5
feed = 700
plunge = 200
"""
SHAPES = ("{[0, 0], [50, 0], [50, 30], [0, 30], [], [20, 10], [30, 10], [30, 20], [20, 20]} * 1mm")


def motions(run):
    steps = [json.loads(line) for line in run.out.splitlines()]
    return [s for s in steps if s.get("step") in ("rapid", "cut", "arc")]


@pytest.mark.parametrize("unit", ["", "-i"])
def test_an_operation_makes_the_motions_of_a_job(kerf, program, unit):
    keys = "depth=3mm; stepdown=1.5mm; feed=700; plunge=200"
    program(OPERATIONS + f'cut_pocket({SHAPES}, "{keys}");\n', "p.gcmc")
    program(JOB, "p.toml")
    if unit:
        assert kerf("gcmc", unit, "-P12", "p.gcmc", "-o", "p.ngc").status == 0
    made = motions(kerf("steps", "p.ngc" if unit else "p.gcmc"))[1:]
    wanted = motions(kerf("steps", "p.toml"))[1:]  # without the first rise, which this program does itself
    assert len(made) == len(wanted) > 50
    for m, w in zip(made, wanted):
        assert m["step"] == w["step"] and m["to"] == pytest.approx(w["to"], abs=1e-9)
        assert m.get("feed", 0) == pytest.approx(w.get("feed", 0)) and m.get("turn") == w.get("turn")
        assert m.get("extra_turns") == w.get("extra_turns")
        if "centre" in w:
            assert m["centre"] == pytest.approx(w["centre"], abs=1e-9)


@pytest.mark.parametrize("call, lines", [
    ('cut_drill({[5, 5], [20, 5]}, "depth=4; feed=100");', ["cut"] * 2),
    ('cut_engrave({[0, 0], [30, 0], [30, 10]}, "depth=0.5; feed=300; entry=plunge");', ["cut"] * 3),
    ('cut_bore({[10, 10, 12]}, "depth=4; feed=300; plunge=100");', ["arc"]),
    ('cut_contour({[0, 0], [30, 0], [30, 20], [0, 20], [0, 0]}, "depth=2; feed=300; side=outside");',
     ["cut"]),
])
def test_operations_on_points_circles_and_outlines(kerf, program, call, lines):
    program(OPERATIONS + call + "\n", "p.gcmc")
    run = kerf("steps", "p.gcmc")
    kinds = [m["step"] for m in motions(run) if m["step"] != "rapid"]
    assert run.status == 0 and run.err == ""
    assert lines[0] in kinds if len(lines) == 1 else kinds == lines
    assert kerf("check", "p.gcmc").status == 0


def test_the_library_has_every_operation_on_outlines_and_points(kerf):
    text = (Path(__file__).parents[2] / "data" / "gcmc" / "operations.inc.gcmc").read_text()
    functions = re.findall(r'^function cut_(\w+)\(.*__kerf_cut\("([\w-]+)"', text, re.M)
    assert all(name.replace("_", "-") == operation for name, operation in functions)
    known = re.search(r"--op NAME +The operation: (.*)", kerf("cut", "--help").out)[1].split(", ")
    others = {"raster", "waterline", "project"}  # of meshes
    assert {o for _, o in functions} == {k for k in known if k not in others and not k.startswith("laser")}


@pytest.mark.parametrize("call, message", [
    ('cut_pocket({[0, 0], [9, 0], [9, 9]}, "depth=1; deph=2; feed=100");', "deph"),
    ('cut_pocket({[0, 0], [9, 0], [9, 9]}, "depth");', "'depth' is not a key with a value"),
    ('cut_pocket({[0, 0], [30, 0], [30, 30]}, "feed=100");', "depth"),
    ('cut_pocket({}, "depth=1; feed=100");', "no closed outline"),
    ('cut_pocket([1, 2], "depth=1; feed=100");', "must be a vectorlist"),
    ('cut_pocket({[1, -]}, "depth=1; feed=100");', "a point without X or Y"),
    ('cut_pocket({[0, 0], [1, 0], [1, 1]}, "depth=1; feed=100");', "pocket"),
    ('cutter(2, "sqare d=4");', "sqare"),
    ('toolchange(7); cut_pocket({[0, 0], [9, 0], [9, 9]}, "depth=1");', "shape of the tool in the spindle"),
    ('feedmode("upr"); cut_pocket({[0, 0], [9, 0], [9, 9]}, "depth=1");', 'needs feedmode("upm")'),
    ('__kerf_cut("raster", {[0, 0]}, "depth=1");', "'raster' is not an operation on outlines"),
])
def test_operations_that_cannot_be_cut(kerf, program, call, message):
    program(OPERATIONS + call + "\n", "p.gcmc")
    run = kerf("gcmc", "p.gcmc", "-o", "p.ngc")
    assert run.status == 1 and message in run.err and not Path("p.ngc").exists()
    assert re.search(r"^p\.gcmc:5:\d+: error: ", run.err, re.M) and "<kerf>" not in run.err


@pytest.mark.parametrize("shape", ["square d=6 flute=20", "ball d=1/8in flute=0.5in", "vee d=12 angle=60",
                                   "drill d=5 flute=40"])
def test_the_tool_of_a_program_in_inches_is_read_as_it_was(kerf, program, shape):
    text = f'include("operations.inc.gcmc");\ncutter(1, "{shape}");\nspindle(9000);\nfeedrate(300);\n' \
        "goto([5mm, 5mm, 5mm]);\nmove([-, -, -1mm]);\nmove([20mm, -, -]);\n"
    program(text, "p.gcmc")
    tools = []
    for unit in ("", "-i"):
        assert kerf("gcmc", *([unit] if unit else []), "p.gcmc", "-o", "p.ngc").status == 0
        (tool,) = kerf("info", "--json", "p.ngc").json["tools"]
        tools.append(tool)
    metric, inch = tools
    assert metric["shape"] == inch["shape"] and metric["source"] == inch["source"] == "comment"
    for key in ("diameter_mm", "flute_mm"):
        assert inch[key] == pytest.approx(metric[key], abs=1e-6)


def test_an_operation_rises_from_below_and_restores_the_plane(kerf, program):
    program('include("operations.inc.gcmc");\ncutter(1, "square d=4");\nspindle(9000);\nplane("XZ");\n'
            'goto([1, 2, 1]);\ncut_pocket({[0, 0], [30, 0], [30, 30]} * 1mm, "depth=1; feed=100");\n',
            "p.gcmc")
    lines = kerf("gcmc", "-qP1", "p.gcmc").out.splitlines()
    assert lines[:8] == ["T1", "M6", "(TOOL/MILL, 4, 0.00, 12, 0.00)", "S9000.0", "M3", "G18",
                         "G0 X1.0 Y2.0 Z1.0", "(pocket)"]
    assert lines[8] == "G0 Z5.0" and "Z" not in lines[9].replace("Z5.0", "")
    assert lines[-1] == "G18"


def test_the_example_of_operations(kerf):
    example = Path(__file__).parents[2] / "examples" / "bracket.gcmc"
    run = kerf("check", "--json", "--spoilboard", "3", str(example))
    assert run.status == 0 and run.json["hazards"] == []
    assert kerf("gcmc", str(example)).err == ""


def test_paths_of_very_many_points_end_in_time(kerf):
    run = kerf("gcmc", stdin=b"""include("tracepath_comp.inc.gcmc"); p = {};
for(i = 0; i < 20000; i++) { p += {[1mm * cos(i * 0.018deg), 1mm * sin(i * 0.018deg)]}; }
tracepath_comp(p, 3mm, TPC_RIGHT | TPC_CLOSED);
__tpc_follow({[]}, 1mm, 1); __tpc_follow({[1, 2]}, 1mm, 1); move([3, 4]); __tpc_report(); __tpc_report();
""")
    assert run.status == 0
    assert run.err.count("is not checked to its end") == 1
    assert "tracepath_comp() cuts" not in run.err
