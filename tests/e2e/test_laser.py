"""kerf cut with operations of lasers: the program read back, GRBL's rules, order, pictures, bad input."""
import base64
import json
import re
import struct
import zlib

import pytest

SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">
<rect x="0" y="0" width="60" height="40" fill="none" stroke="red"/>
<circle cx="15" cy="20" r="5" fill="none" stroke="red"/>
<path d="M30 10 L50 10" fill="none" stroke="blue"/>
</svg>"""
JOB = """art = "part.svg"
[[operation]]
op = "laser-cut"
layers = ["red"]
power = 90
feed = 300
passes = 2
kerf = 0.2
[[operation]]
op = "laser"
layers = ["blue"]
power = 30
feed = 2000
[[operation]]
op = "laser-frame"
feed = 3000
"""
OPERATIONS = ["laser", "laser-cut", "laser-fill", "laser-picture", "laser-test", "laser-frame"]


def png(width, height, rows, kind=0, phys=None):
    """A PNG of 8 bits per channel; kind 0 is grey, 6 has colours and alpha."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    raw = b"".join(b"\0" + bytes(row) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0))
            + (chunk(b"pHYs", struct.pack(">IIB", phys, phys, 1)) if phys else b"")
            + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def cuts(text):
    """(from, to, S, F) of the motions at feed of a G-code program in absolute mm."""
    x = y = f = s = None
    motion, beam, found = None, False, []
    for line in text.splitlines():
        line = re.sub(r"\(.*?\)|;.*", "", line)
        words = re.findall(r"([A-Z])(-?[\d.]+)", line)
        at, moves = (x, y), False
        for letter, number in words:
            value = float(number)
            if letter == "G" and value in (0, 1, 2, 3):
                motion = int(value)
            elif letter == "M":
                beam = value in (3, 4)
            elif letter == "S":
                s = value
            elif letter == "F":
                f = value
            elif letter in "XY":
                moves = True
                x, y = (value, y) if letter == "X" else (x, value)
            elif letter == "Z":
                raise AssertionError("Z moves: " + line)
        if moves and motion == 0:
            assert s in (None, 0), "a rapid with power: " + line
        elif moves:
            assert beam
            found.append((at, (x, y), s, f))
    assert not beam, "the beam is left on"
    return found


def test_the_focus_test_in_one_call(kerf):
    run = kerf("cut", "--op", "laser-test", "--power", "100", "--beam", "constant", "--feed", "1200",
               "--feed-to", "400", "--rows", "5", "--cell-width", "100", "--cell-height", "0", "--gap", "4")
    assert run.status == 0, run.err
    assert cuts(run.out) == [((0, y), (100, y), 1000, 400 + 50 * y) for y in (16, 12, 8, 4, 0)]


def test_a_job_frames_engraves_and_then_cuts_with_the_kerf_beside_the_part(kerf, tmp_path):
    (tmp_path / "part.svg").write_text(SVG)
    (tmp_path / "job.toml").write_text(JOB)
    assert kerf("cut", "job.toml", "-o", "part.nc").status == 0
    text = (tmp_path / "part.nc").read_text()
    found = cuts(text)
    assert [s for _, _, s, _ in found[:5]] == [0, 0, 0, 0, 300]
    assert {f for _, _, _, f in found[:4]} == {3000} and found[4][3] == 2000
    assert {(s, f) for _, _, s, f in found[5:]} == {(900, 300)}
    last = [to for _, to, _, _ in found[-8:]]  # the outside comes last
    assert min(x for x, _ in last) == -0.1 and max(y for _, y in last) == 40.1
    run = kerf("simulate", "part.nc", "--show", "burn", "--json")
    blue, red = 20 / 2000 * 0.3, (2 * 100 + 3.14159 * 0.2 + 2 * 3.14159 * 4.9) / 300 * 0.9 * 2
    assert run.json["burn"]["energy_j"] == pytest.approx(5 * 60 * (blue + red), rel=1e-3)


