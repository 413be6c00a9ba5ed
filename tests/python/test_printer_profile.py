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
