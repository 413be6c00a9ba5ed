"""kerf.toml and the user's config.toml: values for options that the command line does not give."""
import os
import re

import pytest
from conftest import VALID

MACHINE = 'name = "mine"\n'
POST = 'base = "fanuc"\nname = "shop"\n'


@pytest.fixture
def shop(tmp_path, kerf):
    """shop({"kerf.toml": ..}, "info", "part.nc"): files in the test's folder, and a command there."""
    def run(files, *arguments, **env):
        for name, text in {"part.nc": VALID, **files}.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text)
        given = {"KERF_NO_CONFIG": "", "XDG_CONFIG_HOME": str(tmp_path / "user"), **env}
        return kerf(*arguments, env=given)
    return run


def test_values_hold_for_options_that_are_not_given(shop):
    files = {"kerf.toml": 'units = "inch"\nresolution = 0.5\nspoilboard = "1/8in"\n'}
    assert " in cut" in shop(files, "info", "part.nc").out
    assert " mm cut" in shop(files, "info", "part.nc", "--mm").out
    assert " mm cut" in shop(files, "info", "--no-config", "part.nc").out
    assert " mm cut" in shop(files, "info", "part.nc", KERF_NO_CONFIG="1").out
    assert shop(files, "simulate", "--json", "part.nc").json["resolution_mm"] == 0.5
    assert shop(files, "simulate", "--json", "--resolution", "0.25", "part.nc").json["resolution_mm"] == 0.25


def test_the_post_of_the_shop(shop, tmp_path):
    files = {"kerf.toml": 'post = "linuxcnc"\n'}
    assert "linuxcnc)" in shop(files, "post", "part.nc").out
    assert "grbl)" in shop(files, "post", "--to", "grbl", "part.nc").out
    files = {"kerf.toml": 'post = "shop"\n[folders]\nposts = "own"\n', "own/shop.toml": POST}
    assert "SHOP FOR FANUC" in shop(files, "post", "part.nc").out
    assert "SHOP FOR FANUC" in shop(files, "post", "--to", "shop", "part.nc").out
    job = shop(files, "cut", "--example", "pocket").out
    assert "SHOP FOR FANUC" in shop({**files, "job.toml": job}, "cut", "job.toml").out
    drawing = shop(files, "post", "part.nc", "-o", "out.svg")
    assert drawing.status == 2 and "no controller is given" in drawing.err
    assert not (tmp_path / "out.svg").exists()


def test_files_are_found_beside_the_configuration_and_by_name(shop):
    files = {"kerf.toml": 'machine = "m/mine.toml"\n', "m/mine.toml": MACHINE, "deep/below/part.nc": VALID}
    assert "on mine" in shop(files, "info", "deep/below/part.nc").out
    named = {"kerf.toml": '[folders]\nmachines = "m"\n'}
    assert "on mine" in shop({**files, **named}, "info", "--machine", "mine", "part.nc").out
    run = shop({"kerf.toml": 'machine = "none"\n'}, "info", "part.nc")
    assert run.status == 1 and "kerf.toml:1:11" in run.err


def test_a_tilde_is_the_home_folder(shop, tmp_path):
    files = {"kerf.toml": '[folders]\nmachines = "~/m"\n', "home/m/mine.toml": MACHINE}
    home = str(tmp_path / "home")
    assert "on mine" in shop(files, "info", "--machine", "mine", "part.nc", HOME=home).out
    files["kerf.toml"] = 'machine = "~/m/mine.toml"\n'
    assert "on mine" in shop(files, "info", "part.nc", HOME=home).out


PRINTER = """[[printer]]
name = "{}"
bed = [0, 0, {}, {}]
[[filament]]
name = "PLA"
nozzle = 210
"""
MATERIAL = """[[material]]
name = "birch"
names = ["betula"]
chip_loads = [[1, 0.04], [6, 0.2]]
[[material]]
name = "soft foam"
chip_loads = [[1, 0.4], [6, 4]]
"""
SVG = ('<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40">'
       '<circle cx="20" cy="20" r="15" fill="red"/></svg>')
PRINT = "M104 S210\nM109 S210\nG90\nM83\nG28\nG1 Z0.2 F3000\nG1 X5 Y5\nG1 X95 E3\nG1 Y95 E3\nM104 S0\n"