@pytest.mark.parametrize("op", OPERATIONS)
def test_examples_follow_the_rules_of_grbl(kerf, tmp_path, op):
    (tmp_path / "job.toml").write_text(kerf("cut", "--example", op).out)
    assert kerf("cut", "job.toml", "-o", "part.nc").status == 0
    cuts((tmp_path / "part.nc").read_text())
    assert all(len(line) < 80 for line in (tmp_path / "part.nc").read_text().splitlines())
    for mode in ("$30=1000\n$32=1\n", "$30=1000\n$32=0\n"):
        (tmp_path / "settings.txt").write_text(mode)
        for file in (["part.nc", "--dialect", "laser"], ["job.toml"]):
            run = kerf("check", "--json", *file, "--machine", "settings.txt")
            assert [h for h in run.json["hazards"] if h["kind"].startswith("beam")] == []
            assert run.status == 0, run.out
    job, written = (kerf("simulate", "--json", file, "--show", "burn") for file in ("job.toml", "part.nc"))
    if op != "laser-frame":  # its beam stays off
        assert written.json["burn"]["energy_j"] == pytest.approx(job.json["burn"]["energy_j"], rel=1e-3)


def test_pictures(kerf, tmp_path):
    (tmp_path / "p.png").write_bytes(png(2, 1, [[0, 204]]))
    run = kerf("cut", "p.png", "--op", "laser-picture", "--picture-width", "4", "--interval", "2",
               "--overscan", "1", "--power", "50", "--feed", "3000", "--at", "10,20")
    assert run.status == 0, run.err
    assert cuts(run.out) == [((9, 21), (10, 21), 0, 3000), ((10, 21), (12, 21), 500, 3000),
                             ((12, 21), (14, 21), 100, 3000), ((14, 21), (15, 21), 0, 3000)]
    # Transparent pixels are white; the width is that of the file: 2 pixels at 500 per metre.
    (tmp_path / "q.png").write_bytes(png(2, 1, [[0, 0, 0, 255, 0, 0, 0, 0]], kind=6, phys=500))
    run = kerf("cut", "q.png", "--op", "laser-picture", "--interval", "2", "--power", "50", "--feed", "3000",
               "--overscan", "0")
    assert cuts(run.out) == [((0, 1), (2, 1), 500, 3000)]


@pytest.mark.parametrize("content, message", [
    (b"", "neither a PNG nor a JPEG"),
    (b"GIF89a", "neither a PNG nor a JPEG"),
    (b"\x89PNG\r\n", "not a PNG"),
    (png(2, 1, [[0, 204]])[:45], "cannot be read"),
    (png(60000, 60000, []), "3600000000 pixels"),
    (png(2, 1, [[0, 204]]), "the width of the picture on the board is missing"),
])
def test_bad_pictures(kerf, tmp_path, content, message):
    (tmp_path / "p.png").write_bytes(content)
    run = kerf("cut", "p.png", "--op", "laser-picture", "--power", "50", "--feed", "3000", "-o", "p.nc")
    assert run.status != 0 and message in run.err
    assert not (tmp_path / "p.nc").exists()


# Stored as 32 x 16 pixels at 127 per inch, black on the left; EXIF orientation 6 puts the left at the top.
HALF = base64.b64decode(
    "/9j/4AAQSkZJRgABAQEAfwB/AAD/4QAiRXhpZgAATU0AKgAAAAgAAQESAAMAAAABAAYAAAAAAAD/2wBDAAMCAgMCAgMD"
    "AwMEAwMEBQgFBQQEBQoHBwYIDAoMDAsKCwsNDhIQDQ4RDgsLEBYQERMUFRUVDA8XGBYUGBIUFRT/wAALCAAQACABAREA"
    "/8QAFgABAQEAAAAAAAAAAAAAAAAAAAoJ/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/aAAgBAQAAPwDKoVUCVcVUD//Z")


