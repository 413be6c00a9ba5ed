"""kerf pathdxf, and path drawings as programs: motions, files, messages, exit statuses, hostile input."""

import json
import math
import os
import re
import threading

import pytest
from path_drawing import PARAMETERS, arc, circle, drawing, end, line, path, start, tags, text

OPTIONS = ["/len", "/f150", "/v500", "/s15"]


@pytest.fixture
def save(tmp_path):
    """save("8999.1P.dxf", path(...)): writes a file into the test's folder and returns its name."""

    def write(name, content):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(content, encoding="utf-8")
        return name

    return write


def code_lines(text_of_file):
    """Without comments; what a controller acts on."""
    lines = [re.sub(r"\((?!=)[^)]*\)", "", row).rstrip() for row in text_of_file.splitlines()]
    return [row for row in lines if row and not row.startswith(";")]


def motions(kerf, name):
    run = kerf("steps", name)
    assert run.status == 0, run.err
    steps = [json.loads(row) for row in run.out.splitlines()][1:]
    return [s for s in steps if s["step"] in ("rapid", "cut", "arc")]


def names_of(kerf, name, *options):
    run = kerf("info", "--json", *options, name)
    return run.status, run.codes()


# ---------------------------------------------------------------------------------------------- what is cut


def test_a_line_is_milled_in_passes_forwards_and_backwards(kerf, save):
    steps = motions(kerf, save("8999.1P.dxf", path(line(0, 0, 10, 0))))
    cuts = [(s["to"], s["feed"]) for s in steps if s["step"] == "cut"]
    assert cuts == [([0, 0, 1], 150), ([10, 0, 1], 150), ([10, 0, 0], 150), ([0, 0, 0], 150)]
    assert steps[0]["to"][2] == pytest.approx(5, abs=1e-4)
    assert steps[-1]["to"] == pytest.approx([10, 0, 5], abs=1e-4)
    assert {s["tool"] for s in steps} == {1}


def test_steps_name_the_element_that_caused_them(kerf, save):
    steps = motions(kerf, save("8999.1P.dxf", path(line(0, 0, 10, 0))))
    cut = next(s for s in steps if s["step"] == "cut")
    assert cut["origin"]["file"] == "8999.1P.dxf"
    assert cut["origin"]["layer"] == "8999_1P"
    assert cut["origin"]["at"] == [0, 0]


def test_arcs_stay_arcs_in_both_directions(kerf, save):
    half = arc(5, 0, 5, 0, 180)
    steps = motions(kerf, save("8999.1P.dxf", path(half, parameters="M1 O2 T2 I1 B1 S5")))
    (cut,) = [s for s in steps if s["step"] == "arc"]
    assert cut["turn"] == "cw"  # from (0, 0), the end of the arc as drawn
    assert cut["centre"] == [5, 0] and cut["to"] == pytest.approx([10, 0, 1])


def test_a_helix_stays_within_its_circle_and_ends_at_the_bottom(kerf, save):
    steps = motions(kerf, save("8999.1P.dxf", path(circle(0, 0, 6), to=(0, 0))))
    arcs = [s for s in steps if s["step"] == "arc"]
    assert all(math.hypot(*s["to"][:2]) == pytest.approx(2) for s in arcs)  # 3 less the tool's radius
    heights = [s["to"][2] for s in arcs]
    assert heights == [1.5, 1, 0.5, 0, 0, 0]  # half an infeed each half turn, then a level one


def test_a_hole_of_the_tool_diameter_is_drilled(kerf, save):
    inner = line(0, 0, 10, 0, "DASHED") + circle(10, 0, 2)
    steps = motions(kerf, save("8999.1P.dxf", path(inner)))
    assert [s["to"] for s in steps if s["step"] == "cut"] == [[10, 0, 0]]
    cycle = motions(kerf, save("8999.2P.dxf", path(inner + text(10, 0, "C1"))))
    after = cycle[[s["step"] for s in cycle].index("cut") + 1]
    assert after["step"] == "rapid" and after["to"] == [10, 0, 1]


def test_support_bars_stay(kerf, save):
    # 50 mm, bars of 5 mm at least 20 mm apart: two bars, one of them as halves at the ends.
    bars = line(0, 0, 50, 0, "BORDER")
    parameters = "M1 O2 T2 I2 B0 D1 P5 U20 S5"
    steps = motions(kerf, save("8999.1P.dxf", path(bars, to=(50, 0), parameters=parameters)))
    cuts = [s["to"] for s in steps if s["step"] == "cut" and s["to"][0] > 0]
    expected = [(3.5, 1), (4.5, 0), (20.5, 0), (21.5, 1), (28.5, 1), (29.5, 0), (45.5, 0), (46.5, 1), (50, 1)]
    assert [(round(x, 9), round(z, 9)) for x, _, z in cuts] == expected


def test_slow_milling_does_not_travel(kerf, save):
    two = line(0, 0, 10, 0) + line(10, 0, 10, 10)
    steps = motions(kerf, save("8999.1P.dxf", path(two, to=(10, 10), parameters="M1 O2 T2 I1 B0 S5 W1")))
    ends = [s["to"] for s in steps if s["step"] == "cut"]
    there, back = [[10, 0, 1], [10, 10, 1]], [[10, 0, 1], [0, 0, 1]]
    assert ends == [[0, 0, 1], *there, *back, [0, 0, 0], [10, 0, 0], [10, 10, 0]]


def test_rapids_below_the_path_height_are_not_merged(kerf, save):
    low = line(0, 0, 10, 0, "DASHED") + text(5, 0, "S3") + line(10, 0, 10, 10, "DASHED") + text(10, 5, "S3")
    name = save("8999.1P.dxf", path(low + line(10, 10, 20, 10), to=(20, 10)))
    ends = [s["to"] for s in motions(kerf, name) if s["step"] == "rapid"]
    assert [10, 0, 3] in ends and [10, 10, 3] in ends
    high = line(0, 0, 10, 0, "HIDDEN") + line(10, 0, 10, 10, "HIDDEN")
    name = save("8999.2P.dxf", path(high + line(10, 10, 20, 10), to=(20, 10)))
    ends = [[round(v, 3) for v in s["to"]] for s in motions(kerf, name) if s["step"] == "rapid"]
    assert [10, 0, 5] not in ends and [10, 10, 5] in ends


def test_mirrored_arcs_lie_where_they_are_drawn(kerf, save):
    # Seen from below: x of the centre is negated, angles count clockwise.
    half = arc(-5, 0, 5, 0, 180) + tags((210, 0), (220, 0), (230, -1))
    steps = motions(kerf, save("8999.1P.dxf", path(half, parameters="M1 O2 T2 I1 B1 S5")))
    (cut,) = [s for s in steps if s["step"] == "arc"]
    assert cut["centre"] == [5, 0] and cut["to"] == pytest.approx([10, 0, 1], abs=1e-9)
    assert cut["turn"] == "cw"


