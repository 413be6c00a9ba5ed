"""What the commands do, as calls: burns, pictures, tool libraries, live simulation, compilers, progress."""

import math
import os
import signal
import struct
import threading
import time

import numpy
import pytest

import kerf


def size_of(png):
    assert png.startswith(b"\x89PNG")
    return struct.unpack(">II", png[16:24])


def slot(y=10.0, z=-2.0):
    path = kerf.Toolpath()
    path.tool(102)
    path.spindle(9000)
    path.rapid((10, y, 5))
    path.cut((10, y, z), feed=100)
    path.cut((40, y, z), feed=400)
    path.rapid((40, y, 5))
    path.end()
    return path


# ---- lasers


def lines(power, feed):
    path = kerf.Toolpath()
    path.rapid((5, 5, 0))
    path.laser(power=power, mode="dynamic")
    path.cut((45, 5, 0), feed=feed)
    path.laser(mode="off")
    path.end()
    return path


def test_the_energy_of_a_burn():
    # 4 W (S 400 of 1000, 10 W) for 40 mm at 20 mm/s: 2 s, 8 J; on the centre line 4 P / (pi d v).
    burn = kerf.burn(lines(400, 1200), beam=0.2, power=10)
    assert burn.beam_s == pytest.approx(2)
    assert burn.energy_j == pytest.approx(8, rel=1e-3)
    assert burn.map.sum() * burn.cell_mm**2 == pytest.approx(8, rel=0.04)
    assert burn.at((25, 5)) == pytest.approx(4 * 4 / (math.pi * 0.2 * 20), rel=0.05)
    assert burn.at((25, 9)) == 0
    assert size_of(burn.picture(size=(320, 200))) == (320, 200)


def test_burns_that_are_none():
    with pytest.raises(kerf.Error):
        kerf.burn(slot())
    with pytest.raises(ValueError, match="beam"):
        kerf.burn(lines(400, 1200), beam=math.nan)
    with pytest.raises(ValueError, match="power must be from"):
        kerf.burn(lines(400, 1200), power=-1)


# ---- pictures


def test_pictures_of_paths_and_comparisons(tmp_path):
    assert size_of(kerf.path_picture(slot(), view="top", size=(400, 300))) == (400, 300)
    part = kerf.simulate(slot(), kerf.Stock.block((60, 40, 6)), resolution=0.5)
    part.save(tmp_path / "part.stl")
    target = kerf.load_stock(tmp_path / "part.stl")
    other = kerf.simulate(slot(y=12), kerf.Stock.block((60, 40, 6)), resolution=0.5)
    same, moved = (kerf.compare_picture(p, target) for p in (part, other))
    assert size_of(same) == size_of(moved) and same != moved
    assert size_of(kerf.compare_picture(other, target, view="iso", size=(300, 200))) == (300, 200)
    with pytest.raises(ValueError, match="full"):
        kerf.compare_picture(part, target, full=0)


# ---- tools


def test_tools_go_to_files_and_back(tmp_path):
    table = kerf.ToolTable()
    table[3] = kerf.Tool("bull nose d=6 r=1 flute=20", number=3)
    kerf.save_tools(table, tmp_path / "shop.toml")
    again = kerf.load_tools(tmp_path / "shop.toml")
    assert again.numbers() == [3] and again[3].parts == table[3].parts
    kerf.save_tools(table, tmp_path / "tool.tbl", unit="inch")
    line = next(row for row in (tmp_path / "tool.tbl").read_text().splitlines() if "T3" in row)
    assert f"D{6 / 25.4:.4f}"[:6] in line
    with pytest.raises(ValueError, match=".toml or .tbl"):
        kerf.save_tools(table, tmp_path / "tool.csv")
    with pytest.raises(FileNotFoundError):
        kerf.load_tools(tmp_path / "none.toml")
    with pytest.raises(kerf.Error):
        (tmp_path / "bad.toml").write_text("[[tool]]\nnumber = 1\nshape = 'spoon'\n")
        kerf.load_tools(tmp_path / "bad.toml")


