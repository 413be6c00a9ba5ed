"""The table of diagnostic codes: numbers and names are unique and in range, and a test provokes each."""
import re
import sys

from sources import files, finish, root_of

TABLE = "include/kerf/codes.def"
FURTHER = ["include/kerf/codes_scad.def"]  # after it, of one kind of input
AREAS = range(1, 12)  # thousands in use, see codes.def


def parse(text):
    """[(number, name, meaning)] in the order of the table."""
    rows = re.findall(r'^KERF_CODE\(\s*(\d+)\s*,\s*(\w+)\s*,\s*((?:"(?:\\.|[^"])*"\s*)+)\)', text, re.M)
    return [(int(number), name, meaning) for number, name, meaning in rows]


def check(rows, tests):
    """Problems of the rows; `tests` is the text of all tests."""
    problems, seen, last = [], set(), 0
    for number, name, meaning in rows:
        for key in (number, name):
            if key in seen:
                problems.append(f"{TABLE}: {key} occurs twice")
            seen.add(key)
        if number // 1000 not in AREAS:
            problems.append(f"{TABLE}: {number} {name} is outside of all areas")
        if number < last:
            problems.append(f"{TABLE}: {number} {name} follows {last}")
        if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
            problems.append(f"{TABLE}: {name} is not snake_case")
        if not meaning.rstrip().endswith('."'):
            problems.append(f"{TABLE}: {number} {name}: the meaning must be a sentence with a full stop")
        if not re.search(rf"\b({name}|{number})\b", tests):
            problems.append(f"{TABLE}: no test provokes {number} {name}")
        last = max(last, number)
    return problems


def main():
    root = root_of(sys.argv)
    text = "".join((root / table).read_text() for table in [TABLE, *FURTHER])
    rows = parse(text)
    whole = len(rows) == len(re.findall(r"^KERF_CODE\(", text, re.M))
    problems = [] if whole else [f"{TABLE}: a row is malformed"]
    tests = [p for p in files(root, {".cpp", ".py", ".json", ".nc", ".toml"})
             if p.parts[0] == "tests" and p.parts[1] not in ("tidy", "wasm")]
    finish("codes", problems + check(rows, "\n".join((root / p).read_text(errors="replace") for p in tests)))


if __name__ == "__main__":
    main()