# ------------------------------------------------------------------------------------------ embedded paths


def sub_path(parameters="M1 O2 T2 I1 B0", name="8998_1P"):
    return drawing(start(0, 0, parameters, name), line(0, 0, 10, 0, layer=name), end(10, 0, name))


def test_an_embedded_path_is_moved_and_rotated_and_is_the_caller(kerf, save):
    save("8998.dxf", sub_path())
    outer = line(0, 0, 5, 5, "HIDDEN") + line(5, 5, 5, 15, "DASHDOT") + text(5, 10, ">8998.1P M1 O2 T2")
    name = save("8999.1P.dxf", path(outer, to=(5, 15)))
    cuts = [s["to"] for s in motions(kerf, name) if s["step"] == "cut"]
    assert cuts == [pytest.approx(p, abs=1e-9) for p in ([5, 5, 1], [5, 15, 1], [5, 15, 0], [5, 5, 0])]


def test_variables_select_a_path_and_a_depth(kerf, save):
    save("8998.dxf", sub_path("M1 O2 T2 I2 B=D :D0~1 :X?AB"))
    embedding = line(0, 0, 10, 0, "DASHDOT") + text(5, 0, ">8998.1P :D0.5 :XA")
    steps = motions(kerf, save("8999.1P.dxf", path(embedding)))
    assert [s["to"][2] for s in steps if s["step"] == "cut"] == [0.5, 0.5]
    for wrong in (":D2 :XA", ":D0.5", ":D0.5 :XA :Y1", ":D0.5 :XC"):
        bad = line(0, 0, 10, 0, "DASHDOT") + text(5, 0, f">8998.1P {wrong}")
        status, codes = names_of(kerf, save("8999.1P.dxf", path(bad)))
        assert status == 1 and "pathdxf_variable" in codes, wrong


def test_an_undefined_variable_is_named(kerf, save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0) + text(5, 0, "B=Z")))
    status, codes = names_of(kerf, name)
    assert status == 1 and "pathdxf_variable" in codes


@pytest.mark.parametrize("parameters, embedding", [
    ("M2 O2 T2 I1 B0", ">8998.1P M1 O2 T2"), ("M1 O2 T2 I1 B0", ">8998.1P M1 O3 T2"),
    ("M1 O2 T1 I1 B0", ">8998.1P M1 O2 T2"), ("M1 O2 T2 I1 B0", "M1 O2 T2"),
    ("M1 O2 T2 I1 B0", ">8998.1PX M1 O2 T2"), ("M1 O2 T3 I1 B0", ">8998.1P M1 O2 T3")])
def test_an_embedding_that_does_not_fit_is_an_error(kerf, save, parameters, embedding):
    save("8998.dxf", sub_path(parameters))
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0, "DASHDOT") + text(5, 0, embedding)))
    status, codes = names_of(kerf, name)
    assert status == 1 and "pathdxf_embedding" in codes


def test_sub_paths_are_searched_in_folders(kerf, save):
    save("parts/8990-8998 x.dxf", sub_path())
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0, "DASHDOT") + text(5, 0, ">8998.1P")))
    assert kerf("pathdxf", *OPTIONS, "/d", "parts", name).status == 0
    assert kerf("pathdxf", *OPTIONS, name).status == 1
    status, codes = names_of(kerf, name)
    assert status == 1 and "pathdxf_not_found" in codes
    missing = kerf("pathdxf", *OPTIONS, "/dnone", name)
    assert missing.status == 1 and "folder none" in missing.err  # code pathdxf_folder
    save("8998.dxf", sub_path())
    twice = kerf("pathdxf", *OPTIONS, "--folder=parts", name)
    assert twice.status == 1 and "already been defined" in twice.err  # code pathdxf_defined_twice


def test_paths_that_contain_themselves_end(kerf, save):
    layer = "8998_1P"
    own = line(0, 0, 10, 0, "DASHDOT", layer) + text(5, 0, ">8998.1P", layer)
    save("8998.dxf", drawing(start(0, 0, "M1 O2 T2", layer), own, end(10, 0, layer)))
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0, "DASHDOT") + text(5, 0, ">8998.1P")))
    status, codes = names_of(kerf, name)
    assert status == 1 and "pathdxf_nesting" in codes


def test_embeddings_that_multiply_are_bounded(kerf, save):
    """Ten levels of fifty embeddings each would be 1e17 elements."""
    for level in range(1, 11):
        layer = f"80{level:02}_1P"
        inner = "".join(line(x, 0, 0 if x else 10, 0, "DASHDOT", layer) +
                        text(5, 0, f">80{level + 1:02}.1P", layer) for x in (0, 10) * 12)
        if level == 10:
            inner = line(0, 0, 10, 0, layer=layer) + line(10, 0, 0, 0, layer=layer)
        save(f"80{level:02}.dxf", drawing(start(0, 0, "M1 O2 T2 I1 B0", layer), inner, end(0, 0, layer)))
    run = kerf("info", "--json", "8001.dxf", timeout=100)
    assert run.status == 1


# ------------------------------------------------------------------------------------------------ probes


def test_probes_give_three_files_and_corrections(kerf, save, tmp_path):
    probes = circle(0, 20, 6, "PHANTOM") + text(0, 20, "Lleft") + circle(10, 20, 6, "PHANTOM")
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0) + probes))
    assert kerf("pathdxf", *OPTIONS, "/z50", name).status == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "8999.1P.dxf", "8999.1P_Clean.gcode", "8999.1P_Probing.gcode", "8999.1P_Z.txt"]
    assert (tmp_path / "8999.1P_Z.txt").read_text() == (
        "([0.000 20.000]/L:left/T=2.000) #51=\n([10.000 20.000]/T=2.000) #52=\n")
    clean = (tmp_path / "8999.1P_Clean.gcode").read_text()
    # Distances 20 and 22.361: weights 0.528 and 0.472.
    assert "G01 Z1.000(=1.000+0.528*[#51-2.000]+0.472*[#52-2.000])" in clean
    probing = code_lines((tmp_path / "8999.1P_Probing.gcode").read_text())
    assert probing.count("G38.3 Z0 F50.000") == 2
    assert kerf("pathdxf", *OPTIONS, "--probe", "g38.2", name).status == 0
    assert "G38.2 Z0" in (tmp_path / "8999.1P_Probing.gcode").read_text()
    assert '"z_correction"' in kerf("steps", name).out
    # Formulas as comments; inches, and controllers without such comments, have no form for them.
    assert kerf("post", "--to", "linuxcnc", name, "-o", "out.nc").status == 0
    assert kerf("post", "--to", "linuxcnc", "--inch", name, "-o", "out.nc").status == 1