def test_tools_report_their_shape():
    tool = kerf.Tool("square d=3.175 flute=12.7")
    assert tool.comment.startswith("TOOL/MILL") and tool.encoded_number == 100036
    assert (tool.teeth, tool.plunges) == (2, True)
    assert set(tool.parts) >= {"cutting"}
    shapes = {shape["name"]: shape["dimensions"] for shape in kerf.tool_shapes()}
    assert {d["name"] for d in shapes["V"] if d["required"]} >= {"diameter", "angle"}
    assert kerf.built_in_tools().find("no such name") is None


# ---- simulation with everything around it


def test_fixtures_and_spoilboard():
    clamp = ("clamp", kerf.move_stock(kerf.Stock.block((5, 5, 10)), shift=(20, 7.5, 5)))
    part = kerf.simulate(slot(z=-7), kerf.Stock.block((60, 40, 6)), resolution=0.5, fixtures=[clamp])
    kinds = {f["kind"] for f in part.findings}
    assert any("fixture" in kind for kind in kinds) and any("floor" in kind for kind in kinds)
    below = kerf.simulate(slot(z=-7), kerf.Stock.block((60, 40, 6)), resolution=0.5, spoilboard=3)
    assert not any("floor" in f["kind"] for f in below.findings)
    plain = kerf.simulate(slot(z=-7), kerf.Stock.block((60, 40, 6)), resolution=0.5)
    assert [f["kind"] for f in plain.findings] == [h["kind"] for h in plain.hazards]
    findings = kerf.check(slot(z=-7), stock="60x40x6", spoilboard=3)
    assert not any("floor" in f["kind"] for f in findings)


def test_live_simulation_cuts_what_changed():
    live = kerf.LiveSimulation(stock="60x40x6", resolution=0.5)
    with pytest.raises(ValueError, match="update"):
        live.heights()
    assert live.update(slot())["is_new"]
    removed = live.removed_mm3
    change = live.update(slot(z=-3))
    assert not change["is_new"] and change["columns"]
    assert live.removed_mm3 == pytest.approx(1.5 * removed, rel=1e-3)
    assert live.update(slot(z=-3))["columns"] == []
    surface = live.heights()
    assert (
        surface.shape == (80, 120)
        and surface.min() == pytest.approx(-3)
        and surface.max() == pytest.approx(0)
    )
    assert live.heights(steps=3).min() == pytest.approx(0)
    with pytest.raises(ValueError, match="steps"):
        live.heights(steps=99)
    # The same columns as those of a simulation from the start.
    part = kerf.simulate(slot(z=-3), kerf.Stock.block((60, 40, 6)), resolution=0.5)
    assert surface[20, 50] == pytest.approx(part.column(50, 20)[-1][1])
    with pytest.raises(kerf.Error):
        live.update(kerf.op.transform(slot(), move=(1e7, 0)))
    assert numpy.array_equal(live.heights(), surface)


def test_figures_of_a_print():
    path = kerf.Toolpath()
    path.rapid((0, 0, 0.2))
    path.extrude((100, 0, 0.2), feed=1200, width=0.4, height=0.2)
    figures = kerf.print_figures(path, density=1.27)
    volume = 100 * ((0.4 - 0.2) * 0.2 + math.pi * 0.1**2)
    assert figures["filament_mm3"] == pytest.approx(volume)
    assert figures["mass_g"] == pytest.approx(1.27e-3 * volume)
    assert figures["filament_mm"] == pytest.approx(volume / (math.pi / 4 * 1.75**2))
    assert figures["layers_mm"] == [(pytest.approx(0.2), pytest.approx(0.2))]
    assert kerf.print_figures(path)["density_assumed"]


# ---- compilers


