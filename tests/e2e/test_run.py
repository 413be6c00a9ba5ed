"""kerf run: the part of a script, and the object of --json."""
import pytest

pytest.importorskip("kerf")

PLATE = """import kerf
plate = kerf.Region([[(10, 10), (90, 10), (90, 60), (10, 60), (10, 10)]])
with kerf.Job((100, 70, 10), tools="1=square d=6 flute=20", feed=900, plunge=200, rpm=16000) as job:
    job.contour(plate, 1, depth=3, stepdown=3)
"""
FAILS = 'import kerf\n\ndef part():\n    raise ValueError("no part")\npart()\n'


@pytest.fixture
def script(tmp_path, kerf):
    def run(text, *arguments):
        (tmp_path / "part.py").write_text(text)
        return kerf("run", "part.py", *arguments)
    return run


def test_the_part_of_a_job_is_written(script, tmp_path):
    """As kerf view shows it: docs/tutorials/python.md."""
    run = script(PLATE, "-o", "part.png", "-o", "part.stl", "-o", "part.kerf")
    assert run.status == 0, run.err
    assert (tmp_path / "part.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "part.stl").stat().st_size > 84 and (tmp_path / "part.kerf").exists()
    assert not list(tmp_path.glob("*.txt"))


def test_a_script_without_a_part_says_what_is_one(script, tmp_path):
    run = script("print('hi')\n", "-o", "part.png")
    assert run.status == 1 and "shows no part; part.png was not written" in run.err and "kerf.Job" in run.err
    assert not (tmp_path / "part.png").exists()


def test_the_object_has_the_files_of_the_script(script, tmp_path):
    own = ["own.ngc", "own.png", "t.toml"]
    text = PLATE + 'print("hi")\njob.save("own.ngc", "own.png")\n'
    text += 'kerf.save_tools(kerf.ToolTable(), "t.toml")\n'
    run = script(text, "--json")
    assert run.status == 0 and "hi" in run.err, run.err
    assert run.json == {"status": 0, "outputs": own, "hazards": [], "diagnostics": []}
    assert script(text, "--json", "-o", "part.png").json["outputs"] == [*own, "part.png"]
    assert script(text, "--json", "-o", "own.png").json["outputs"] == own


@pytest.mark.parametrize("text, line, message", [
    (FAILS, 4, "ValueError: no part"), ("\nx = (\n", 2, "SyntaxError: '(' was never closed"),
    ("import sys\nsys.exit(3)\n", 0, "the script ended with exit status 3")])
def test_the_object_has_the_error_of_the_script(script, text, line, message):
    run = script(text, "--json")
    assert run.status == run.json["status"] == (3 if "3" in message else 1)
    assert run.codes() == ["script_failed"]
    found = run.json["diagnostics"][0]
    assert found["origin"] == {"file": "part.py", "line": line, "column": 0} and found["message"] == message
    plain = script(text)
    assert "script_failed" not in plain.err and plain.err.count(message) <= 1  # Python has reported it


def test_the_object_always_has_the_status(script):
    for arguments, status in ((("-o", "none/part.png"), 1), (("-o", "-"), 2), (("-o", "part.xyz"), 2)):
        run = script(PLATE, "--json", *arguments)
        assert run.status == run.json["status"] == status and run.json["outputs"] == []
    run = script("print(1)\n", "--json", "-o", "part.png")
    assert run.status == run.json["status"] == 1 and run.codes() == ["file_unwritable"]
