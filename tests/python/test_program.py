"""Programs from files: loading, checking, estimating, posting, and writing what they make."""
import warnings

import pytest

import kerf
from jobs import slot

PROGRAM = """(STOCK/BLOCK, 20, 10, 5, 0, 0, 5)
G21 G90
T102 M6
M3 S9000
G0 X5 Y5 Z2
G1 Z-2 F100
G0 Z2
M5
M2
"""
HOLE = 3.14159265 / 4 * 3.175**2 * 2  # mm3


@pytest.fixture
def write(tmp_path):
    def write(name, text):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


def positions(program):
    """Ends of the motions, mm."""
    steps = [program.toolpath[i] for i in range(len(program))]
    return [step["to"] for step in steps if "to" in step]


@pytest.fixture
def program(write):
    return kerf.load(write("part.nc", PROGRAM))


# ---- load


def test_a_program_says_what_its_file_says(write):
    comments = "(STOCK/BLOCK, 20, 10, 5, 0, 0, 5)\n(TOOL/MILL, 3, 0, 15, 0)\n"
    path = write("part.nc", "G20\n" + comments + "G90\nT7 M6\nG0 X1\nM2\n")
    program = kerf.load(path)
    assert (program.source, program.front_end, program.units) == (str(path), "G-code", "inch")
    assert program.tools[7].diameter == pytest.approx(3 * 25.4)
    assert program.stock.high == pytest.approx((20 * 25.4, 10 * 25.4, 0))
    assert program.files == [str(path)]
    assert positions(program) == [pytest.approx((25.4, 0, 0))]


def test_gcmc_programs_take_defines_and_include_folders(write, tmp_path):
    (tmp_path / "library").mkdir()
    write("library/depth.gcmc", "if(!isdefined(\"depth\")) { depth = 1mm; }\n")
    text = 'include("depth.gcmc");\nfeedrate(99mm);\ngoto([0mm, 0mm, 5mm]);\nmove([-, -, -depth]);\n'
    path = write("part.gcmc", text)
    with pytest.raises(kerf.Error, match="depth.gcmc"):
        kerf.load(path)
    program = kerf.load(path, defines=["depth=7mm"], include_paths=[tmp_path / "library"])
    assert program.front_end == "gcmc"
    assert positions(program)[-1] == (0, 0, -7)
    assert program.files == [str(path), str(tmp_path / "library") + "/depth.gcmc"]


def test_reading_can_continue_after_the_end(write):
    path = write("two.nc", PROGRAM + "G0 X9\nM2\n")
    with pytest.warns(UserWarning, match="--read-on"):
        first = kerf.load(path)
    assert len(positions(kerf.load(path, read_on=True))) == len(positions(first)) + 1
    with pytest.raises(ValueError, match="known: .*linuxcnc"):
        kerf.load(path, dialect="nonsense")


def test_cutter_compensation_needs_the_tool(write):
    path = write("comp.nc", "G21 G90\nT1 M6\nG0 X0 Y0 Z1\nG41\nG1 X10 F100\nG1 X20\nG40\nG1 Y5\nM2\n")
    with pytest.raises(kerf.Error):
        kerf.load(path)
    for diameter in (4, 6):
        sides = [to[1] for to in positions(kerf.load(path, tools=f"1=square d={diameter}"))]
        assert max(sides[:-1]) == pytest.approx(diameter / 2)


def test_old_encodings_are_read(write):
    text = b"G21\n(MSG,Fr\xe4sen)\nG0 X1\nG1 X2 Y\nM2\n"
    with pytest.raises(kerf.Error) as caught:
        kerf.load(write("Fr\xe4sen.nc", text))
    assert "Fr\xe4sen.nc" in caught.value.diagnostics[0].where
    program = kerf.load(write("old.nc", text.replace(b" Y", b" F9")))
    notes = [program.toolpath[i].get("text", "") for i in range(len(program))]
    assert any("Fr\ufffdsen" in note for note in notes)
    assert "(MSG, Fr_sen)" in kerf.post(program, "linuxcnc")  # comments of posts are ASCII