def test_texts_of_gcmc(tmp_path):
    file = tmp_path / "part.gcmc"
    file.write_text('message("depth ", depth); goto([-, -, 5mm]); move([10mm, 0mm, depth]);\n')
    text, messages = kerf.gcmc(file, defines=["depth=-2mm;"], precision=3)
    assert "Z-2.000" in text and messages == ["depth -2mm"]
    assert "<svg" in kerf.gcmc(file, "svg", defines=["depth=-2mm;"])[0]
    with pytest.raises(kerf.Error):
        kerf.gcmc(file)
    with pytest.raises(ValueError, match="to must be"):
        kerf.gcmc(file, "png")
    with pytest.raises(FileNotFoundError):
        kerf.gcmc(tmp_path / "none.gcmc")


def test_options_of_gcmc(tmp_path):
    file = tmp_path / "part.gcmc"
    file.write_text("goto([-, -, 5mm]); move([10mm, 0mm, -1mm]);\n")
    text = kerf.gcmc(file, offsets={"X": 2, "Z": 1}, precision=3, bare=True)[0]
    assert "X12.000" in text and "Z0.000" in text and "M2" not in text
    assert "G18" in kerf.gcmc(file, plane="XZ")[0]
    assert "o<slot> sub" in kerf.gcmc(file, subroutine="slot")[0]
    assert kerf.gcmc(file, prologue="(mine)\n")[0].startswith("(mine)")
    assert kerf.gcmc(file, "svg", opacity=0.5)[0] != kerf.gcmc(file, "svg")[0]
    assert kerf.gcmc(file, compat="1.9") == kerf.gcmc(file, compat="1.8", degrees=True)
    for wrong in ({"plane": "XX"}, {"offsets": {"Q": 1}}, {"opacity": 2}, {"compat": "2.0"}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            kerf.gcmc(file, **wrong)
    with pytest.raises(TypeError, match="precision must be an int, not str"):
        kerf.gcmc(file, precision="x")
    file.write_text("i = 0; while(1) { i++; }\n")
    with pytest.raises(kerf.Error):
        kerf.gcmc(file, max_steps=0.01)
    assert kerf.check_gcmc(file) == []
    file.write_text("move([1mm, 2mm);\n")
    assert kerf.check_gcmc(file)[0].line == 1


def test_job_files_to_start_from(tmp_path):
    assert 'op = "pocket"' in kerf.job_example("pocket")
    assert kerf.job_example("laser_cut") == kerf.job_example("laser-cut")
    with pytest.raises(ValueError, match="pocket"):
        kerf.job_example("spoon")
    assert "operation" in kerf.job_schema()["properties"]


def test_an_openscad_program_with_a_set_of_parameters(tmp_path):
    (tmp_path / "part.scad").write_text("depth = 2; // [1:10]\necho(depth);\n")
    (tmp_path / "part.json").write_text('{"parameterSets": {"deep": {"depth": "7"}}}')
    assert "2" in kerf.scad(tmp_path / "part.scad").output
    made = kerf.scad(tmp_path / "part.scad", parameters=tmp_path / "part.json", parameter_set="deep")
    assert "7" in made.output
    assert made.parameters[0]["name"] == "depth" and made.parameters[0]["choices"] == "[1:10]"
    assert "4" in kerf.scad(tmp_path / "part.scad", defines=["depth=4"]).output
    with pytest.raises(FileNotFoundError):
        kerf.scad(tmp_path / "none.scad")


def test_programs_of_paths_are_adjusted(tmp_path):
    (tmp_path / "a_Clean.gcode").write_text("G01 Z0.800(=0.800+1.000*[#51-2.000]) F100\n")
    (tmp_path / "a_Z.txt").write_text("([1.000 2.000]/T=2.000) #51=2.049\n")
    assert "Z0.849(" in kerf.adjust_path(tmp_path / "a.dxf", max_correction=0.1)
    with pytest.raises(kerf.Error):
        kerf.adjust_path(tmp_path / "a.dxf", max_correction=0.01)
    with pytest.raises(OSError):
        kerf.adjust_path(tmp_path / "b.dxf", max_correction=0.1)


def test_prints_on_a_printer():
    path = kerf.Toolpath()
    path.rapid((0, 0, 0.2))
    path.extrude((900, 0, 0.2), feed=1200, width=0.4, height=0.2)
    far = {f["kind"] for f in kerf.simulate_print(path, printer="ender_3:PLA").findings}
    near = {f["kind"] for f in kerf.simulate_print(path).findings}
    assert far > near
    planned = kerf.estimate(path, printer="ender_3:PLA")
    assert planned["total"] == kerf.print_figures(path, printer="ender_3:PLA")["time_s"]["total"] >= 45
    with pytest.raises(ValueError, match="print"):
        kerf.estimate(slot(), printer="ender_3:PLA")


def test_heights_are_adjusted():
    text = "G01 Z0.800(=0.800+1.000*[#51-2.000]) F100\n"
    assert "Z0.849(" in kerf.adjust_heights(text, {51: 2.049})
    with pytest.raises(kerf.Error):
        kerf.adjust_heights(text, {52: 2.0})
    with pytest.raises(ValueError, match="51"):
        kerf.adjust_heights(text, {51: math.inf})


# ---- progress and interrupts


def long_path():
    path = kerf.Toolpath()
    path.tool(102)
    path.spindle(9000)
    path.rapid((5, 5, 5))
    for i in range(20000):
        path.cut((5 + 90 * (i % 2), 5 + 90 * i / 20000, -1 - i / 20000), feed=1000)
    return path


def test_progress_is_shown_and_can_stop_the_work(capsys):
    seen = []
    with kerf.progress(lambda phase, fraction: seen.append((phase, fraction))):
        kerf.simulate(slot(), kerf.Stock.block((60, 40, 6)), resolution=0.2)
    assert seen and all(0 <= fraction <= 1 for _, fraction in seen) and seen[-1][1] == 1
    seen.clear()
    kerf.simulate(slot(), kerf.Stock.block((60, 40, 6)), resolution=0.2)
    assert not seen, "outside of the block"
    with kerf.progress():
        kerf.simulate(slot(), kerf.Stock.block((60, 40, 6)), resolution=0.2)
    assert "100%" in capsys.readouterr().err

    def stop(phase, fraction):
        raise RuntimeError("enough")

    with kerf.progress(stop), pytest.raises(RuntimeError, match="enough"):
        kerf.simulate(slot(), kerf.Stock.block((60, 40, 6)), resolution=0.2)
    with pytest.raises(TypeError, match="callable"), kerf.progress(3):
        pass


def test_other_threads_run_during_a_call():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.005)

    thread = threading.Thread(target=tick)
    path = long_path()
    thread.start()
    start = time.monotonic()
    kerf.simulate(path, kerf.Stock.block((100, 100, 6)), resolution=0.2, threads=1)
    end = time.monotonic()
    done.set()
    thread.join()
    during = [t for t in ticks if start < t < end]
    assert len(during) >= (end - start) / 0.1


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timer signals")
def test_an_interrupt_stops_a_simulation():
    path = long_path()
    previous = signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt()))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            while time.monotonic() < start + 60:
                kerf.simulate(path, kerf.Stock.block((100, 100, 6)), resolution=0.03)
        assert time.monotonic() - start < 20
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


def test_no_file_is_left_in_part(tmp_path):
    part = kerf.simulate(slot(), kerf.Stock.block((60, 40, 6)), resolution=0.5)
    with pytest.raises(OSError):
        part.save(tmp_path / "part.stl", tmp_path / "none" / "part.png")
    with pytest.raises(OSError):
        kerf.save_left_stock(part, tmp_path / "none" / "left.kstock")
    assert os.listdir(tmp_path) == []
