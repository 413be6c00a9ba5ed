"""Messages in two languages: each has its German text, with the values of the English one.

The path drawing commands print in English or German. Their messages are constants of type Bilingual; a
message that is no such constant would be English only.
"""
import re
import sys

from sources import CPP, files, finish, root_of

LITERALS = r'((?:"(?:\\.|[^"\\\n])*"\s*)+)'
CONSTANT = re.compile(rf"\bBilingual (k\w+)\{{\s*{LITERALS},\s*{LITERALS}\}}")
DECLARED = re.compile(r"\bconstexpr Bilingual \w+[{\s=]")
# A message that is printed or reported as text; Report and SlashArguments take a Bilingual only.
PLAIN = re.compile(r'\bprint_line\("(?!Kerf )'
                   r'|\bdiagnostics_?\.(?:error|warning|note)\([^;]*?"[^"]*[a-z]{3,}')
# What prints in two languages.
TWO_LANGUAGES = re.compile(r"^src/front/pathdxf/|^src/app/commands/(pathdxf|adjustz)\."
                           r"|^src/app/options/(pathdxf|adjustz|slash)_options\.")


def text_of(literals):
    return "".join(re.findall(r'"((?:\\.|[^"\\\n])*)"', literals))


def check(name, source):
    """Problems of one file."""
    problems = []
    constants = CONSTANT.findall(source)
    if len(constants) != len(DECLARED.findall(source)):
        problems.append(f"{name}: a Bilingual is not declared as kNAME{{\"English\", \"German\"}}")
    for constant, english, german in constants:
        english, german = text_of(english), text_of(german)
        if not english.strip() or not german.strip() or english == german:
            problems.append(f"{name}: {constant} has no German text")
        if english.count("{}") != german.count("{}"):
            problems.append(f"{name}: {constant} has other values in German than in English")
    return problems


def check_plain(name, source):
    """Messages that are plain text."""
    return [f"{name}: a message is in one language only: {' '.join(found.group().split())[:80]}"
            for found in PLAIN.finditer(source)]


def main():
    root = root_of(sys.argv)
    problems = []
    for path in files(root, CPP):
        if path.parts[0] != "src":
            continue
        source = (root / path).read_text()
        problems += check(path, source)
        if TWO_LANGUAGES.match(path.as_posix()):
            problems += check_plain(path, source)
    finish("bilingual", problems)


if __name__ == "__main__":
    main()
