#!/usr/bin/env python3
"""Makes strokes.txt, the fonts of typeset(), from the Hershey data of Debian's package hershey-fonts-data.

  python3 data/fonts/make_fonts.py [FOLDER OF THE .jhf FILES] > data/fonts/strokes.txt

One line a glyph: code point (hexadecimal), advance, strokes separated by '|', points 'x,y' separated by
blanks. The unit is 1/21 of a capital letter's height, x counts from the glyph's left bearing, y from the
baseline.

What is not Hershey's is drawn here: low punctuation, single brackets, the doubled signs of HSANS_2, accents.
"""
import sys

SPACE = 12           # the width of a space, which is narrower than in the data
FONTS = [            # number of the font in the language, file, name
    (1, "futural", "HSANS_1"), (2, "futuram", "HSANS_2"),
    (3, "scripts", "HSCRIPT_1"), (4, "scriptc", "HSCRIPT_2"),
    (5, "timesr", "HTIMES"), (6, "futural", "HSANS_1_RS"), (0x105, "timesrb", "HTIMES_BOLD"),
    (0x205, "timesi", "HTIMES_ITALIC"), (0x305, "timesib", "HTIMES_ITALIC_BOLD"),
]


def read_jhf(path):
    """{code point: (advance, strokes)} with y up from the baseline and x from the left bearing."""
    glyphs = {}
    for number, line in enumerate(open(path, encoding="ascii").read().splitlines()):
        pairs = [(ord(line[i]) - ord("R"), line[i + 1]) for i in range(8, len(line) - 1, 2)]
        left, right = pairs[0][0], ord(pairs[0][1]) - ord("R")
        strokes, stroke = [], []
        for (x, second), raw in zip(pairs[1:], (line[i:i + 2] for i in range(10, len(line) - 1, 2))):
            if raw == " R":
                strokes.append(stroke)
                stroke = []
            else:
                stroke.append((x - left, 9 - (ord(second) - ord("R"))))
        strokes.append(stroke)
        glyphs[32 + number] = (right - left, [s for s in strokes if s])
    return glyphs


def moved(strokes, dx, dy):
    return [[(x + dx, y + dy) for x, y in s] for s in strokes]


def lower_punctuation(glyphs, chars, dash):
    """Dots that stand on the baseline, and a dash as short as a hyphen."""
    for c in chars:
        width, strokes = glyphs[ord(c)]
        glyphs[ord(c)] = (width, moved(strokes, 0, -3))
    glyphs[ord("-")] = (dash, [[(3, 9), (dash - 3, 9)]])


def single_brackets(glyphs):
    """One line where the data draws two or three."""
    glyphs[ord("[")] = (14, [[(11, 25), (4, 25), (4, -7), (11, -7)]])
    glyphs[ord("]")] = (14, [[(3, 25), (10, 25), (10, -7), (3, -7)]])
    for c, x in (("{", 9), ("}", 5)):
        width, strokes = glyphs[ord(c)]
        glyphs[ord(c)] = (width, [[(x, 25)] + strokes[1] + [(x, -7)]])
    width, (upper, lower) = glyphs[ord("~")]
    middle = [(3, 7), (3, 9)] + upper[2:-1] + [lower[-2], lower[-1]]
    glyphs[ord("~")] = (width, [middle])


def bar(x1, y1, x2, y2, dx, dy):
    """A line of two strokes' width: its outline."""
    return [(x1, y1), (x1 + dx, y1 + dy), (x2 + dx, y2 + dy), (x2, y2), (x1, y1)]