def test_missing_files_are_os_errors(tmp_path):
    with pytest.raises(FileNotFoundError):
        kerf.load(tmp_path / "none.nc")


# ---- check and estimate


def test_a_valid_program_has_no_hazard(program):
    assert kerf.check(program) == []


def test_a_rapid_in_the_stock_is_found(write):
    path = write("bad.nc", PROGRAM.replace("G0 Z2\nM5", "G0 X9\nG0 Z2\nM5"))
    found = kerf.check(kerf.load(path))
    assert [f["kind"] for f in found] == ["rapid_in_stock"]
    assert (found[0]["origin"]["file"], found[0]["origin"]["line"]) == (str(path), 7)
    assert found[0]["depth_mm"] == pytest.approx(2, abs=0.01)
    assert found[0]["hint"]


def test_the_check_takes_tools_stock_fixtures_machine_and_material(program, write):
    assert "below_floor" in [f["kind"] for f in kerf.check(program, stock="20x10x1")]
    clamp = kerf.Stock.block((4, 4, 4), zero="centre")
    assert kerf.check(program, fixtures=[("far", clamp)]) == []
    vice = write("vice.nc", PROGRAM.replace("X5 Y5", "X0 Y0"))
    assert "fixture_contact" in [f["kind"] for f in kerf.check(kerf.load(vice), fixtures=[("vice", clamp)])]
    slow = write("grbl.txt", "$30=5000\n$110=500\n")
    assert [f["kind"] for f in kerf.check(program, machine=slow)] == ["spindle_range"]
    fast = kerf.load(write("fast.nc", PROGRAM.replace("G0 Z2\nM5", "G1 X9 F9000\nG0 Z2\nM5")))
    assert [f["kind"] for f in kerf.check(fast, material="aluminium")] == ["chip_load"]
    assert [f["kind"] for f in kerf.check(fast, tools="102=square d=3.175 flute=1")] == ["over_flute"]


@pytest.mark.parametrize("arguments, words", [
    ({"tools": "2=nonsense d=3"}, "nonsense"),
    ({"stock": "big"}, "big"),
    ({"material": "unobtainium"}, "unobtainium"),
])
def test_what_is_not_understood_is_an_error(program, arguments, words):
    with pytest.raises(kerf.Error, match=words):
        kerf.check(program, **arguments)


@pytest.mark.parametrize("arguments", [{"tools": 3}, {"stock": 3}, {"resolution": -1}, {"threads": -1}])
def test_wrong_types_and_ranges_are_refused(program, arguments):
    with pytest.raises((TypeError, ValueError)):
        kerf.check(program, **arguments)


def test_a_toolpath_is_checked_and_timed_as_well():
    assert kerf.check(slot(), stock=kerf.Stock.block((40, 20, 6))) == []
    assert kerf.estimate(slot())["cutting"] == pytest.approx((7 / 100 + 20 / 400) * 60)


def test_the_estimate_is_that_of_the_feeds_or_of_the_machine(program, write):
    plain = kerf.estimate(program)
    assert plain["machine"] is None
    assert plain["total"] == pytest.approx(plain["cutting"] + plain["rapid"] + plain["dwell"])
    assert [t["number"] for t in plain["tools"]][-1] == 102
    planned = kerf.estimate(program, machine=write("grbl.txt", "$110=500\n$111=500\n$112=100\n"))
    assert planned["machine"]
    assert planned["total"] > plain["total"]
    with pytest.raises(OSError, match="none.toml"):
        kerf.estimate(program, machine="none.toml")


# ---- post


