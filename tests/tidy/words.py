"""The project's words (docs/manual/glossary.md): banned ones are counted, and words.txt may only shrink.

    words.py [ROOT]             the check: no file has more banned words than words.txt allows it
    words.py --list [FILE...]   every banned word with its line and what to write instead
    words.py --write            lowers words.txt to today's counts

Counts belong to file names without folders, so moving a file changes nothing. Where text moves between files,
--write moves the counts too, as long as their sum does not grow. A file that is not in words.txt may have
none.
"""
import re
import signal
import sys
from collections import Counter

from sources import CPP, files, git, root_of

RATCHET = "tests/tidy/words.txt"
GLOSSARY = "docs/manual/glossary.md"

# Not checked: history, licences, inputs of tests, this list and its tests.
SKIPPED = re.compile(r"^(fuzz/corpus|tests/data|data/fonts|data/gcmc)/|^(CHANGELOG\.md|LICENSE|NOTICE)$"
                     r"|^tests/tidy/(words\.(py|txt)|tidy_test\.py|function_length\.txt)$")
PROSE_SUFFIXES = {".md", ".toml", ".cmake", ".in", ".html", ".css", ".yml"}  # whole text, names included
CODE_SUFFIXES = CPP | {".def", ".py", ".js", ".ts"}
NAMES_WITHOUT_SUFFIX = {"dev", "CMakeLists.txt", "run"}

# Fixed by formats and interfaces: keys of JSON and files, names of the Python interface and of libraries,
# words of other programs; also correct English that the patterns below would find. The names of the codes are
# added by codes_of.
FIXED = re.compile(
    r"/usr/share|(?:source\(\)|\bat)\.begin|\b(?:road_mm|in_place|std::begin|std::shared_\w+)\b"
    r"|\bself_meetings\b|\bkerf\.widen\b|[\"`]widen[\"`(]|(?<=    )widen(?=,)|\.roads\b|\bpng_image_begin_\w+"
    r"|\"roads\"|`roads`|\*road\*|-- (?:pro|epi)logue begin --|\bAcDbBlockBegin\b|\"spot\"|--spot\b"
    r"|\bthumbnail begin\b"
    r"|\bbegin(?= : step|, (?:double )?step| = 0\.0, step)"
    r"|(?<=[xyrv]\.)begin\b|(?<=range\.)begin\b|(?<=\)\.)begin\b|\"begin\"(?=\) return)"
    r"|\b(?:in-place|stand-?ins?|stand-?alone)\b|(?<=[.>])c?r?begin(?=\()|\bc?r?begin(?=\(\))"
    r"|\bplace-?holders?\b|\b(?:decimal|first) places?\b|\b(?:in|into|takes?|taken|took|taking) place\b"
    r"|\b(?:tak\w+|keeps?|kept) (?:its|their) places?\b|\bchang\w+ places\b"
    r"|\b(?:tell|tells|telling|told) (?:them |it |\w+ )?apart\b")