def doubled_signs(glyphs, light):
    """The signs for which the data of the heavy face has thin ones."""
    glyphs[ord("#")] = (21, [bar(11, 25, 4, -7, -1, 0), bar(17, 25, 10, -7, 1, 0), bar(4, 12, 18, 12, 0, 1),
                             bar(3, 6, 17, 6, 0, 1)])
    width, strokes = glyphs[ord("%")]
    glyphs[ord("%")] = (25, [bar(21, 21, 3, 0, 1, 0)] + strokes[1:])
    glyphs[ord("-")] = (16, [bar(3, 9, 13, 9, 0, 1)])
    glyphs[ord("<")] = (24, [[(20, 18), (4, 9), (20, 0), (20, 1), (6, 9), (20, 17), (20, 18)]])
    glyphs[ord(">")] = (24, [[(4, 18), (20, 9), (4, 0), (4, 1), (18, 9), (4, 17), (4, 18)]])
    glyphs[ord("\\")] = (14, [bar(0, 21, 13, -3, 1, 0)])
    glyphs[ord("^")] = (22, [[(3, 16), (11, 23), (19, 16)], [(3, 16), (11, 22), (19, 16)]])
    glyphs[ord("_")] = (20, [bar(0, -7, 20, -7, 0, 1)])
    glyphs[ord("|")] = (9, [bar(4, 25, 4, -7, 1, 0)])
    for c in "{}":
        width, strokes = light[ord(c)]
        glyphs[ord(c)] = (width, strokes)


def box(strokes):
    xs = [x for s in strokes for x, _ in s]
    ys = [y for s in strokes for _, y in s]
    return min(xs), max(xs), min(ys), max(ys)


# Accents around x = 0, standing on y = 0; drawn for Kerf.
ACCENTS = {
    "grave": [[(-3, 5), (2, 0)]],
    "acute": [[(3, 5), (-2, 0)]],
    "circumflex": [[(-4, 0), (0, 4), (4, 0)]],
    "tilde": [[(-5, 0), (-4, 2), (-2, 3), (0, 2), (2, 1), (4, 2), (5, 4)]],
    "diaeresis": [[(-4, 1), (-3, 0), (-4, -1), (-5, 0), (-4, 1)],
                  [(4, 1), (5, 0), (4, -1), (3, 0), (4, 1)]],
    "ring": [[(0, 5), (-2, 4), (-3, 2), (-2, 0), (0, -1), (2, 0), (3, 2), (2, 4), (0, 5)]],
}
CEDILLA = [[(0, 0), (-1, -2), (1, -3), (2, -4), (1, -6), (-1, -7), (-3, -6)]]
LETTERS = {
    0xC0: "A grave", 0xC1: "A acute", 0xC2: "A circumflex", 0xC3: "A tilde", 0xC4: "A diaeresis",
    0xC5: "A ring",
    0xC8: "E grave", 0xC9: "E acute", 0xCA: "E circumflex", 0xCB: "E diaeresis",
    0xCC: "I grave", 0xCD: "I acute", 0xCE: "I circumflex", 0xCF: "I diaeresis", 0xD1: "N tilde",
    0xD2: "O grave", 0xD3: "O acute", 0xD4: "O circumflex", 0xD5: "O tilde", 0xD6: "O diaeresis",
    0xD9: "U grave", 0xDA: "U acute", 0xDB: "U circumflex", 0xDC: "U diaeresis", 0xDD: "Y acute",
    0xE0: "a grave", 0xE1: "a acute", 0xE2: "a circumflex", 0xE3: "a tilde", 0xE4: "a diaeresis",
    0xE5: "a ring",
    0xE8: "e grave", 0xE9: "e acute", 0xEA: "e circumflex", 0xEB: "e diaeresis",
    0xEC: "i grave", 0xED: "i acute", 0xEE: "i circumflex", 0xEF: "i diaeresis", 0xF1: "n tilde",
    0xF2: "o grave", 0xF3: "o acute", 0xF4: "o circumflex", 0xF5: "o tilde", 0xF6: "o diaeresis",
    0xF9: "u grave", 0xFA: "u acute", 0xFB: "u circumflex", 0xFC: "u diaeresis", 0xFD: "y acute",
    0xFF: "y diaeresis",
}


def without_dot(strokes):
    """A small i whose dot makes room for an accent: what lies above the height of an x goes."""
    return [s for s in strokes if min(y for _, y in s) < 14] or strokes


