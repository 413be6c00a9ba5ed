"""kerf view of Python scripts: the page shows what the script has simulated, whole."""
import json
import re
from pathlib import Path

import pytest

from conftest import KERF
from test_view_server import view  # noqa: F401, a fixture

MODULES = Path(KERF).parent / "python" / "kerf"
pytestmark = pytest.mark.skipif(not MODULES.is_dir(), reason="needs the Python module")

REPORT = "\nimport json, sys\njson.dump({}, open(sys.argv[1], 'w'))\n"


def reported(kerf, tmp_path, script, values):
    """What the script itself says of its result."""
    name = tmp_path / "reported.py"
    name.write_text(script + REPORT.format(values))
    done = kerf("run", name, tmp_path / "report.json")
    assert done.status == 0, done.err
    return json.loads((tmp_path / "report.json").read_text())


def shown(view, script):
    return model_of(view(script, "--limit", "30", "--columns", name="part.py"))


def model_of(server):
    model = server.wait(lambda m: m["state"] != "loading")
    assert model["errors"] == [] and model["front_end"] == "Python"
    assert [Path(f["path"]).name for f in model["files"]] == ["part.py"]
    return model


MILLED = "{'removed': part.removed_mm3, 'kinds': [f['kind'] for f in part.findings]}"
DOVETAIL = """import kerf
path = kerf.Toolpath()
path.tool(5)
path.spindle(16000)
path.rapid((-10, 15, 5))
path.rapid((-10, 15, -6))
path.cut((50, 15, -6), feed=400)
path.rapid((50, 15, 5))
part = kerf.simulate(path, kerf.Stock.block((40, 30, 10)), resolution=0.3,
                     tools=kerf.Tool("dovetail d=12 flute=8 angle=14", number=5))
"""
HOLDER = """import kerf
path = kerf.Toolpath()
path.tool(1)
path.spindle(16000)
path.rapid((20, 20, 5))
path.cut((20, 20, -14), feed=100)
path.rapid((20, 20, 5))
part = kerf.simulate(path, kerf.Stock.block((40, 40, 20)), resolution=0.3,
                     tools=kerf.Tool("square d=3 flute=6 shank=3 shank_length=6 holder=30 holder_length=20"))
"""


def test_a_dovetail_is_undercut(kerf, view, tmp_path):
    model = shown(view, DOVETAIL)
    # A trapezium: 12 mm at the tip, narrower by 2 tan 14 degrees per mm, 6 mm high, 40 mm long.
    removed = 40 * 6 * (12 - 6 * 0.249328)
    assert model["report"]["volumes"]["removed_mm3"] == pytest.approx(removed, rel=0.03)
    assert "dovetail" in str(model["tools"][0]["name"])
    assert reported(kerf, tmp_path, DOVETAIL, MILLED)["removed"] == pytest.approx(
        model["report"]["volumes"]["removed_mm3"], rel=0.01)


def test_a_holder_that_touches_is_a_finding(kerf, view, tmp_path):
    model = shown(view, HOLDER)
    result = reported(kerf, tmp_path, HOLDER, MILLED)
    kinds = [f["kind"] for f in model["findings"]]
    assert "holder_contact" in kinds and "holder_contact" in result["kinds"]
    contact = next(f for f in model["findings"] if f["kind"] == "holder_contact")
    assert contact["origin"]["line"] == 6 and Path(contact["origin"]["file"]).name == "part.py"
    assert model["report"]["volumes"]["removed_mm3"] == pytest.approx(result["removed"], rel=0.01)


MESH = """import kerf
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((-5, 5, 5))
path.rapid((-5, 5, -1))
path.cut((20, 5, -1), feed=400)
path.rapid((20, 5, 5))
part = kerf.simulate(path, kerf.load_stock({mesh!r}), resolution=0.3)
"""


def prism(path):
    """A prism over a right triangle of 10 mm, 5 mm high: 250 mm3."""
    corners = [(0, 0), (10, 0), (0, 10)]
    low, high = [(x, y, -5) for x, y in corners], [(x, y, 0) for x, y in corners]
    faces = [(low[0], low[2], low[1]), tuple(high)]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        faces += [(low[a], low[b], high[b]), (low[a], high[b], high[a])]
    path.write_text("solid prism\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in face)
        + "endloop\nendfacet\n" for face in faces) + "endsolid\n")
    return str(path)


def test_a_mesh_is_the_stock(kerf, view, tmp_path):
    script = MESH.format(mesh=prism(tmp_path / "prism.stl"))
    model = shown(view, script)
    # The slot lies between Y3.4125 and Y6.5875, and is 10 - y long: 5 mm on average. Columns of 0.3 mm.
    assert model["report"]["volumes"]["removed_mm3"] == pytest.approx(3.175 * 5, rel=0.08)
    assert model["report"]["volumes"]["stock_mm3"] == pytest.approx(250, rel=0.02)
    # The page does not measure walls between its columns.
    assert reported(kerf, tmp_path, script, MILLED)["removed"] == pytest.approx(
        model["report"]["volumes"]["removed_mm3"], rel=0.06)


LASER = """import kerf
part = kerf.cut("laser_cut", kerf.Region([[(0, 0), (30, 0), (30, 20), (0, 20), (0, 0)]]),
                power=70, feed=300)
kerf.post(part, "laser", "part.nc")
"""


def test_the_power_of_a_laser_arrives(view, tmp_path):
    out = tmp_path / "part.nc"
    server = view(LASER.replace('"part.nc"', repr(str(out))), "--limit", "30", name="part.py")
    model_of(server)
    written = [set(re.findall(r"S[0-9.]+", text)) for text in
               (out.read_text(), server.get("/download/gcode?post=laser").decode())]
    assert written[0] == written[1] and len(written[0]) > 0


PRINT = """import kerf
printer = kerf.Printer(0.45, 0.2)
path = kerf.Toolpath()
path.rapid((10, 10, 0.2))
path.extrude((60, 10, 0.2), width=0.45, height=0.2, feed=1200)
path.extrude((60, 40, 0.2), width=0.45, height=0.2, feed=1200)
part = kerf.simulate_print(path)
"""


def test_a_print_has_its_beads(kerf, view, tmp_path):
    model = shown(view, PRINT)
    assert model["kind"] == "print"
    result = reported(kerf, tmp_path, PRINT, "{'laid': part.total['laid_mm3']}")
    # Two beads of 50 and 30 mm: a rectangle with round sides, and a round end at each free end.
    area = (0.45 - 0.2) * 0.2 + 3.14159265 * 0.1 ** 2
    assert result["laid"] == pytest.approx(80 * area, rel=0.03)
    assert model["report"]["volumes"]["laid_mm3"] == pytest.approx(result["laid"], rel=0.02)


BAR = """import kerf
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((20, 0, 25), rotary=(0, 0, 0))
path.cut((20, 0, 18), feed=200, rotary=(0, 0, 0))
path.cut((20, 0, 18), feed=2000, rotary=(360, 0, 0))
path.rapid((20, 0, 25), rotary=(360, 0, 0))
part = kerf.simulate_rotary(path, 40, (0, 60), resolution=0.3)
"""


def test_a_bar_is_turned(view):
    assert shown(view, BAR)["kind"] == "rotary"


FIXTURE = HOLDER.replace("resolution=0.3,", 'resolution=0.3, fixtures=[("clamp", kerf.move_stock('
                         'kerf.Stock.block((4, 4, 10)), shift=(18, 18, 12)))],')


def test_fixtures_are_met(view):
    assert "fixture" in str([f["kind"] for f in shown(view, FIXTURE)["findings"]])