# (what, pattern, use instead) for comments, strings and documents. Case does not count.
PROSE = [
    ("nobody", r"\bnobody\b", "unknown; not given; or the passive"),
    ("told", r"\b(?:un)?told\b", "given, specified, reported"),
    ("tell", r"\btell(?:s|ing)?\b", "specify, give (of options); report, name, say (of output)"),
    ("said", r"\b(?:un)?said\b", "given, specified; reported"),
    ("nobody says", r"\bwhere (?:nothing|none) (?:is )?says?\b", "by default"),
    ("begin", r"\bbeg[iau]n(?:s|ning)?\b", "start, start point"),
    ("reckon", r"\breckon\w*", "compute, count"),
    ("anew", r"\banew\b", "again, re- (recomputed)"),
    ("once more", r"\bonce more\b", "again"),
    ("worked out", r"\b(?:work(?:s|ed|ing)? (?:it |them )?out)\b", "compute, determine"),
    ("looked for", r"\blook(?:s|ed|ing)? (?:for|through)\b", "search, search for"),
    ("looked at", r"\blook(?:s|ed|ing)? at\b", "examine, check"),
    ("hangs together", r"\bh(?:a|u)ngs? together\b", "connected"),
    ("passed over", r"\bpassed over\b", "skipped, ignored"),
    ("stands", r"(?<!left )\bst(?:ands?|ood|anding)\b(?! out)",
     "is, lies; replaces (stands for); stopped (spindle)"),
    ("mend", r"\bmend\w*\b", "repair, remove (degenerate triangles)"),
    ("part", r"\bpart(?:ed|ing|ings)\b", "split, separate"),
    ("bend", r"\bben(?:ds?|t|ding)\b", "curvature, curve"),
    ("road", r"\broads?\b", "bead"),
    ("at the most", r"\bat the most\b|\bfar the most\b", "at most; most by far"),
    ("share", r"\b(?:a|the|this|that|its|their|such a|each|whose|same|largest|smallest|this much) shares?\b"
              r"|\bshares? (?:of|at|in)\b|\bas shares?\b|(?:'s?|s') shares?\b", "fraction"),
    ("spot", r"\bspots?\b(?! (?:drill|fac|weld))", "point, position, query point; location (in a text)"),
    ("hollow", r"\bhollow (?:arc|round|flank|side|curve)\w*", "concave arc"),
    ("meeting", r"\bmeetings?\b", "intersection, contact"),
    ("take apart", r"\bt(?:ak(?:e|es|en|ing)|ook) (?:\w+ ){0,2}apart\b", "parse, split"),
    ("middle", r"\bmiddles?\b(?! of (?:a|the) (?:program|line|file|word|run|job|name|sweep|text|batch))",
     "midpoint, centre, centre line"),
    ("place", r"(?<!in )\bplaces?\b(?! (?:in|on) the list)(?=\W|$)",
     "position (of a point), location (in a text)"),
    ("widen", r"\bwiden(?:s|ed|ing)?\b", "buffer; increase in diameter"),
    ("brackets", r"\b(?:in|without|round|its|opening|closing) brackets\b",
     "parentheses for ( ); square brackets for [ ]"),
    ("sound", r"\b(?:un)?sound\b", "valid, invalid"),
    ("remark", r"\bremarks?\b", "comment"),
    ("per", r"\b(?:one|once|twice|bytes|numbers|indices|values|messages|files?) an? (?:line|tool|column|step"
            r"|triangle|vertex|layer|element|tile|micro|cell|point|row|side|wall|body|corner|turn|message"
            r"|code|target|file|kind|sweep)\b",
     "per: one per line"),
    ("behind", r"\bbehind (?:a|the|its|their|each) (?:number|word|text|semicolon|name|line|code|comma|call"
               r"|end)\b", "after"),
    ("go on", r"\bgo(?:es|ing)? on\b|\bwent on\b|\bgone on\b", "continue"),
    ("let go", r"\blets? (?:\w+ )?go\b", "release"),
    ("give back", r"\bg(?:i|a)v(?:e|es|en|ing) (?:\w+ ){0,2}back\b", "return, release"),
    ("hand over", r"\bhand(?:s|ed|ing)? (?:\w+ )?(?:back|over|on)\b", "return, pass"),
    ("comes to lie", r"\bc(?:o|a)mes? to lie\b", "lies"),
    ("put into words", r"\bput(?:s|ting)? (?:\w+ ){0,2}into words\b", "format, report"),
    ("inmost", r"\binmost\b", "innermost, deepest"),
    ("at hand", r"\bat hand\b", "available"),
]