def add_accents(glyphs):
    for code, text in LETTERS.items():
        letter, accent = text.split()
        width, strokes = glyphs[ord(letter)]
        if letter == "i":
            strokes = without_dot(strokes)
        low_x, high_x, _, high_y = box(strokes)
        top = 24 if letter.isupper() else max(17, min(high_y, 21) + 3)
        glyphs[code] = (width, strokes + moved(ACCENTS[accent], (low_x + high_x) // 2, top))
    for code, letter in ((0xC7, "C"), (0xE7, "c")):
        width, strokes = glyphs[ord(letter)]
        low_x, high_x, _, _ = box(strokes)
        glyphs[code] = (width, strokes + moved(CEDILLA, (low_x + high_x) // 2, 0))
    for code, letter in ((0xD8, "O"), (0xF8, "o")):
        width, strokes = glyphs[ord(letter)]
        low_x, high_x, low_y, high_y = box(strokes)
        glyphs[code] = (width, strokes + [[(low_x, low_y - 1), (high_x, high_y + 1)]])
    for code, mark in ((0xA1, "!"), (0xBF, "?")):
        width, strokes = glyphs[ord(mark)]
        low_x, high_x, low_y, high_y = box(strokes)
        turned = [[(low_x + high_x - x, low_y + high_y - y - 7) for x, y in s] for s in strokes]
        glyphs[code] = (width, turned)
    width, strokes = glyphs[ord("+")]
    glyphs[0xB1] = (width, strokes + [[(4, -2), (width - 4, -2)]])
    width, strokes = glyphs[ord(".")]
    glyphs[0xB7] = (width, moved(strokes, 0, 8))
    glyphs[0xD7] = (22, [[(4, 16), (18, 2)], [(4, 2), (18, 16)]])
    glyphs[0xB0] = (14, [[(7, 21), (5, 20), (4, 18), (5, 16), (7, 15), (9, 16), (10, 18), (9, 20), (7, 21)]])


def joined(strokes):
    """The same lines with fewer and shorter pen-up travels: strokes that meet are drawn in one go."""
    left = [list(s) for s in strokes]
    chains = []
    while left:
        chain = left.pop(0)
        grown = True
        while grown:
            grown = False
            for i, s in enumerate(left):
                if s[0] == chain[-1]:
                    chain = chain + s[1:]
                elif s[-1] == chain[-1]:
                    chain = chain + s[-2::-1]
                elif s[-1] == chain[0]:
                    chain = s + chain[1:]
                elif s[0] == chain[0]:
                    chain = s[:0:-1] + chain
                else:
                    continue
                left.pop(i)
                grown = True
                break
        chains.append(chain)
    ordered, pen = [], (0, 0)
    while chains:
        def travel(c):
            return min((c[0][0] - pen[0]) ** 2 + (c[0][1] - pen[1]) ** 2,
                       (c[-1][0] - pen[0]) ** 2 + (c[-1][1] - pen[1]) ** 2)
        chain = min(chains, key=travel)
        chains.remove(chain)
        begin = (chain[0][0] - pen[0]) ** 2 + (chain[0][1] - pen[1]) ** 2
        end = (chain[-1][0] - pen[0]) ** 2 + (chain[-1][1] - pen[1]) ** 2
        ordered.append(chain if begin <= end else chain[::-1])
        pen = ordered[-1][-1]
    return ordered


def glyphs_of(font, folder):
    number, file, _ = font
    glyphs = read_jhf(f"{folder}/{file}.jhf")
    if file == "futural":
        lower_punctuation(glyphs, ".,:;", 16)
        single_brackets(glyphs)
    if file == "futuram":
        doubled_signs(glyphs, read_jhf(f"{folder}/futural.jhf"))
    if file == "timesr":
        lower_punctuation(glyphs, ".,:", 18)
    glyphs[32] = (SPACE, [])
    add_accents(glyphs)
    if number == 6:
        glyphs = {c: (w, joined(s)) for c, (w, s) in glyphs.items()}
    return glyphs


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/hershey-fonts"
    print("# The Hershey Fonts were originally created by Dr. A. V. Hershey while working at the U. S.")
    print("# National Bureau of Standards. Made by make_fonts.py, see there and NOTICE.")
    for font in FONTS:
        print(f"font {font[0]} {font[2]}")
        for code, (width, strokes) in sorted(glyphs_of(font, folder).items()):
            print(f"{code:x} {width} " + "|".join(" ".join(f"{x},{y}" for x, y in s) for s in strokes))


if __name__ == "__main__":
    main()