def test_each_embedding_has_its_own_probes(kerf, save, tmp_path):
    layer = "8998_1P"
    inner = line(0, 0, 10, 0, layer=layer) + circle(5, 10, 6, "PHANTOM", layer)
    save("8998.dxf", drawing(start(0, 0, "M1 O2 T2 I1 B0", layer), inner, end(10, 0, layer)))
    outer = "".join(line(x, 0, x + 10, 0, "DASHDOT") + text(x + 5, 0, ">8998.1P") for x in (0, 10))
    assert kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", path(outer, to=(20, 0)))).status == 0
    # Lines that would be equal have the position of the workpiece as well.
    assert (tmp_path / "8999.1P_Z.txt").read_text() == (
        "([5.000 10.000]/at [5.000 10.000]/T=2.000) #51=\n([5.000 10.000]/at [15.000 10.000]/T=2.000) #52=\n")
    filled = (tmp_path / "8999.1P_Z.txt").read_text().replace("#51=", "#51=2.1").replace("#52=", "#52=1,9")
    (tmp_path / "8999.1P_Z.txt").write_text(filled)
    assert kerf("adjustz", "/m0.5", "8999.1P.dxf").status == 0


def test_a_list_of_probes_levels_at_the_positions_of_the_work(kerf, save, tmp_path):
    """The list has the drawing's positions, the path starts at 100, 50. Heights: 2 + 0.01 X - 0.005 Y."""
    probes = "".join(circle(100 + x, 50 + y, 6, "PHANTOM") for x, y in ((0, 0), (20, 0), (0, 20), (20, 20)))
    drawn = drawing(start(100, 50, PARAMETERS), line(100, 50, 110, 50) + probes, end(110, 50))
    assert kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", drawn)).status == 0
    listed = (tmp_path / "8999.1P_Z.txt").read_text().splitlines()
    heights = {"([100.000 50.000": 2.0, "([120.000 50.000": 2.2,
               "([100.000 70.000": 1.9, "([120.000 70.000": 2.1}
    assert sorted(row.split("]")[0] for row in listed) == sorted(heights)
    save("8999.1P_Z.txt", "".join(f"{row}{heights[row.split(']')[0]]}\n" for row in listed))
    save("part.nc", "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X20 Y10\nG0 Z5\nM2\n")
    level = ["post", "--to", "grbl", "--level", "8999.1P_Z.txt", "part.nc", "-o", "out.nc"]
    run = kerf(*level)
    assert run.status == 0, run.err
    assert "beyond the measured area" not in run.err
    ends = [s["to"] for s in motions(kerf, "out.nc") if s["to"][:2] == [20, 10]]
    assert ends[0] == pytest.approx([20, 10, -1 + 0.2 - 0.05])
    assert "0.200 at 20, 0" in kerf("level", "--read", "8999.1P_Z.txt").out
    # A height that is not entered is an error here as with kerf adjustz.
    filled = (tmp_path / "8999.1P_Z.txt").read_text()
    save("8999.1P_Z.txt", filled.replace("=2.1\n", "=\n"))
    run = kerf(*level)
    assert run.status == 1 and "8999.1P_Z.txt:" in run.err and "no measured height" in run.err
    assert kerf("adjustz", "/m1", "8999.1P.dxf").status == 1
    save("8999.1P_Z.txt", filled)
    (tmp_path / "8999.1P_Probing.gcode").unlink()
    run = kerf(*level)
    assert run.status == 1 and "positions of the drawing" in run.err and "_Probing.gcode" in run.err


# ------------------------------------------------------------------------------- the command and its files


def test_the_program_is_that_of_the_original(kerf, save, tmp_path):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="M1 O2 T2 I5 B0 S5 F80 R_a"))
    assert kerf("pathdxf", *OPTIONS, name).status == 0
    assert code_lines((tmp_path / "8999.1P_a_Milling.gcode").read_text()) == [
        "%", "F150", "G17 G21 G40 G49 G54 G80 G90 G94", "T1", "G00 Z5.000", "G00 X0.000 Y0.000", "G00 Z2.000",
        "G01 Z0.000", "G01 F80.000 X10.000 Y0.000 Z0.000", "G00 Z5.000", "G00 Z5.000", "M30", "%"]


def test_options_in_their_forms(kerf, save, tmp_path):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    for options in (["/f150", "/v500", "/s15"], ["-f", "150", "-V500", "/S", "15"],
                    ["/f150,0", "/v500", "/o15"],
                    ["--feed=150", "--rapid-speed", "500", "--rapid-height", "15"]):
        assert kerf("pathdxf", *options, name).status == 0, options
        assert kerf("pathdxf", *options, "8999.1P").status == 0
        assert kerf("pathdxf", *options, tmp_path / name).status == 0
    for options in (["/f150", "/v500"], ["/f0", "/v500", "/s15"], ["/fx", "/v500", "/s15"],
                    ["/f-1", "/v5", "/s5"], [*OPTIONS, "/q"], [*OPTIONS, "/"], [*OPTIONS, "/d"],
                    [*OPTIONS, "--foldr=x"], ["/h"], ["/?"]):
        run = kerf("pathdxf", *options, *([name] if options[-1] != "/d" else []))
        assert run.status == 2 and "/f ..." in run.err, options  # code pathdxf_option
    assert kerf("pathdxf", *OPTIONS).status == 3
    assert kerf("pathdxf", *OPTIONS, "none.dxf").status == 1
    # Absolute names are files, even if nothing of them exists and their first letter is that of an option.
    for folder in ("/data/none", "/none/none", tmp_path / "none"):
        run = kerf("pathdxf", *OPTIONS, f"{folder}/8999.1P.dxf")
        assert run.status == 1 and f"{folder}/8999.1P.dxf: cannot read" in run.err
    run = kerf("pathdxf", "/f1", "/v1", "/sx", name)
    assert "Option value x for --rapid-height (/s) is not a number" in run.err


def test_messages_are_english_or_german(kerf, save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="M1 O2 T2 I1 S5"))
    english, german = kerf("pathdxf", *OPTIONS, name), kerf("pathdxf", *OPTIONS, "/lde", name)
    assert "**** LINE @ [0.000 0.000] # 8999.1P[8999.1P.dxf]: B value missing" in english.err
    assert "B-Wert fehlt" in german.err
    assert english.status == german.status == 1


def test_after_an_error_later_files_are_not_written(kerf, save, tmp_path):
    good, bad = path(line(0, 0, 10, 0)), path(line(0, 0, 9, 0))
    names = [save("8999.1P.dxf", good), save("8999.2P.dxf", bad), save("8999.3P.dxf", good)]
    assert kerf("pathdxf", *OPTIONS, *names).status == 1
    assert [p.name for p in tmp_path.glob("*.gcode")] == ["8999.1P_Milling.gcode"]