# (what, pattern, use instead) for each word of a name: ToolPath, tool_path and kToolPath are "tool path".
NAMES = [
    ("nobody", r"nobody", "unknown"),
    ("tell", r"tells?|told|untold|teller", "report, given"),
    ("said", r"said|unsaid", "given, reported"),
    ("most", r"(?<=^k )most\b|^most(?= \w)|(?<!at )most$", "max"),
    ("least", r"(?<=^k )least\b|^least(?= \w)", "min"),
    ("begin", r"begins?|begun", "start, first"),
    ("reckon", r"reckon\w*", "compute"),
    ("anew", r"anew", "again"),
    ("share", r"shares?", "fraction"),
    ("spot", r"spots?", "point, location"),
    ("place", r"places?", "position, location"),
    ("middle", r"middles?", "midpoint, centre"),
    ("bend", r"bends?|bent", "curvature"),
    ("road", r"roads?", "bead"),
    ("mend", r"mend\w*", "repair"),
    ("part", r"parted|partings?", "split"),
    ("meeting", r"meetings?", "intersection, contact"),
    ("widen", r"widen", "buffer"),
    ("sound", r"(?:un)?sound", "valid"),
    ("remark", r"remarks?", "comment"),
    ("gone", r"gone", "removed"),
    ("talker", r"talker|speaker", "reporter"),
]
PROSE = [(what, re.compile(pattern, re.I), use) for what, pattern, use in PROSE]
# One pass finds the lines that are worth a closer look.
ANY_PROSE = re.compile("|".join(f"(?:{p.pattern})" for _, p, _ in PROSE), re.I)
NAMES = [(what, re.compile(rf"(?:(?<= )|^)(?:{pattern})(?= |$)"), use) for what, pattern, use in NAMES]
TEXTS = {  # comments and strings of a language
    "cpp": re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<d>[^()\s\\]*)\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"', re.S),
    "py": re.compile(r'#[^\n]*|""".*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S),
}
NAME = re.compile(r"[A-Za-z_]\w*")
COMPOUND = re.compile(r"\b(?:[A-Za-z]+_\w+|k?[A-Z]?[a-z0-9]+[A-Z]\w*)\b")
# A variable named begin is the first index of a range, unless its type or its owner says otherwise.
BEGIN_OF_MOTION = re.compile(r"(?:[.>]|\b(?:Point[23]|double|float|Length|Angle|V[23]|Vector)&? )begin$")


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def words_of(name):
    """The words of a name: "kMostSteps" is "k most steps"."""
    name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name.replace("_", " "))
    return " ".join(name.lower().split())


def in_prose(text):
    """(position, word, instead) of the banned words and names of a text."""
    found = []
    if ANY_PROSE.search(text):
        for _, pattern, use in PROSE:
            found += [(m.start(), m.group(), use) for m in pattern.finditer(text)]
    return found + [hit for m in COMPOUND.finditer(text) for hit in in_name(m)]


def in_name(match):
    words = words_of(match.group())
    return [(match.start(), match.group(), use) for _, pattern, use in NAMES if pattern.search(words)]


def offences(path, text, fixed=None):
    """(line, word, instead) of a file's text, in order. `path` decides how it is read; `fixed`: names
    that stay."""
    suffix = "." + path.rsplit(".", 1)[-1] if "." in path.rsplit("/", 1)[-1] else ""
    name = path.rsplit("/", 1)[-1]
    if SKIPPED.search(path) or not (suffix in PROSE_SUFFIXES | CODE_SUFFIXES or name in NAMES_WITHOUT_SUFFIX):
        return []
    if path == GLOSSARY:  # its last column lists what is not used
        text = re.sub(r"(?m)^(\|.*)\|[^|]*\|$", r"\1|", text)
    text = FIXED.sub(blank, text)
    if fixed:
        text = fixed.sub(blank, text)
    if suffix in CODE_SUFFIXES:
        language = TEXTS["py" if suffix == ".py" else "cpp"]
        found = [(m.start() + at, word, use) for m in language.finditer(text)
                 for at, word, use in in_prose(m.group())]
        code = language.sub(blank, text)
        for match in NAME.finditer(code):
            before_it = code[max(0, match.start() - 12):match.end()]
            if match.group() == "begin" and not BEGIN_OF_MOTION.search(before_it):
                continue
            found += in_name(match)
    else:
        found = in_prose(text)
    return [(text.count("\n", 0, at) + 1, word, use) for at, word, use in sorted(set(found))]