def test_own_printers_are_found_by_name(shop):
    files = {"kerf.toml": '[folders]\nprinters = "p"\n', "print.gcode": PRINT,
             "p/small.toml": PRINTER.format("small one", 10, 10),
             "p/large.toml": PRINTER.format("large one", 500, 500)}
    for name, is_outside in (("small", True), ("small:PLA", True), ("large", False), ("large:pla", False)):
        hazards = shop(files, "check", "print.gcode", "--printer", name, "--json").json["hazards"]
        assert ("outside_bed" in {h["kind"] for h in hazards}) == is_outside, hazards
    assert "large one" in shop(files, "post", "print.gcode", "--printer", "large").out
    assert shop(files, "info", "print.gcode", "--printer", "large:PLA").status == 0
    unknown = shop(files, "check", "print.gcode", "--printer", "large:none")
    assert unknown.status == 1 and 'unknown filament "none"' in unknown.err
    assert shop(files, "check", "print.gcode", "--printer", "ender_3").status in (0, 3)
    assert shop(files, "printer", "list").out.startswith("large ")
    listed = shop(files, "printer", "list", "--json").json["printers"]
    assert [p["name"] for p in listed][:2] == ["large", "small"]


def test_own_materials_are_found_by_name(shop, tmp_path):
    files = {"kerf.toml": '[folders]\nmaterials = "m"\n', "m/wood.toml": MATERIAL,
             "art.svg": SVG}
    cut = ("cut", "art.svg", "--op", "pocket", "--tool", "square d=6 teeth=2", "--depth", "2",
           "--stepdown", "1", "--rpm", "10000", "--material")
    feeds = [int(re.search(r"feed (\d+)", shop(files, *cut, name).err)[1])
             for name in ("wood", "wood:soft foam")]
    assert feeds[1] > 5 * feeds[0] > 0
    assert shop(files, *cut, "wood:betula").out == shop(files, *cut, "wood").out
    # The same file beside a job, and by its path.
    job = shop(files, "cut", "--example", "pocket").out
    job = job.replace("feed = ", 'material = "m/wood.toml"\n# feed = ')
    assert shop({**files, "job.toml": job}, "cut", "job.toml").status == 0
    for command, status in ((cut, 1), (("check", "part.nc", "--material"), 1)):
        wrong = shop(files, *command, "wood:oak")
        assert wrong.status == status
        assert 'wood.toml: error: the file has no material "oak"' in wrong.err
    broken = {**files, "m/wood.toml": "[[material]]\n"}
    assert shop(broken, "check", "part.nc", "--material", "wood").status == 1
    unknown = shop(files, "check", "part.nc", "--material", "wod")
    assert unknown.status == 2 and "unknown material" in unknown.err
    assert shop(files, "check", "part.nc", "--material", "wood").status == 0


def test_python_shows_the_same(shop, tmp_path, monkeypatch):
    kerf = pytest.importorskip("kerf")
    files = {"kerf.toml": 'post = "mach3"\n[folders]\nprinters = "p"\n', "p/none.txt": "",
             "user/kerf/config.toml": 'units = "inch"\n'}
    shown = shop(files, "config", "--json").json
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "user"))
    monkeypatch.setenv("KERF_NO_CONFIG", "")
    assert kerf.config(tmp_path) == shown == kerf.config(str(tmp_path))
    assert shown["values"]["printers"]["line"] == 3 and shown["values"]["units"]["value"] == "inch"
    (tmp_path / "kerf.toml").write_text("x = 1\n")
    with pytest.raises(kerf.Error, match="unknown key"):
        kerf.config(tmp_path)
    monkeypatch.setenv("KERF_NO_CONFIG", "1")
    assert kerf.config(tmp_path) == {"files": [], "values": {}}


def test_the_file_of_the_work_precedes_that_of_the_user(shop, tmp_path):
    files = {"kerf.toml": 'post = "mach3"\n', "user/kerf/config.toml": 'post = "grbl"\nunits = "inch"\n'}
    run = shop(files, "post", "part.nc")
    assert "mach3)" in run.out and "G20 " in run.out
    shown = shop(files, "config", "--json").json
    assert shown["values"]["post"] == {"value": "mach3", "file": str(tmp_path / "kerf.toml"), "line": 1}
    assert shown["values"]["units"]["file"] == str(tmp_path / "user/kerf/config.toml")
    assert shown["values"]["units"]["line"] == 2
    text = shop(files, "config").out.splitlines()
    assert len(text) == 4 and text[2].startswith("post ") and "kerf.toml:1)" in text[2]


@pytest.mark.parametrize("text, where, hint", [
    ('pots = "grbl"\n', "kerf.toml:1:1: error: unknown key", "post"),
    ("post = 3\n", "kerf.toml:1:8: error: post must be a text", ""),
    ('\nunits = "cm"\n', 'kerf.toml:2:9: error: units must be "mm" or "inch"', ""),
    ("tools = [1]\n", "kerf.toml:1:9: error: tools must be a text, or a list", ""),
    ("[folders]\nmachine = 'x'\n", "kerf.toml:2:1: error: unknown key", "machines"),
    ("x = \n", "kerf.toml:1:5: error", ""), ("\xff\n", "kerf.toml:1:1: error", "")])