def test_check_reads_all_paths_and_writes_nothing(kerf, save, tmp_path):
    def at(y, layer):
        first = start(0, y, "M1 O2 T2 I1 B=D :D0,1 S5", layer)
        return first + line(0, y, 10, y, layer=layer) + end(10, y, layer)

    two = "".join(at(y, f"8999_{y}P") for y in (1, 20))
    name = save("8999.dxf", drawing(two))
    run = kerf("pathdxf", *OPTIONS, "/c", name)
    assert run.status == 0 and "Checking 8999.1P" in run.err and "Checking 8999.20P" in run.err
    assert not list(tmp_path.glob("*.gcode"))
    assert names_of(kerf, name) == (1, ["pathdxf_layer"])


def test_shown_texts_name_their_elements(kerf, save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0) + text(5, 0, "B1")))
    shown = kerf("pathdxf", *OPTIONS, "/xB1", name).err
    assert "Line LAYER=8999_1P" in shown and "has assigned text ''B1' @ [5.000 0.000] d=1.400'" in shown


def test_references_take_the_parameters_of_another_path(kerf, save):
    layer = "8999_2P"
    second = start(0, 20, "@8999.1P", layer) + line(0, 20, 10, 20, layer=layer) + end(10, 20, layer)
    first = start(0, 0, PARAMETERS) + line(0, 0, 10, 0) + end(10, 0)
    assert kerf("pathdxf", *OPTIONS, "/c", save("8999.dxf", drawing(first, second))).status == 0
    for wrong in ("@8999.7P", "@abc", "@8999.2P", "@8999.1P O2"):
        bad = drawing(first, second.replace("@8999.1P", wrong))
        run = kerf("pathdxf", *OPTIONS, "/c", save("8999.dxf", bad))
        assert run.status == 1 and "@" in run.err, wrong


# ------------------------------------------------------------------------------------- what can be wrong

WRONG = {
    "pathdxf_layer": drawing(line(0, 0, 1, 0, layer="0")),
    "pathdxf_marker": drawing(start(0, 0, PARAMETERS), line(0, 0, 10, 0)),
    "pathdxf_text_unassigned": path(line(0, 0, 10, 0) + text(5, 9, "B1")),
    "pathdxf_text_layout": path(line(0, 0, 10, 0) + text(5, 0, "B1", attachment=7, g50=30)),
    "pathdxf_text_syntax": path(line(0, 0, 10, 0) + text(5, 0, "B1 B0")),
    "pathdxf_reference": path(line(0, 0, 10, 0), parameters="@8999.7P"),
    "pathdxf_key": path(line(0, 0, 10, 0) + text(5, 0, "X1")),
    "pathdxf_value_missing": path(line(0, 0, 10, 0), parameters="M1 O2 I1 B0 S5"),
    "pathdxf_value_range": path(line(0, 0, 10, 0), parameters="M1 O2 T2 I0 B0 S5"),
    "pathdxf_line_type": path(line(0, 0, 10, 0, "ZIGZAG")),
    "pathdxf_circle": path(line(0, 0, 10, 0) + circle(10, 0, 1.5)),
    "pathdxf_open_end": path(line(0, 0, 10, 0) + line(10.5, 0, 20, 0), to=(20, 0)),
    "pathdxf_unreached": path(line(0, 0, 10, 0) + line(50, 50, 60, 50)),
    "pathdxf_end": path(line(0, 0, 9, 0)),
    "pathdxf_no_segments": path(),
    "pathdxf_not_found": path(line(0, 0, 10, 0, "DASHDOT") + text(5, 0, ">8998.1P")),
    "pathdxf_embedding": path(line(0, 0, 10, 0, "DASHDOT")),
    "pathdxf_variable": path(line(0, 0, 10, 0) + text(5, 0, "B=Q")),
    "pathdxf_height": path(line(0, 0, 10, 0) + tags((30, 1))),
    "pathdxf_limit": path(line(0, 0, 10, 0), parameters="M1 O2 T2 I0.000001 B0 S5"),
}


@pytest.mark.parametrize("code", WRONG)
def test_errors_have_their_code(kerf, save, code):
    status, codes = names_of(kerf, save("8999.1P.dxf", WRONG[code]))
    assert status == 1 and code in codes


def test_notes_and_warnings_have_their_code(kerf, save):
    spline = tags((0, "SPLINE"), (8, "8999_1P"), (70, 8), (71, 1), (72, 4), (73, 2),
                  (40, 0), (40, 0), (40, 1), (40, 1), (10, 0), (20, 0), (10, 5), (20, 5))
    content = path(line(0, 0, 10, 0) + circle(10, 0, 8) + spline, parameters="O2 T2 I1 B0", unit=1)
    status, codes = names_of(kerf, save("8999.1P.dxf", content))
    assert status == 0
    for code in ("pathdxf_assumed", "pathdxf_unused", "pathdxf_material", "pathdxf_unit", "pathdxf_core"):
        assert code in codes


def test_a_core_that_smaller_circles_remove_is_no_warning(kerf, save):
    circles = "".join(circle(0, 0, d) for d in (2, 4, 8))
    _, codes = names_of(kerf, save("8999.1P.dxf", path(circles, to=(0, 0))))
    assert "pathdxf_core" not in codes
    _, codes = names_of(kerf, save("8999.1P.dxf", path(circle(0, 0, 2) + circle(0, 0, 8), to=(0, 0))))
    assert "pathdxf_core" in codes


def test_elements_on_each_other_are_named(kerf, save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0) + line(10, 0, 0, 0) + line(10, 0, 20, 0), to=(20, 0)))
    status, codes = names_of(kerf, name)
    assert status == 1 and "pathdxf_overlap" in codes


def test_the_hint_names_the_nearest_open_end(kerf, save):
    run = kerf("pathdxf", *OPTIONS, "--explain", save("8999.1P.dxf", WRONG["pathdxf_open_end"]))
    assert "No more segments found after location [10.000 0.000]" in run.err
    assert "[10.500 0.000], 0.500 mm" in run.err


def test_all_errors_of_a_drawing_are_reported(kerf, save):
    content = path(line(0, 0, 10, 0) + text(5, 0, "X1") + line(10, 0, 20, 0, "ZIGZAG") + text(50, 50, "B1"))
    _, codes = names_of(kerf, save("8999.1P.dxf", content))
    assert {"pathdxf_key", "pathdxf_line_type", "pathdxf_text_unassigned"} <= set(codes)


