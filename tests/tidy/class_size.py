"""A class has fewer than 60 functions and 30 data members; the exceptions in class_size.txt may only shrink.

With --list prints the largest classes.
"""
import re
import sys

from function_length import compare_with, earlier, read_ratchet
from sources import CPP, blank_comments_and_strings, files, finish, root_of

LIMITS = {"functions": 59, "members": 29}
RATCHET = "tests/tidy/class_size.txt"
FOLDERS = {"src", "include"}
HEAD = re.compile(r"(?<!enum )\b(?:class|struct|union)\s+(?:alignas\s*\([^()]*\)\s*)?(\w+(?:::\w+)*)\s*"
                  r"(?:final\s*)?(?::(?!:)[^;{}()]*)?\{")
NOT_COUNTED = re.compile(r"(using|typedef|friend|static_assert|enum|static|constexpr)\b")
TYPE = re.compile(r"(class|struct|union)\b")


def closing(text, at):
    """The position of the bracket that closes the one at `at`."""
    pairs = {"{": "}", "(": ")"}
    depth = 0
    for i in range(at, len(text)):
        if text[i] in pairs:
            depth += 1
        elif text[i] in pairs.values():
            depth -= 1
            if depth == 0:
                return i
    return len(text)


def declarations(body):
    """The declarations of a class's body, with {} and () in place of what is between brackets."""
    chunk, at = "", 0
    while at < len(body):
        mark = body[at]
        if mark == ";":
            yield chunk
            chunk = ""
        elif mark in "{(":
            end = closing(body, at)
            chunk += "{}" if mark == "{" else "()"
            at = end
            follows = body[end + 1:].lstrip()[:1]
            if mark == "{" and "(" in chunk and follows not in (";", ",", "{", "(", "="):
                yield chunk
                chunk = ""
        else:
            chunk += mark
        at += 1
    yield chunk


def classify(chunk):
    """("functions" or "members", how many) of a declaration; None if it is neither."""
    text = re.sub(r"\[\[.*?\]\]|\b(public|private|protected)\s*:(?!:)", " ", chunk)
    text = re.sub(r"\boperator\s*(\(\)|[^\s\w(]+)", "operator_", text)
    while re.search(r"<[^<>]*>", text):
        text = re.sub(r"<[^<>]*>", "", text)
    text = re.sub(r"\b(template|mutable|inline|virtual|explicit)\b", " ", text).strip()
    head = re.split(r"[={]", text, maxsplit=1)[0]
    if not text or (text.startswith("friend") and "(" in head):
        return None
    if "(" in head and not text.startswith(("using", "typedef", "static_assert")):
        return "functions", 1
    if NOT_COUNTED.match(text) or (TYPE.match(text) and not re.search(r"\{\}\s*\w", text)):
        return None
    return "members", len(re.sub(r"\{\}|\(\)", "", text).split(","))


def classes(text):
    """(name, {"functions": number, "members": number}) of every class and struct of a text."""
    text = blank_comments_and_strings(text)
    text = re.sub(r"(?m)^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    text = re.sub(r"\(\s*\*\s*(\w+)\s*\)\s*\([^()]*\)", r" \1", text)  # pointers to functions
    for match in HEAD.finditer(text):
        counts = {"functions": 0, "members": 0}
        body = text[match.end():closing(text, match.end() - 1)]
        for chunk in declarations(body):
            found = classify(chunk)
            if found:
                counts[found[0]] += found[1]
        yield match.group(1), counts


def main():
    root = root_of([a for a in sys.argv if a != "--list"])
    sizes = {}
    for path in files(root, CPP):
        if path.parts[0] not in FOLDERS:
            continue
        for name, counts in classes((root / path).read_text(errors="replace")):
            for kind, number in counts.items():
                key = f"{path.as_posix()} {name} {kind}"
                sizes[key] = max(number, sizes.get(key, 0))
    if "--list" in sys.argv:
        for key, number in sorted(sizes.items(), key=lambda item: -item[1])[:40]:
            print(number, key)
        return
    ratchet = read_ratchet((root / RATCHET).read_text())
    problems = []
    for kind, limit in LIMITS.items():
        large = {key: n for key, n in sizes.items() if key.endswith(kind) and n > limit}
        listed = {key: n for key, n in ratchet.items() if key.endswith(kind)}
        problems += compare_with(large, listed, limit, kind, "divide it", RATCHET)
    finish("class_size", problems + earlier(root, RATCHET, ratchet))


if __name__ == "__main__":
    main()