def codes_of(root):
    """The names of the diagnostic codes: they are stable, whatever their words."""
    tables = "".join(p.read_text() for p in sorted((root / "src/base/codes").glob("*.def")))
    names = re.findall(r"KERF_CODE\(\d+, (\w+)", tables)
    return re.compile(r"\b(?:" + "|".join(names) + r")\b") if names else None


def read_ratchet(text):
    """{file name: count} from lines of "count name"."""
    rows = [line.split(None, 1) for line in text.splitlines() if line and not line.startswith("#")]
    return {name: int(count) for count, name in rows}


def compare(counts, allowed):
    """Problems of today's counts by file name against those of words.txt."""
    return [f"{name}: {count} banned words, allowed are {allowed.get(name, 0)}: see tests/tidy/words.py"
            " --list (for text that moved between files: --write)"
            for name, count in sorted(counts.items()) if count > allowed.get(name, 0)]


def before(root):
    """The sum of the last commit's words.txt that differs from today's, or None where git has none."""
    now = (root / RATCHET).read_text()
    for commit in ("HEAD", "HEAD^"):
        then = git(root, "show", f"{commit}:{RATCHET}")
        if then is not None and then != now:
            return sum(read_ratchet(then).values())
    return None


def count_all(root):
    fixed, counts = codes_of(root), Counter()
    for path in files(root):
        text = read(root, path)
        if text is not None:
            counts[path.name] += len(offences(path.as_posix(), text, fixed))
    return +counts


def read(root, path):
    if SKIPPED.search(path.as_posix()):
        return None
    if path.suffix not in PROSE_SUFFIXES | CODE_SUFFIXES and path.name not in NAMES_WITHOUT_SUFFIX:
        return None
    return (root / path).read_text(errors="replace")


def show(root, chosen):
    fixed = codes_of(root)
    for path in files(root):
        if chosen and not any(f"{path.as_posix()}/".startswith(c.rstrip("/") + "/") for c in chosen):
            continue
        text = read(root, path)
        for line, word, use in offences(path.as_posix(), text, fixed) if text is not None else []:
            print(f"{path.as_posix()}:{line}: {' '.join(word.split())} -> {use}")


def write(root):
    counts = count_all(root)
    target = root / RATCHET
    old = sum(read_ratchet(target.read_text()).values()) if target.exists() else None
    if old is not None and sum(counts.values()) > old:
        print(f"words: {sum(counts.values())} banned words, {RATCHET} allows {old}: not written")
        return 1
    head = "# Banned words per file name, written by tests/tidy/words.py --write; the sum may only shrink.\n"
    target.write_text(head + "".join(f"{count} {name}\n" for name, count in sorted(counts.items())))
    print(f"words: {sum(counts.values())} in {len(counts)} file names")
    return 0


def main():
    flags = [a for a in sys.argv[1:] if a.startswith("--")]
    arguments = [a for a in sys.argv[1:] if not a.startswith("--")]
    if "--list" in flags:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # `| head` may close the pipe
        show(root_of([]), arguments)
        return 0
    if "--write" in flags:
        return write(root_of([]))
    root = root_of(["", *arguments])
    counts = count_all(root)
    allowed = read_ratchet((root / RATCHET).read_text())
    problems = compare(counts, allowed)
    old = before(root)
    if old is not None and sum(allowed.values()) > old:
        problems.append(f"{RATCHET}: the sum grew from {old} to {sum(allowed.values())}")
    for problem in problems:
        print(problem)
    spare = sum(allowed.values()) - sum(counts.values())
    hint = f"; {spare} fewer than words.txt allows: run words.py --write" if spare > 0 else ""
    print(f"words: {len(problems)} problem(s)" if problems else f"words: in order{hint}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