def test_errors_have_their_location(shop, text, where, hint):
    run = shop({"kerf.toml": text}, "info", "part.nc")
    assert run.status == 1 and where in run.err and hint in run.err and "[1039]" in run.err


WRONG = [
    ('resolution = "1 ell"\n', "1:14", "resolution"), ("resolution = 0\n", "1:14", "resolution"),
    ("\nspoilboard = -1\n", "2:14", "spoilboard"), ("spoilboard = inf\n", "1:14", "spoilboard"),
    ('post = "nope"\n', "1:8", 'no post "nope"'), ('post = "grbll"\n', "1:8", "did you mean grbl"),
    ('material = "unob"\n', "1:12", 'unknown material "unob"'),
    ('machine = "nope"\n', "1:11", "no built-in machine"),
    ('[folders]\nmachines = "missing"\n', "2:12", "no folder"), ('tools = ["a.toml"]\n', "1:9", "no file"),
]


@pytest.mark.parametrize("text, where, what", WRONG)
def test_wrong_values_are_errors_with_their_line(shop, text, where, what):
    for command in (("config",), ("config", "--json"), ("simulate", "part.nc"), ("check", "part.nc")):
        run = shop({"kerf.toml": text}, *command)
        assert run.status == 1, run.err
        assert f"kerf.toml:{where}: error" in run.err and what in run.err and "[1039]" in run.err


def test_an_error_in_a_file_of_the_configuration_stays_there(shop):
    files = {"kerf.toml": 'machine = "mine"\n[folders]\nmachines = "m"\n', "m/mine.toml": "\nnane = 3\n"}
    run = shop(files, "config")
    assert run.status == 1 and "mine.toml:2:1: error" in run.err


def test_a_value_does_not_contradict_an_option_that_is_given(shop):
    """--rotary excludes --spoilboard, which is no error where it comes from a file."""
    files = {"kerf.toml": "spoilboard = 3\n"}
    run = shop(files, "simulate", "part.nc", "--rotary", "d=20 length=40")
    assert "--spoilboard" not in run.err


def test_without_a_home(shop, tmp_path):
    for home in ("", str(tmp_path / "none"), "/proc"):
        run = shop({}, "config", HOME=home, XDG_CONFIG_HOME="")
        assert run.status == 0 and "no kerf.toml" in run.out


@pytest.mark.skipif(os.getuid() == 0, reason="root may read every file; skipped")
def test_a_file_that_may_not_be_read(shop, tmp_path):
    (tmp_path / "kerf.toml").write_text("")
    (tmp_path / "kerf.toml").chmod(0)
    assert shop({}, "config").status == 1


JOB = """stock = "60x60x12"
{top}
[tools]
1 = "square d=6 teeth=2 flute=20"
[[shape]]
circle = [30, 30, 40]
[[operation]]
op = "pocket"
tool = 1
depth = 2
stepdown = 1
rpm = 16000
{keys}
"""
WORKSHOP = {"m/birch.toml": MATERIAL, "m/mine.toml": 'name = "mine"\nrate = [500, 450, 100]\n'}


def job_of(keys="feed = 900\n", top=""):
    return JOB.format(keys=keys, top=top)


def test_values_are_no_options_of_a_job(shop):
    """Job files state what they need; the configuration is for what they leave out."""
    alone = shop({"job.toml": job_of()}, "cut", "job.toml")
    assert alone.status == 0, alone.err
    for value in ('machine = "grbl_router"\n', 'material = "plywood"\n', "resolution = 0.5\n"):
        run = shop({"kerf.toml": value, "job.toml": job_of()}, "cut", "job.toml")
        assert run.status == 0 and run.out == alone.out, run.err
    refused = shop({"kerf.toml": ""}, "cut", "job.toml", "--material", "plywood")
    assert refused.status == 2 and "a job file contains its operations" in refused.err


def test_values_hold_for_what_a_job_leaves_out(shop):
    files = {**WORKSHOP, "kerf.toml": 'material = "m/birch.toml"\nmachine = "m/mine.toml"\n'}
    missing = shop({"job.toml": job_of("")}, "cut", "job.toml")
    assert missing.status == 1 and "feed is missing" in missing.err
    chosen = shop(files, "cut", "job.toml").err
    assert re.search("feed 450 mm/min, the limit of the machine: .* in birch", chosen)
    stated = shop({"job.toml": job_of('material = "MDF"\n')}, "cut", "job.toml")
    assert " in MDF " in stated.err and "birch" not in stated.err
    drawing = ("cut", "art.svg", "--op", "pocket", "--tool", "square d=6 teeth=2", "--depth", "2",
               "--stepdown", "1", "--rpm", "16000")
    assert " in birch" in shop({"art.svg": SVG}, *drawing).err
    given = shop({"art.svg": SVG}, *drawing, "--feed", "500")
    assert given.status == 0 and "birch" not in given.err