def test_invalid_expressions_are_errors(kerf, save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    for option in ("/n(", "/p[", "/x*"):
        run = kerf("pathdxf", *OPTIONS, option, name)
        assert run.status == 1 and "Invalid expression" in run.err  # code pathdxf_pattern
    slow = kerf("pathdxf", *OPTIONS, "/n", "(([0-9.]+)+)+P", name, timeout=20)
    assert slow.status == 0


@pytest.mark.parametrize("value", ["T1e308", "B-1e300", "I1e30", "S2e7", "F1e12"])
def test_values_beyond_all_machines_are_errors(kerf, save, tmp_path, value):
    others = "".join(f" {p}" for p in PARAMETERS.split() if p[0] != value[0])
    run = kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters=value + others)))
    assert run.status == 1 and f"{value[0]}={value[1:]} is beyond 10000000" in run.err
    assert not list(tmp_path.glob("*.gcode"))


def test_programs_that_end_at_a_limit_are_not_written(kerf, save, tmp_path):
    probes = "".join(circle(10 * i, 50, 6, "PHANTOM") for i in range(1001))
    run = kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", path(line(0, 0, 10, 0) + probes)))
    assert run.status == 1 and "more than 1000 probes" in run.err
    assert not list(tmp_path.glob("*.gcode")) and not list(tmp_path.glob("*.txt"))


def test_an_undefined_variable_is_one_message(kerf, save):
    run = kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", path(line(0, 0, 10, 0) + text(5, 0, "B=Q"))))
    assert run.err.count("8999.1P[8999.1P.dxf]: ") == 1 and "Variable Q" in run.err


def test_messages_have_no_control_characters(kerf, save):
    content = path(line(0, 0, 10, 0) + text(50, 50, "B1\\PD2 Q\x1b[31m\x07"))
    for run in (kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", content)), kerf("check", "8999.1P.dxf")):
        message = next(row for row in run.err.splitlines() if "No overlapping" in row)
        assert "B1" in message and "D2" in message
        assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f]", run.err)


def test_notes_that_are_not_shown_are_not_counted_as_errors(kerf, save):
    save("8998.dxf", path(line(0, 0, 10, 0, layer="8998_1P"), layer="8998_1P"))
    embeddings = "".join(line(x, 0, x + 10, 0, "DASHDOT") + text(x + 5, 0, ">8998.1P")
                         for x in range(0, 2000, 10))
    name = save("8999.1P.dxf", path(embeddings, to=(2000, 0)))
    run = kerf("pathdxf", *OPTIONS, name)
    assert run.status == 0 and "more of these" not in run.err and "****" not in run.err
    assert "---- ... " in kerf("pathdxf", *OPTIONS, "--explain", name).err


def test_two_paths_in_a_drawing_are_explained(kerf, save):
    paths = [start(0, 0, PARAMETERS, k) + line(0, 0, 10, 0, layer=k) + end(10, 0, k)
             for k in ("8999_1P", "8999_2P")]
    run = kerf("pathdxf", *OPTIONS, "--explain", save("8999.dxf", drawing(*paths)))
    assert run.status == 1 and "8999.1P, 8999.2P" in run.err and "/c checks all" in run.err


def test_a_suffix_does_not_lead_to_another_folder(kerf, save, tmp_path):
    name = save("in/8999.1P.dxf", path(line(0, 0, 10, 0), parameters=PARAMETERS + " R/../../x"))
    assert kerf("pathdxf", *OPTIONS, name).status == 1
    assert not list(tmp_path.rglob("*.gcode"))


CUT_OFF = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n8999_1P\n10\n1e308\n"


@pytest.mark.parametrize("content", ["", "0\n", "not a drawing", CUT_OFF,
                                     path(line(0, 0, 1e300, 0)), path(line(0, 0, 10, 0))[:250],
                                     path(arc(0, 0, 0, 0, 0)), path(text(0, 0, "=" * 50000))])
def test_bad_files_are_errors_and_write_nothing(kerf, save, tmp_path, content):
    run = kerf("pathdxf", *OPTIONS, save("8999.1P.dxf", content), timeout=20)
    assert run.status == 1 and "****" in run.err
    assert not list(tmp_path.glob("*.gcode"))


def test_variables_that_grow_are_errors(kerf, save):
    layer = "8998_1P"
    grown = "B=A :A0~1"
    save("8998.dxf", drawing(start(0, 0, "M1 O2 T2 I1 " + grown, layer), line(0, 0, 10, 0, layer=layer),
                             end(10, 0, layer)))
    embedding = line(0, 0, 10, 0, "DASHDOT") + text(5, 0, ">8998.1P :A=A=A")
    status, codes = names_of(kerf, save("8999.1P.dxf", path(embedding)))
    assert status == 1 and "pathdxf_variable" in codes


# ---------------------------------------------------------------------------------------- as a program


def test_a_drawing_is_simulated_with_its_tool_and_plate(kerf, save):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    run = kerf("simulate", "--json", "--resolution", "0.05", name)
    assert run.status == 0, run.err
    # A slot 10 mm long, 2 mm wide and 2 mm deep with round ends.
    assert run.json["removed_mm3"] == pytest.approx((10 * 2 + math.pi) * 2, rel=5e-3)


def test_a_collision_names_the_element(kerf, save):
    # The second hole is reached by a sweep at 1 mm through a plate of 2 mm.
    low = line(0, 0, 10, 0, "DASHED") + text(5, 0, "S3") + circle(10, 0, 2)
    name = save("8999.1P.dxf", path(low))
    run = kerf("check", "--json", "--stock", "-5,-5,0 to 20,5,4", name)
    assert run.status == 3
    hazard = next(h for h in run.json["hazards"] if h["kind"] == "rapid_in_stock")
    assert hazard["origin"]["layer"] == "8999_1P"


def test_a_drawing_without_mistakes_has_no_hazards(kerf, save):
    inner = line(0, 0, 10, 0) + arc(10, 5, 5, 270, 90) + line(10, 10, 20, 10, "DASHED") + circle(20, 10, 6)
    run = kerf("check", "--json", save("8999.1P.dxf", path(inner, to=(20, 10))))
    assert run.status == 0 and run.json["hazards"] == []


def test_a_drawing_is_posted(kerf, save, tmp_path):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    run = kerf("post", "--to", "linuxcnc", name, "-o", "out.nc")
    assert run.status == 0, run.err
    assert "G1" in (tmp_path / "out.nc").read_text()
    again = kerf("info", "--json", "out.nc").json["motion"]
    assert again["cut_mm"] == pytest.approx(kerf("info", "--json", name).json["motion"]["cut_mm"], abs=0.01)


def test_the_steps_are_the_same_in_the_text_of_the_original(kerf, save, tmp_path):
    """Both come from one toolpath: read back as G-code, the program has the same motions."""
    inner = line(0, 0, 10, 0) + arc(10, 5, 5, 270, 90) + line(10, 10, 20, 10, "DASHED") + circle(20, 10, 6)
    name = save("8999.1P.dxf", path(inner, to=(20, 10)))
    assert kerf("pathdxf", *OPTIONS, name).status == 0
    drawn, read = (kerf("info", "--json", n).json["motion"] for n in (name, "8999.1P_Milling.gcode"))
    assert (drawn["lines"], drawn["arcs"], drawn["rapids"]) == (read["lines"], read["arcs"], read["rapids"])
    assert drawn["cut_mm"] == pytest.approx(read["cut_mm"], abs=0.01)


