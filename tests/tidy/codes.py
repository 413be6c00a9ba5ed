"""The table of diagnostic codes: numbers and names are unique and in range, and a test provokes each."""
import re
import sys

from sources import files, finish, root_of

FOLDER = "src/base/codes"
# The thousands of each table, by its file name.
AREAS = {"files": 1, "gcode": 2, "tools": 3, "stock": 4, "path": 5, "sim": 6, "outline": 7, "gcmc": 8,
         "pathdxf": 9, "op": 10, "scad": 11}


def parse(text):
    """[(number, name, meaning)] in the order of the table."""
    rows = re.findall(r'^KERF_CODE\(\s*(\d+)\s*,\s*(\w+)\s*,\s*((?:"(?:\\.|[^"])*"\s*)+)\)', text, re.M)
    return [(int(number), name, meaning) for number, name, meaning in rows]


def check(table, rows, tests, seen):
    """Problems of a table; `tests` is the text of all tests, `seen` has the numbers and names of others."""
    problems, last = [], 0
    for number, name, meaning in rows:
        for key in (number, name):
            if key in seen:
                problems.append(f"{table}: {key} occurs twice")
            seen.add(key)
        if number // 1000 != AREAS.get(table):
            problems.append(f"{table}: {number} {name} is outside of the table's area")
        if number < last:
            problems.append(f"{table}: {number} {name} follows {last}")
        if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
            problems.append(f"{table}: {name} is not snake_case")
        if not meaning.rstrip().endswith('."'):
            problems.append(f"{table}: {number} {name}: the meaning must be a sentence with a full stop")
        if not re.search(rf"\b({name}|{number})\b", tests):
            problems.append(f"{table}: no test provokes {number} {name}")
        last = max(last, number)
    return problems


def main():
    root = root_of(sys.argv)
    tests = "\n".join((root / p).read_text(errors="replace")
                      for p in files(root, {".cpp", ".py", ".json", ".nc", ".toml"})
                      if p.parts[0] == "tests" and p.parts[1] not in ("tidy", "wasm"))
    problems, seen = [], set()
    for path in sorted((root / FOLDER).glob("*.def")):
        text = path.read_text()
        rows = parse(text)
        if len(rows) != len(re.findall(r"^KERF_CODE\(", text, re.M)):
            problems.append(f"{path.stem}: a row is malformed")
        problems += check(path.stem, rows, tests, seen)
    finish("codes", problems)


if __name__ == "__main__":
    main()
