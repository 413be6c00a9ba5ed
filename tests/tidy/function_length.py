"""No function is longer than 70 lines, except those in function_length.txt, which may only shrink."""
import re
import sys

from sources import CPP, blank_comments_and_strings, files, finish, git, root_of

LIMIT = 70  # lines from the function's head to its closing brace
RATCHET = "tests/tidy/function_length.txt"
NOT_A_FUNCTION = re.compile(
    r"\b(namespace|class|struct|union|enum)\b(?!.*\))|=\s*$|^\s*$|^\s*extern\s*$", re.S)


def head_name(head):
    """The name of the function that `head`, the text before its brace, declares; None if it is none."""
    if NOT_A_FUNCTION.search(head):
        return None
    match = re.search(r"(operator\s*\(\)|operator\s*[^\s(]+|[~\w:]+)\s*\(", head)
    return match.group(1) if match else None


def functions(text):
    """(name, first line, lines) of every function body that is not itself inside a function."""
    text = blank_comments_and_strings(text)
    text = re.sub(r"(?m)^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    found, depth, inside, head_start = [], 0, None, 0
    for match in re.finditer(r"[{};]", text):
        at, mark = match.start(), match.group()
        if mark == "{":
            if inside is None:
                name = head_name(text[head_start:at])
                if name:
                    begin = head_start + len(text[head_start:at]) - len(text[head_start:at].lstrip())
                    inside = (name, depth, text.count("\n", 0, begin) + 1)
            depth += 1
        elif mark == "}":
            depth -= 1
            if inside is not None and inside[1] == depth and not re.match(r"\s*[,{]", text[at + 1:at + 200]):
                found.append((inside[0], inside[2], text.count("\n", 0, at) + 2 - inside[2]))
                inside = None
        if inside is None:
            head_start = at + 1
    return found


def read_ratchet(text):
    """{"path function": lines} from lines of "lines path function # reason"."""
    rows = [line.split("#")[0].split(None, 1) for line in text.splitlines() if not line.startswith("#")]
    return {row[1].strip(): int(row[0]) for row in rows if row}


def compare_with(largest, ratchet, limit, unit, remedy, file):
    """Problems of what is over the limit, {name: size}, against the ratchet in `file`."""
    problems = []
    for name, size in sorted(largest.items()):
        if name not in ratchet:
            problems.append(f"{name}: {size} {unit}, the limit is {limit}: {remedy}")
        elif size > ratchet[name]:
            problems.append(f"{name}: grew from {ratchet[name]} to {size} {unit}")
    for name, size in sorted(ratchet.items()):
        if largest.get(name, 0) < size:
            now = largest.get(name, f"at most {limit}")
            problems.append(f"{name}: now {now} {unit}: lower or remove it in {file}")
    return problems


def compare(longest, ratchet):
    """Problems of the functions over the limit, {"path function": lines}, against the ratchet."""
    return compare_with(longest, ratchet, LIMIT, "lines", "split it", RATCHET)


def before(root, file):
    """The ratchet of the last commit with different content, or None if git has none."""
    now = (root / file).read_text()
    for commit in ("HEAD", "HEAD^"):
        then = git(root, "show", f"{commit}:{file}")
        if then is not None and then != now:
            return read_ratchet(then)
    return None


def earlier(root, file, ratchet):
    """Problems of a ratchet against that of the last commit."""
    old = before(root, file)
    if old is None:
        return []
    return [f"{file}: {name} was added or raised; the ratchet may only shrink"
            for name, size in sorted(ratchet.items()) if size > old.get(name, 0)]


def main():
    root = root_of(sys.argv)
    longest = {}
    for path in files(root, CPP):
        for name, _, lines in functions((root / path).read_text(errors="replace")):
            key = f"{path.as_posix()} {name}"
            if lines > LIMIT:
                longest[key] = max(lines, longest.get(key, 0))
    ratchet = read_ratchet((root / RATCHET).read_text())
    finish("function_length", compare(longest, ratchet) + earlier(root, RATCHET, ratchet))


if __name__ == "__main__":
    main()
