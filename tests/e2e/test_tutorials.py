"""The tutorials of docs/tutorials, word for word: their files, their commands, and what they print."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
KERF = Path(os.environ["KERF"]).resolve()
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
SAVE = re.compile(r"Save this as `([^`/]+)`[^\n]*\n\n\Z")
STATUS = re.compile(r"\s+# status (\d+)$")


def steps_of(page):
    """What a reader does: ("file", name, text), ("run", command, status), ("see", line)."""
    text = page.read_text()
    for block in FENCE.finditer(text):
        kind, body = block.groups()
        if saved := SAVE.search(text[: block.start()]):
            yield "file", saved[1], body
        elif kind == "sh":
            for line in body.splitlines():
                status = STATUS.search(line)
                yield "run", STATUS.sub("", line), int(status[1]) if status else 0
        elif kind == "text":
            for line in body.splitlines():
                yield "see", line.strip(), None


def environment(folder):
    """kerf and Python with its modules on the path, as in an installed system."""
    (folder / "bin").mkdir()
    (folder / "bin" / "kerf").symlink_to(KERF)
    (folder / "bin" / "python3").symlink_to(sys.executable)
    return {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}",
            "PYTHONPATH": str(KERF.parent / "python")}


def test_there_are_ten_tutorials_in_the_table_of_contents():
    contents = (ROOT / "docs" / "index.md").read_text()
    assert len(PAGES) == 10 and all(f"tutorials/{page.stem}\n" in contents for page in PAGES)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_works_as_it_is_written(page, tmp_path):
    folder = tmp_path / "work"
    folder.mkdir()
    shutil.copytree(ROOT / "examples", folder / "examples")
    variables = environment(tmp_path)
    printed, runs, made = "", 0, set()
    for what, text, more in steps_of(page):
        if what == "file":
            (folder / text).write_text(more)
        elif what == "run":
            if text.startswith("python3") and not (KERF.parent / "python" / "kerf").is_dir():
                pytest.skip("built without the Python modules")
            done = subprocess.run(text, shell=True, cwd=folder, env=variables, capture_output=True, text=True,
                                  timeout=300)
            printed, runs = done.stdout + done.stderr, runs + 1
            assert done.returncode == more, f"{text}\n{printed}"
            made |= set(re.findall(r"-o (\S+)", text))
        else:
            assert text in " ".join(printed.split()), f"{text} is not in\n{printed}"
    assert runs > 0
    for name in made:
        assert (folder / name).stat().st_size > 100, name