# ---------------------------------------------------------------------------------------------- messages


def test_long_texts_are_clipped_in_messages(kerf, save):
    long = "M1 O2 T2 X" + "x" * 50_000
    cases = [path(line(0, 0, 10, 0), text(3, 8, long)), path(line(0, 0, 10, 0), parameters=long),
             path(line(0, 0, 10, 0), parameters="M1 O2 T2 I1 B0 B" + "1" * 50_000),
             path(line(0, 0, 10, 0, "DASHDOT"), text(5, 0, ">" + "8" * 50_000)),
             path(line(0, 0, 10, 0), parameters="@" + "9" * 50_000),
             path(line(0, 0, 10, 0, "x" * 50_000)),
             path(line(0, 0, 10, 0, layer="8999_" + "1" * 50_000 + "P"))]
    for k, content in enumerate(cases):
        run = kerf("pathdxf", *OPTIONS, save(f"{k}.dxf", content))
        assert run.status == 1 and len(run.err) < 5000, (k, len(run.err))


def test_values_taken_from_the_path_are_noted(kerf, save):
    layer = "8998_1P"
    save("8998.dxf", drawing(start(0, 0, "M1 O2 T2 I1 B0", layer), line(0, 0, 10, 0, layer=layer),
                             end(10, 0, layer)))
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0, "DASHDOT"), text(5, 0, ">8998.1P O2")))
    run = kerf("pathdxf", *OPTIONS, "--explain", name)
    assert run.status == 0 and "TM not specified at the embedding of 8998.1P" in run.err
    lower = save("8999.1p.dxf", path(line(0, 0, 10, 0, layer="8999_1p"), layer="8999_1p"))
    run = kerf("pathdxf", *OPTIONS, "--explain", lower)
    assert run.status == 0 and "differs from the expression" in run.err


# ------------------------------------------------------------------------------------------------- sheet


def test_faults_at_one_position_have_one_label_on_the_sheet(kerf, save, tmp_path):
    name = save("8999.1P.dxf", WRONG["pathdxf_open_end"])  # a gap, and the end is not reached
    assert kerf("pathdxf", *OPTIONS, "--svg", "sheet.svg", name).status == 1
    labels = [text for text in re.findall(r"<text[^>]*>([^<]*)</text>", (tmp_path / "sheet.svg").read_text())
              if re.fullmatch(r"(!\d+ ?)+", text)]
    numbers = [n for label in labels for n in re.findall(r"!(\d+)", label)]
    assert sorted(numbers) == ["1", "2"] and len(labels) == 1


def test_the_sheet_has_true_size_order_depths_probes_and_faults(kerf, save, tmp_path):
    probe = circle(5, 8, 6, "PHANTOM") + text(5, 8, "Lleft T3")
    elements = line(0, 0, 20, 0) + arc(20, 5, 5, 270, 90) + line(20, 10, 20, 10.5, "DASHED") + probe
    name = save("8999.1P.dxf", path(elements, to=(20, 10.5), parameters="M20x2 O2 T2 I1 B-0.5 S5"))
    assert kerf("pathdxf", *OPTIONS, "--svg", "sheet.svg", name).status == 0
    svg = (tmp_path / "sheet.svg").read_text()
    texts = re.findall(r"<text[^>]*>([^<]*)</text>", svg)
    assert "1: Z-0.5" in texts and "2: Z-0.5" in texts
    assert "1. #51 left T3" in texts
    # The tool is 1 mm wide around the cuts: X from -1 to 26, Y from -1 to 11.
    assert "27" in texts and "12" in texts
    assert any("20x2" in t and "2 mm" in t for t in texts)
    size = re.search(r'width="([0-9.]+)mm" height="([0-9.]+)mm" '
                     r'viewBox="[-0-9.]+ [-0-9.]+ ([0-9.]+) ([0-9.]+)"', svg)
    assert size and size[1] == size[3] and size[2] == size[4]


def test_the_sheet_of_a_faulty_drawing_circles_its_elements(kerf, save, tmp_path):
    name = save("8999.1P.dxf", path(line(0, 0, 4, 0), line(6, 0, 10, 0)))
    assert kerf("pathdxf", *OPTIONS, "--svg", "sheet.svg", name).status == 1
    svg = (tmp_path / "sheet.svg").read_text()
    assert "No more segments found after location [4.000 0.000]" in svg and "!1" in svg
    assert kerf("pathdxf", *OPTIONS, "--svg", "s.svg", name, name).status == 2


def test_the_rapid_height_of_the_command_is_above_the_material(kerf, save):
    save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="T20 O2 M20x2 F100 I1 B0"))
    run = kerf("pathdxf", "/f150", "/v500", "/s15", "8999.1P.dxf")
    assert run.status == 1 and "S must be above T" in run.out + run.err
    assert kerf("pathdxf", "/f150", "/v500", "/s25", "8999.1P.dxf").status == 0


def test_a_spoilboard_below_the_plate(kerf, save):
    """Cutting a little below Z0 is usual for paths; deep cuts are not."""
    for depth, status in ((-0.1, 0), (-2.9, 0), (-4, 3)):
        save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters=f"T3 O2 M20x2 F100 I1 S8 B{depth}"))
        assert kerf("check", "8999.1P.dxf").status == status


def test_bars_that_vanish_and_helices_that_miss_their_depth(kerf, save):
    """With P1 U2 and a tool of 2 mm, 24 mm have 8 bars: 24/8 - 1 - 2*0.5 - 2 = -1 mm between them."""
    close = "T2 O2 M20x2 F100 I1 B0 D1 S5 P1 "
    for bars, names in (("U2", ["pathdxf_bars"]), ("U11", [])):
        save("8999.1P.dxf", path(line(0, 0, 24, 0, "BORDER"), to=(24, 0), parameters=close + bars))
        status, found = names_of(kerf, "8999.1P.dxf")
        assert status == 0 and [n for n in found if n == "pathdxf_bars"] == names
    # Turns to D1 with I1.5 end at the level Z0: no turn to B is left.
    for infeed, names in (("I1.5", ["pathdxf_bars"]), ("I1", [])):
        values = f"T3 O2 M20x2 F100 {infeed} B0 D1 S5 P1 U8"
        save("8999.1P.dxf", path(circle(0, 0, 7, "BORDER"), line(0, 0, 10, 0), parameters=values))
        status, found = names_of(kerf, "8999.1P.dxf")
        assert status == 0 and [n for n in found if n == "pathdxf_bars"] == names