def test_posts_for_controllers(program):
    text = kerf.post(program, "grbl")
    assert "G1 Z-2 F100" in text.splitlines()
    inch = kerf.post(program, "linuxcnc", unit="inch")
    assert "G20" in inch and "G1 Z-0.07874 F3.937" in inch
    assert {"grbl", "dxf", "svg"} <= set(kerf.posts())


def test_posts_as_drawings(program):
    assert kerf.post(program, "svg").startswith("<?xml")
    old, new = (kerf.post(program, "dxf", dxf_version=v) for v in ("r12", "r2000"))
    assert "AC1009" in old and "AC1015" in new


def test_passes_before_the_post(write):
    path = write("line.nc", "G21 G90\nG0 X0 Y0 Z2\nG1 Z-1 F100\nG1 X1\nG1 X2\nG1 X3\nG0 Z2\nM2\n")
    lines = kerf.post(kerf.load(path), "grbl", join=0.01).splitlines()
    assert any("X3" in line for line in lines)
    assert not any("X1" in line or "X2" in line for line in lines)


def test_posts_to_files(program, write, tmp_path):
    assert kerf.post(program, "grbl", tmp_path / "out.nc") == [str(tmp_path / "out.nc")]
    assert (tmp_path / "out.nc").read_text() == kerf.post(program, "grbl")
    two = kerf.load(write("two.nc", PROGRAM.replace("M5\n", "T201 M6\nG0 X9\nG1 Z-1\nG0 Z2\nM5\n")))
    names = kerf.post(two, "grbl", tmp_path / "each.nc", tool_change="files")
    assert [name.rsplit("/", 1)[1] for name in names] == ["each-T102.nc", "each-T201.nc"]
    with pytest.raises(ValueError, match="path"):
        kerf.post(two, "grbl", tool_change="files")
    with pytest.raises(OSError):
        kerf.post(program, "grbl", tmp_path / "none" / "out.nc")


@pytest.mark.parametrize("arguments, words", [
    ({"to": "gbrl"}, "gbrl"),
    ({"to": "grbl", "unit": "furlong"}, "furlong"),
    ({"to": "grbl", "tool_change": "magic"}, "pause"),
    ({"to": "dxf", "dxf_version": "r13"}, "r13"),
    ({"to": "grbl", "join": 7}, "join"),
    ({"to": "grbl", "feed": -1}, "feed"),
])
def test_wrong_choices_of_a_post_are_value_errors(program, arguments, words):
    with pytest.raises(ValueError, match=words):
        kerf.post(program, **arguments)


# ---- simulate and save


def test_a_program_brings_its_stock_and_tools(program):
    result = kerf.simulate(program, resolution=0.05)
    assert result.stock_mm3 == pytest.approx(1000)
    assert result.removed_mm3 == pytest.approx(HOLE, rel=0.02)
    wide = kerf.simulate(program, tools=kerf.Tool("square d=6 flute=9"), stock="30x30x5 at centre top",
                         resolution=0.1)
    assert wide.stock_mm3 == pytest.approx(4500)
    assert wide.removed_mm3 == pytest.approx(HOLE * (6 / 3.175) ** 2, rel=0.02)


def test_a_toolpath_needs_its_stock():
    with pytest.raises(TypeError, match="Stock.block"):
        kerf.simulate(slot())


def test_bytes_are_those_of_the_files(program, tmp_path):
    result = kerf.simulate(program, resolution=0.2)
    result.save(tmp_path / "a.stl", tmp_path / "a.png", tmp_path / "a.kstock", view="top", size=(200, 100))
    assert (tmp_path / "a.stl").read_bytes() == result.mesh_file("stl", name="part")
    picture = result.picture(view="top", size=(200, 100))
    assert picture[:8] == b"\x89PNG\r\n\x1a\n"
    assert (tmp_path / "a.png").read_bytes() == picture
    assert kerf.load_stock(tmp_path / "a.kstock").high == pytest.approx((20, 10, 0))
    assert result.picture(view=(-35, 50), size=(200, 100), section="y=5") != picture


