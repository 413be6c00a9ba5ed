"""The pictures of the README and the manual: each is made by a command of the table; none is left over."""
import importlib.util
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "manual" / "pictures"


def table():
    spec = importlib.util.spec_from_file_location("make_pictures", FOLDER / "make_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.PICTURES


def shown_pictures():
    pages = [ROOT / "README.md", *(ROOT / "docs" / "manual").glob("*.md")]
    return {(page.parent / link).resolve() for page in pages
            for link in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text())}


def test_each_picture_is_shown_and_has_its_command():
    files = {path.resolve() for path in FOLDER.glob("*.png")}
    assert shown_pictures() == files
    assert {path.stem for path in files} == set(table()) | of_the_viewer()


def of_the_viewer():
    """Pictures that the browser tests of kerf view make."""
    tests = (ROOT / "web" / "tests" / "e2e" / "command.test.ts").read_text()
    return set(re.findall(r"shot\(\w+, '(viewer_\w+)'\)", tests))


def test_the_commands_read_bundled_files():
    for name, command in table().items():
        words = command.format(examples=ROOT / "examples", out="x.png").split()
        inputs = [Path(word) for word in words if "/examples/" in word]
        assert inputs or words[:2] == ["cut", "--example"], name
        assert all(path.is_file() for path in inputs), name