def test_a_drawing_is_opened_once(kerf, save, tmp_path):
    """A pipe can be read only once."""
    content = path(line(0, 0, 10, 0))
    expected = motions(kerf, save("8999.1P.dxf", content))
    os.mkfifo(tmp_path / "pipe.dxf")
    writer = threading.Thread(target=(tmp_path / "pipe.dxf").write_text, args=(content,), daemon=True)
    writer.start()
    run = kerf("steps", "pipe.dxf")
    assert run.status == 0, run.err
    steps = [json.loads(row) for row in run.out.splitlines()][1:]
    assert [s["to"] for s in steps if "to" in s] == [s["to"] for s in expected]


# ------------------------------------------------------- what is milled is what is checked


def test_commands_that_read_a_drawing_take_the_options_that_change_what_is_milled(kerf, save, tmp_path):
    """The motions of `kerf steps` are those of the file that `kerf pathdxf` writes with the same options."""
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="T8 O2 M20x2 I4 B0"))
    options = ["--rapid-height", "15", "--feed=80"]
    assert kerf("pathdxf", *options, "--rapid-speed", "500", name).status == 0
    # N is the height of the rapids, F the feed: 15 and 80, not T+O = 10 and 150.
    run = kerf("steps", *options, name)
    assert run.status == 0, run.err
    steps = [json.loads(row) for row in run.out.splitlines()][1:]
    assert max(s["to"][2] for s in steps if s["step"] == "rapid") == pytest.approx(15, abs=1e-3)
    assert {s["feed"] for s in steps if s["step"] == "cut" and s["to"][0] > 0} == {80}
    written = kerf("steps", "8999.1P_Milling.gcode")
    read = [json.loads(row) for row in written.out.splitlines()][1:]
    ends = [[s["to"] for s in rows if s["step"] in ("rapid", "cut")] for rows in (steps, read)]
    assert ends[0][2:] == [pytest.approx(p, abs=1e-3) for p in ends[1][2:]]


READERS = [("check",), ("info",), ("steps",), ("simulate",), ("view", "--export", "x.html"),
           ("post", "--to", "linuxcnc", "-o", "x.nc")]


@pytest.mark.parametrize("command", READERS)
def test_a_rapid_height_in_the_material_is_an_error_of_each_command(kerf, save, command):
    """T20 with /s15: `kerf pathdxf` refuses it, and so does each command that reads the drawing."""
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0), parameters="T20 O2 M20x2 F100 I10 B0"))
    run = kerf(*command, "--rapid-height", "15", name, timeout=60)
    assert run.status == 1 and "S must be above T" in run.out + run.err
    assert kerf(*command, "--rapid-height", "25", name, timeout=60).status == 0


def test_other_programs_refuse_the_options_of_drawings(kerf, save):
    save("part.nc", "G21 G90\nT1 M6\nG0 Z5\nG1 X10 F100\nM2\n")
    for option in ("--rapid-height=15", "--feed=100", "--path-names=([0-9]+)P", "--file-patterns=x"):
        run = kerf("check", "--json", option, "part.nc")
        assert run.status == 1 and "option_unused" in run.codes(), option
    # What is no number above 0 is wrong usage.
    assert kerf("check", "--rapid-height", "0", "part.nc").status == 2
    assert kerf("check", "--feed", "fast", "part.nc").status == 2


def test_post_gives_a_path_without_feed_the_feed_of_cuts_that_have_none(kerf, save, tmp_path):
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    assert kerf("post", "--to", "linuxcnc", "--feed", "77", name, "-o", "out.nc").status == 0
    assert "F77" in (tmp_path / "out.nc").read_text()


@pytest.mark.parametrize("raise_by, options, status", [(2, [], 0), (4, [], 1), (4, ["--rapid-height=7"], 0)])
def test_rapids_are_above_a_path_that_is_raised(kerf, save, tmp_path, raise_by, options, status):
    """T2 with H4 has its top at Z6: rapids at 5 would go through it."""
    save("8998.dxf", sub_path())
    embedding = line(0, 0, 10, 0, "DASHDOT") + text(5, 0, f">8998.1P M1 O2 T2 H{raise_by}")
    own = PARAMETERS if not options else PARAMETERS.replace(" S5", "")
    name = save("8999.1P.dxf", path(embedding, line(10, 0, 20, 0, "HIDDEN"), to=(20, 0), parameters=own))
    run = kerf("info", "--json", *options, name)
    assert run.status == status and ("pathdxf_rapid_height" in run.codes()) == bool(status)
    if status:
        error = next(d for d in run.json["diagnostics"] if d["name"] == "pathdxf_rapid_height")
        assert "8999_1P" in json.dumps(error)
    assert kerf("pathdxf", *OPTIONS, *options, name).status == status
    assert bool(list(tmp_path.glob("*.gcode"))) == (not status)


@pytest.mark.parametrize("probe, status", [("T4", 0), ("T8", 1), ("T4 H1", 1)])
def test_rapids_are_above_the_probes(kerf, save, tmp_path, probe, status):
    inner = line(0, 0, 10, 0) + circle(5, 8, 6, "PHANTOM") + text(5, 8, probe)
    name = save("8999.1P.dxf", path(inner))
    run = kerf("pathdxf", *OPTIONS, name)
    assert run.status == status and ("CIRCLE @ [5.000 8.000]" in run.err) == bool(status)
    assert bool(list(tmp_path.glob("*.gcode"))) == (not status)
    assert kerf("info", name).status == status


@pytest.mark.parametrize("own, options, status", [
    ("", [], 0),
    ("", ["/e8999:8998"], 0), ("", ["/e", "8999:8997"], 1),
    ("", ["--restrict", "^999:8997"], 0),  # the path is another one
    ("", ["/e9.[.]1P:9[.]1"], 1), ("", ["/e9.[.]1P:8[.]1"], 0),  # any part of the names
    (" E8999:8997", [], 1), (" E8999:8998", ["/e8999:8997"], 0), (" E8999:8997", ["/e8999:8998"], 1),
    (" E7:8997", [], 0), (" E8998", [], 1), (" E(:8998", [], 1), ("", ["/e8998"], 1)])
def test_restrictions_decide_what_a_path_embeds(kerf, save, own, options, status):
    """PARENT:CHILD, two expressions that match anywhere; the path's own goes first."""
    save("8998.dxf", sub_path())
    embedding = line(0, 0, 10, 0, "DASHDOT") + text(5, 0, ">8998.1P M1 O2 T2")
    name = save("8999.1P.dxf", path(embedding, parameters=PARAMETERS + own))
    run = kerf("pathdxf", *OPTIONS, *options, name)
    assert run.status == status, run.err
    if own == " E7:8997":
        assert "E=7:8997 has no effect" in run.err
    long = [o.replace("/e", "--restrict=") if o != "/e" else "--restrict" for o in options]
    checked = kerf("check", "--json", *long, name)
    assert checked.status == status
    if status:
        assert {"pathdxf_restriction", "pathdxf_pattern"} & set(checked.codes())