def test_every_kind_of_simulation_is_saved(tmp_path):
    path = kerf.Toolpath()
    path.rapid((0, 0, 0.2))
    path.extrude((20, 0, 0.2), feed=600, width=0.4, height=0.2)
    kerf.simulate_print(path, resolution=0.05).save(tmp_path / "print.obj", tmp_path / "print.png")
    bar = kerf.simulate_rotary(slot(), diameter=20, x=(0, 40), resolution=0.5)
    assert bar.mesh_file("glb")[:4] == b"glTF"
    with pytest.raises(kerf.Error, match="bar"):
        bar.save(tmp_path / "bar.stl", tmp_path / "bar.kstock")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["print.obj", "print.png"]


def test_wrong_outputs_are_refused(program, tmp_path):
    result = kerf.simulate(program, resolution=0.5)
    for call in (lambda: result.save(tmp_path / "a.jpg"), lambda: result.mesh_file("step"),
                 lambda: result.picture(view="below"), lambda: result.picture(size=(1, 1)),
                 lambda: result.picture(view="top", section="x=1"), lambda: result.picture(section="w=1")):
        with pytest.raises(ValueError):
            call()
    with pytest.raises(kerf.Error, match="x=99"):
        result.picture(section="x=99")
    with pytest.raises(OSError, match="none/a.stl"):
        result.save(tmp_path / "none" / "a.stl")
    assert list(tmp_path.glob("a.*")) == []


def test_warnings_reach_python(write):
    path = write("dry.nc", PROGRAM.replace("X5 Y5", "X95 Y5"))
    with pytest.warns(UserWarning, match="the program removes nothing"):
        kerf.simulate(kerf.load(path), resolution=0.5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kerf.simulate(kerf.load(write("ok.nc", PROGRAM)), resolution=0.5)


def test_outputs_do_not_replace_what_was_read(program):
    source = program.source
    for write in (lambda: kerf.post(program, "grbl", source), lambda: kerf.post(program, "dxf", source)):
        with pytest.raises(kerf.Error, match="would replace an input"):
            write()
    with open(source, encoding="utf-8") as file:
        assert file.read() == PROGRAM


def test_two_outputs_of_one_name_are_refused(program, tmp_path):
    name = str(tmp_path / "part.png")
    with pytest.raises(kerf.Error, match="the same name"):
        kerf.simulate(program).save(name, name)
    assert list(tmp_path.glob("*.png")) == []


def test_one_text_is_not_a_list_of_defines(write):
    path = write("part.gcmc", "move([1mm]);\n")
    with pytest.raises(TypeError, match="defines"):
        kerf.load(path, defines="depth=3mm")
    with pytest.raises(TypeError, match="include_paths"):
        kerf.load(path, include_paths="folder")


def test_a_toolpath_is_written_to_a_file(tmp_path):
    path = kerf.Toolpath()
    path.rapid((0, 0, 5))
    assert kerf.post(path, "grbl", tmp_path / "part.nc") == [str(tmp_path / "part.nc")]
    assert "Z5" in (tmp_path / "part.nc").read_text()


# ---- unknown positions


def test_steps_name_the_axes_whose_position_is_unknown(write):
    """Z is unknown before its first word, X and Z after a probe of them; G92 sets Z again."""
    text = "G21 G90\nG0 X1 Y2\nG0 Z5\nG38.2 X9 Z-20 F50\nG92 Z1.5\nG0 Z5\nG0 X1\nM2\n"
    path = kerf.load(write("probe.nc", text)).toolpath
    steps = [path[i] for i in range(len(path))]
    motions = [s.get("unknown_axes", []) for s in steps if "to" in s]
    assert motions == [["Z"], [], ["X", "Z"], ["X"], []]
    zero, = [s for s in steps if s["step"] == "workzero"]
    assert "unknown_axes" not in zero
