"""kerf.printer_profile: printers and filaments by name and from files, for kerf.Printer."""
import re

import kerf
import pytest


def test_a_profile_sets_up_a_printer(tmp_path):
    profile = kerf.printer_profile("prusa_i3:PETG")
    assert profile["firmware"] == "marlin" and (profile["nozzle"], profile["bed"]) == (240, 80)
    assert profile["settings"] == {"width": 0.45, "height": 0.2, "filament": 1.75, "max_flow": 10,
                                   "retract": 0.8, "retract_speed": 2100, "hop": 0.4}
    printer = kerf.Printer(**profile["settings"], speed=12000)
    printer.start(nozzle=profile["nozzle"], bed=profile["bed"])
    printer.next_layer()
    printer.bead([(10, 10), (60, 10)])
    printer.finish()
    target = tmp_path / "part.gcode"
    kerf.post(printer.path, profile["firmware"], str(target))
    assert "M109 S240" in target.read_text()
    # The speed is that at which the hot end melts 10 mm3/s: 10 / 0.08142 mm2 = 122.8 mm/s.
    assert re.search(r"F7(369|370)", target.read_text())


def test_a_file(tmp_path):
    file = tmp_path / "p.toml"
    file.write_text('[[printer]]\nname = "mine"\nfirmware = "klipper"\nspeed = 3600\n')
    profile = kerf.printer_profile(f"{file}:ABS")
    assert (profile["name"], profile["firmware"], profile["nozzle"]) == ("mine", "klipper", 250)
    assert profile["settings"] == {"speed": 3600}


@pytest.mark.parametrize("name", ["", "ender_4", "ender_3:mud", "none.toml"])
def test_what_is_refused(name):
    with pytest.raises(kerf.Error):
        kerf.printer_profile(name)


# ---- the printer of other calls


def printed(speed, x=60.0, celsius=210):
    path = kerf.Toolpath()
    path.temperature("nozzle", celsius, wait=True)
    path.rapid((10, 10, 0.2))
    path.extrude((x, 10, 0.2), feed=speed, width=0.45, height=0.2)
    path.end()
    return path


def test_a_print_is_checked_for_its_printer():
    # 0.45 x 0.2 mm with round sides is 0.0814 mm2: 300 mm/s are 24.4 mm3/s; the bed ends at X220.
    kinds = lambda path, **more: {f["kind"] for f in kerf.check(path, **more)}
    quiet = kinds(printed(1200), printer="ender_3:PLA")
    wild = kinds(printed(18000, x=500), printer="ender_3:PLA") - quiet
    assert len(wild) >= 2, wild
    assert not wild & kinds(printed(18000, x=500)), "without a printer neither flow nor bed is known"
    with pytest.raises(kerf.Error, match="ender_4"):
        kerf.check(printed(1200), printer="ender_4")


def test_figures_of_a_print_on_its_printer(tmp_path):
    figures = kerf.print_figures(printed(18000))
    area = (0.45 - 0.2) * 0.2 + 3.141592653589793 * 0.1**2
    assert figures["flow_mm3_s"]["highest"] == pytest.approx(300 * area, rel=1e-6)
    assert (figures["flow_mm3_s"]["step"], figures["flow_mm3_s"]["limit"]) == (2, None)
    assert figures["time_s"]["machine"] is None
    file = tmp_path / "p.toml"
    limits = "max_flow = 5\nacceleration = [100, 100, 100]\njerk = [1, 1, 1, 1]\n"
    file.write_text('[[printer]]\nname = "slow"\n' + limits)
    slow = kerf.print_figures(printed(18000), printer=str(file))
    assert (slow["time_s"]["machine"], slow["flow_mm3_s"]["limit"]) == ("slow", 5)
    # 50 mm from rest to rest at 100 mm/s2: the speed of 300 mm/s is never reached; 2 * sqrt(50 / 100) s.
    assert slow["time_s"]["total"] > 1.2 > figures["time_s"]["total"]


def test_a_print_is_posted_for_its_printer(tmp_path):
    assert "ender_3" in kerf.post(printed(1200), printer="ender_3:PLA")
    file = tmp_path / "p.toml"
    file.write_text(
        '[[printer]]\nname = "mine"\nfirmware = "marlin"\nstart = ["M140 S{bed}"]\nend = ["M140 S0"]\n'
        '[[filament]]\nname = "mud"\nnozzle = 201\nbed = 51\n'
    )
    lines = kerf.post(printed(1200), printer=f"{file}:mud").splitlines()
    bead = next(i for i, line in enumerate(lines) if line.startswith("G1"))
    assert "M140 S51" in lines[:bead] and "M140 S0" in lines[bead:]
    assert not any(line.startswith("M140") for line in kerf.post(printed(1200), "marlin").splitlines())
    for wrong in ({}, {"to": "marlin", "printer": "ender_3"}):
        with pytest.raises(ValueError, match="one of to and printer"):
            kerf.post(printed(1200), **wrong)
    with pytest.raises(kerf.Error):
        kerf.post(printed(1200), printer="ender_4")


def test_printers_are_listed_and_imported(tmp_path):
    known = kerf.printers()
    assert {"ender_3", "prusa_i3"} <= {fold(n) for p in known["printers"] for n in [p["name"], *p["names"]]}
    assert any(f["name"] == "PLA" and f["nozzle"] for f in known["filaments"])
    for entry in known["printers"]:
        assert kerf.printer_profile(entry["name"])["firmware"] == entry["firmware"]
    kerf.post(printed(1200), "marlin", tmp_path / "print.gcode")
    text = kerf.import_printer(tmp_path / "print.gcode", tmp_path / "mine.toml")
    assert (tmp_path / "mine.toml").read_text() == text
    settings = kerf.printer_profile(str(tmp_path / "mine.toml"))["settings"]
    assert (settings["width"], settings["height"]) == (0.45, 0.2)
    (tmp_path / "mill.nc").write_text("G21 G90\nG0 Z5\nG1 X1 F100\nM2\n")
    with pytest.raises(ValueError, match="does not print"):
        kerf.import_printer(tmp_path / "mill.nc")
    with pytest.raises(FileNotFoundError):
        kerf.import_printer(tmp_path / "none.gcode")
    with pytest.raises(ValueError, match="itself"):
        kerf.import_printer(tmp_path / "print.gcode", tmp_path / "print.gcode")


def fold(name):
    return name.lower().replace(" ", "_").replace("-", "_")


def test_beads_are_coloured():
    path = printed(1200)
    part = kerf.simulate_print(path)
    plain, by_speed = (part.picture(size=(160, 100), colour=c) for c in ("tool", "speed"))
    assert plain != by_speed and part.mesh_file("obj", colour="speed")
    with pytest.raises(ValueError, match="colour must be"):
        part.picture(colour="mud")