VARIABLE = path(line(0, 0, 10, 0), parameters="M1 O2 T2 I5 S5 B=D :D0.5~1.5 :X?AB")


def test_a_path_with_variables_is_simulated_alone(kerf, save, tmp_path):
    """The values are permitted by the definitions; -D and --define give others."""
    name = save("8999.1P.dxf", VARIABLE)
    run = kerf("info", "--json", name)
    assert run.status == 0, run.err
    note = next(d for d in run.json["diagnostics"] if "D=0.5" in d["message"])
    assert note["name"] == "pathdxf_assumed" and "X=" in note["message"]
    assert min(s["to"][2] for s in motions(kerf, name)) == 0.5
    steps = [json.loads(row) for row in kerf("steps", "-D", "D=1.25", name).out.splitlines()][1:]
    assert min(s["to"][2] for s in steps if s["step"] == "cut") == 1.25
    assert kerf("pathdxf", *OPTIONS, "--define", "D=1.25", "--define=XA", name).status == 1
    assert kerf("pathdxf", *OPTIONS, "--define", "D=1.25", "--define=X=A", name).status == 0
    assert "Z1.250" in (tmp_path / "8999.1P_Milling.gcode").read_text()
    assert kerf("pathdxf", *OPTIONS, name).status == 1  # as the original


@pytest.mark.parametrize("value", ["D=2", "D=x", "Q=1", "depth=5mm", "=1", "D"])
def test_values_of_variables_are_checked(kerf, save, value):
    status, codes = names_of(kerf, save("8999.1P.dxf", VARIABLE), "-D", value)
    assert status == 1 and "pathdxf_variable" in codes


@pytest.mark.parametrize("own, length, message", [
    ("", 50, None), ("", 24, "No support bar fits on 24 mm (P+U=25)"),
    ("B0.5 D0.2", 50, "D=0.2 is not above B=0.5"), ("D0", 50, "D=0 is not above B=0")])
def test_bars_that_do_not_exist_are_named(kerf, save, tmp_path, own, length, message):
    """24 mm have no room for a bar of 5 mm and 20 mm between; a bar of D0.2 in a cut to B0.5 is none."""
    element = line(0, 0, length, 0, "BORDER") + (text(length / 2, 0, own) if own else "")
    values = "M1 O2 T2 I2 S5 B0 D1 P5 U20"
    name = save("8999.1P.dxf", path(element, to=(length, 0), parameters=values))
    run = kerf("pathdxf", *OPTIONS, name)
    assert run.status == 0 and (tmp_path / "8999.1P_Milling.gcode").exists()
    lines = [row for row in run.err.splitlines() if "LINE @ [0.000 0.000]" in row]
    assert len(lines) == (message is not None)
    assert message is None or message in lines[0]


def test_a_helix_too_short_for_bars_is_named(kerf, save):
    """2 pi 2.5 = 15.7 mm, less than 25."""
    name = save("8999.1P.dxf", path(circle(0, 0, 7, "BORDER"), line(0, 0, 10, 0),
                                    parameters="T3 O2 M20x2 F100 I1 B0 D1 S5 P5 U20"))
    run = kerf("pathdxf", *OPTIONS, name)
    assert run.status == 0 and "CIRCLE @ [0.000 0.000]" in run.err and "fits on 15.708 mm" in run.err


def test_files_of_an_earlier_run_are_named(kerf, save, tmp_path):
    probe = circle(5, 8, 6, "PHANTOM") + text(5, 8, "T2")
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    assert "earlier run" not in kerf("pathdxf", *OPTIONS, "--explain", name).err
    save("8999.1P.dxf", path(line(0, 0, 10, 0), probe))
    run = kerf("pathdxf", *OPTIONS, "--explain", name)  # code pathdxf_stale
    assert [row.split(": ")[0] for row in run.err.splitlines() if "earlier run" in row] == [
        "---- 8999.1P_Milling.gcode"]
    (tmp_path / "8999.1P_Milling.gcode").unlink()
    save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    run = kerf("pathdxf", *OPTIONS, "--explain", name)
    assert run.status == 0
    assert [row.split(": ")[0] for row in run.err.splitlines() if "earlier run" in row] == [
        f"---- 8999.1P{ending}" for ending in ("_Probing.gcode", "_Z.txt", "_Clean.gcode")]
    assert "earlier run" not in kerf("pathdxf", *OPTIONS, "/c", "--explain", name).err


def test_the_file_for_linuxcnc_has_no_feed_before_its_mode(kerf, save, tmp_path):
    """LinuxCNC refuses F before G94, as the files of the original have it; the motions are the same."""
    name = save("8999.1P.dxf", path(line(0, 0, 10, 0)))
    options = ["--rapid-height", "15", "--feed", "80"]
    assert kerf("pathdxf", *options, "--rapid-speed", "500", name).status == 0
    assert kerf("post", "--to", "linuxcnc", *options, name, "-o", "out.ngc").status == 0
    words = re.sub(r"\([^)]*\)|;.*", "", (tmp_path / "out.ngc").read_text()).split()
    feed = next(i for i, word in enumerate(words) if re.fullmatch(r"F[0-9.]+", word))
    assert "G94" in words[:feed] and "F80" in words
    milled, posted = (kerf("info", "--json", n).json["motion"] for n in ("8999.1P_Milling.gcode", "out.ngc"))
    assert posted["cut_mm"] == pytest.approx(milled["cut_mm"], abs=0.01)


# ---------------------------------------------------------------------------------------- two languages


@pytest.mark.parametrize("code", WRONG)
def test_each_message_has_its_german_text(kerf, save, code):
    name = save("8999.1P.dxf", WRONG[code])
    english, german = (kerf("pathdxf", *OPTIONS, f"/l{language}", "--explain", name).err.splitlines()
                       for language in ("en", "de"))
    assert len(english) == len(german)
    # The first line has the name and version; entities, layers and numbers are the same in both.
    same = [row for row in set(english) & set(german) if re.search(r"[a-z]{3}", row) and "Kerf" not in row]
    assert same == []


WRONG_OPTIONS = [["/f0"], ["/fx"], ["/f-1"], ["/q"], ["--foldr=x"], ["/"], ["--probe", "x"]]


@pytest.mark.parametrize("wrong", WRONG_OPTIONS)
def test_options_are_explained_in_german(kerf, wrong):
    english, german = (kerf("pathdxf", "/v1", "/s1", *wrong, language, "a.dxf")
                       for language in ("/len", "/lde"))
    assert english.status == german.status == 2
    messages = [[row for row in run.err.splitlines() if row.startswith("****")] for run in (english, german)]
    assert messages[0] and len(messages[0]) == len(messages[1]) and not set(messages[0]) & set(messages[1])
