"""The examples of the reference of diagnostics: each provokes its code; each code has one or a reason."""
import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "site"))
import examples  # noqa: E402

KERF = Path(os.environ["KERF"]).resolve()
TABLES = {path.stem: examples.codes(path.read_text())
          for path in sorted((ROOT / "src" / "base" / "codes").glob("*.def"))}
KNOWN = {kind: examples.read(kind) for kind in TABLES}
# Codes without an example yet, by their table. A number that may only shrink.
MISSING = {"pathdxf": 16}

pytestmark = pytest.mark.skipif(examples.tomllib is None, reason="Python 3.11 and later read the examples")


def test_each_code_has_an_example_or_a_reason():
    for kind, rows in TABLES.items():
        names = {name for _, name, _ in rows}
        assert set(KNOWN[kind]) <= names, kind
        assert len(names - set(KNOWN[kind])) == MISSING.get(kind, 0), sorted(names - set(KNOWN[kind]))
        for name, example in KNOWN[kind].items():
            assert ("cannot" in example) != bool(examples.files_of(example) or "run" in example), name


@pytest.mark.parametrize("kind, number, name", [
    (kind, number, name) for kind, rows in TABLES.items() for number, name, _ in rows
    if name in KNOWN[kind] and "cannot" not in KNOWN[kind][name]])
def test_an_example_provokes_its_code(kind, number, name):
    example = KNOWN[kind][name]
    if "kerf run part.py" in examples.command_of(example) and not (KERF.parent / "python" / "kerf").is_dir():
        pytest.skip("built without the Python modules")
    status, output = examples.run(example, KERF)
    assert status in (0, 1, 2, 3), output
    assert examples.message_of(output, number, name), output