def test_the_spoilboard_of_a_job_precedes_that_of_the_configuration(shop):
    files = {"kerf.toml": "spoilboard = 3\n", "job.toml": job_of()}
    assert "spoilboard: 3.00mm" in shop(files, "cut", "job.toml").out
    files["job.toml"] = job_of(top="spoilboard = 1")
    written = shop(files, "cut", "job.toml").out
    assert "spoilboard: 1.00mm" in written
    for command in ("job.toml", "made.nc"):
        deep = {**files, "job.toml": job_of(top="spoilboard = 1").replace("depth = 2\n", "depth = 14\n")}
        deep["made.nc"] = shop(deep, "cut", "job.toml", "--to", "grbl").out
        kinds = [h["kind"] for h in shop(deep, "check", command, "--json").json["hazards"]]
        assert "below_floor" in kinds, command
        thick = shop(deep, "check", command, "--json", "--spoilboard", "3").json
        kinds = [h["kind"] for h in thick["hazards"]]
        assert "below_floor" not in kinds, command


def test_names_in_jobs_are_found_in_the_folders(shop):
    files = {**WORKSHOP, "kerf.toml": '[folders]\nmachines = "m"\nmaterials = "m"\n', "art.svg": SVG,
             "job.toml": job_of('material = "birch"\nmachine = "mine"\n')}
    run = shop(files, "cut", "job.toml")
    assert run.status == 0 and "feed 450 mm/min, the limit of the machine" in run.err, run.err
    run = shop(files, "cut", "art.svg", "--op", "pocket", "--tool", "square d=6 teeth=2", "--depth", "2",
               "--stepdown", "1", "--rpm", "16000", "--material", "birch", "--machine", "mine")
    assert run.status == 0 and "feed 450 mm/min, the limit of the machine" in run.err, run.err
    assert shop(files, "simulate", "job.toml").status == 0


def test_a_unit_holds_where_the_post_has_it(shop):
    files = {"kerf.toml": 'units = "inch"\n', "print.gcode": PRINT}
    programs = {"klipper": "print.gcode", "carvera": "part.nc", "estlcam": "part.nc", "rml": "part.nc"}
    for post, program in programs.items():
        run = shop(files, "post", program, "--to", post, "--allow-left-out", "--tool", "square d=3")
        assert "inches" not in run.err and run.status == 0, (post, run.err)
        run = shop(files, "post", program, "--to", post, "--inch")
        assert run.status == 1 and "inches" in run.err
    assert "G20 " in shop(files, "post", "part.nc", "--to", "mach3").out
    assert "G21 " in shop(files, "post", "part.nc", "--to", "mach3", "--mm").out


def test_own_names_precede_built_in_ones(shop):
    files = {"kerf.toml": '[folders]\nposts = "q"\nmachines = "q"\nmaterials = "w"\n', "q/grbl.toml": POST,
             "w/plywood.toml": MATERIAL}
    assert "SHOP FOR FANUC" in shop(files, "post", "part.nc", "--to", "grbl").out
    assert "SHOP FOR FANUC" in shop(files, "post", "part.nc", "--post", "grbl").out
    listed = shop(files, "post", "--list", "--json").json
    assert listed[0]["name"] == "grbl" and listed[0]["file"].endswith("grbl.toml")
    assert shop(files, "post", "--list").out.startswith("grbl ")
    assert shop(files, "check", "part.nc", "--material", "plywood:betula").status == 0
    unknown = shop(files, "post", "part.nc", "--to", "grbll")
    assert unknown.status == 2 and "grbl" in unknown.err


def test_unknown_keys_of_materials_are_errors(shop):
    files = {"wood.toml": MATERIAL.replace('names = ["betula"]', 'nmaes = ["betula"]')}
    run = shop(files, "check", "part.nc", "--material", "wood.toml")
    assert run.status == 1 and 'wood.toml:3:1: error: unknown key "nmaes"' in run.err and "names" in run.err
    files = {"wood.toml": MATERIAL.replace('["betula"]', "3")}
    run = shop(files, "check", "part.nc", "--material", "wood.toml")
    assert run.status == 1 and "wood.toml:3:9: error: names must be a list of texts" in run.err