@pytest.mark.parametrize("name", ["half.jpg", "HALF.JPEG", "half.png"])
def test_a_photo_is_turned_as_its_camera_was(kerf, tmp_path, name):
    """The kind of a picture is that of its bytes; 16 pixels at 5 per mm are 3.2 mm."""
    (tmp_path / name).write_bytes(HALF)
    run = kerf("cut", name, "--op", "laser-picture", "--interval", "0.2", "--power", "50", "--feed", "3000",
               "--overscan", "0")
    assert run.status == 0, run.err
    found = [(at, to) for at, to, s, _ in cuts(run.out) if s > 250]
    assert {round(max(at[0], to[0]) - min(at[0], to[0]), 3) for at, to in found} == {3.2}
    assert min(at[1] for at, _ in found) > 3.2 and max(at[1] for at, _ in found) < 6.4 and len(found) == 16


@pytest.mark.parametrize("content, message", [
    (HALF[:150], "the JPEG cannot be read"),
    (HALF[:4], "the JPEG cannot be read"),
    (HALF.replace(b"\x08\x00\x10\x00\x20", b"\x08\xff\x00\xff\x00"), "4261478400 pixels; the limit"),
    (HALF.replace(b"\x08\x00\x10\x00\x20", b"\x08\x20\x00\x20\x00"), "the JPEG is cut off: 204 bytes"),
])
def test_bad_photos(kerf, tmp_path, content, message):
    (tmp_path / "p.jpg").write_bytes(content)
    run = kerf("cut", "p.jpg", "--op", "laser-picture", "--power", "50", "--feed", "3000", "-o", "p.nc")
    assert run.status == 1 and message in run.err and not (tmp_path / "p.nc").exists()


@pytest.mark.parametrize("arguments", [
    ("--power", "nan"), ("--power", "-1"), ("--power", "101"), ("--feed", "0"), ("--feed", "inf"),
    ("--interval", "0"), ("--interval", "1e-9"), ("--overscan", "-1"), ("--passes", "0"), ("--gamma", "0"),
    ("--max-s", "0"), ("--picture-width", "-4"), ("--picture-width", "1e7"), ("--tones", "blue"),
])
def test_bad_options(kerf, tmp_path, arguments):
    (tmp_path / "p.png").write_bytes(png(2, 1, [[0, 204]]))
    values = {"--picture-width": "4", "--power": "50", "--feed": "3000", arguments[0]: arguments[1]}
    run = kerf("cut", "p.png", "--op", "laser-picture", "-o", "p.nc",
               *(word for pair in values.items() for word in pair))
    assert run.status != 0 and run.err and not (tmp_path / "p.nc").exists()


@pytest.mark.parametrize("firmware, seconds", [("Marlin", 0.1), ("GRBL", 100)])
def test_dwells_are_in_the_unit_of_the_firmware(kerf, program, firmware, seconds):
    """Marlin's page G4: P is in milliseconds; GRBL's is in seconds."""
    path = program(f"; LightBurn 1.4\n; {firmware} device profile, absolute coords\nG21\nG90\nM4 S0\n"
                   "G0 X1 Y1\nG1 X5 S200 F600\nG4 P100\nG1 X9\nM5\nM2\n")
    steps = [json.loads(line) for line in kerf("steps", path).out.splitlines()[1:]]
    assert [s["seconds"] for s in steps if s["step"] == "dwell"] == [seconds]


def test_a_beam_is_no_end_mill(kerf, program):
    path = program("G21 G90\nM4 S0\nG0 X0 Y0\nG1 X20 F1000 S500\nG1 Y20\nM5\nM2\n")
    run = kerf("info", "--dialect", "laser", "--json", path)
    tool, = json.loads(run.out)["tools"]
    assert (tool["name"], tool["shape"], tool["flute_mm"]) == ("beam", "beam", None)
    text = kerf("info", "--dialect", "laser", path).out
    assert "beam" in text and "square" not in text and "flute" not in text
