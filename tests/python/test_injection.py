"""Texts of calls in written programs: whatever characters they have, they stay in comments."""
import re

import kerf
import pytest

TEXTS = ["a\nG1 X99 F1", "a\r\nM104 S999", "a) G1 X99", "a ; G1 X99", "a\x0bM104 S999", "a\x85G1 X99",
         "a\u2028G1 X99", "(((", ")", ";", "\x00M3", "%", "!", "~", "?", "x" * 5000]
POSTS = ["grbl", "linuxcnc", "mach3", "marlin", "klipper", "reprapfirmware", "plain", "prusa", "laser"]


def code_of(text):
    """The words of a program outside of comments."""
    left = []
    for line in re.split("[\r\n\v\f]", text):  # what controllers end lines at, and more
        while 0 <= line.find("(") < (line.find(";") % 10000):  # brackets that are not in a comment
            start, end = line.index("("), line.find(")")
            assert end > start, line
            line = line[:start] + line[end + 1:]
        line = line.split(";")[0]
        left += line.split()
    return left


@pytest.mark.parametrize("post", POSTS)
def test_texts_stay_comments(post, tmp_path):
    def written(text):
        path = kerf.Toolpath()
        path.rapid((0, 0, 5))
        path.note(text)
        path.cut((10, 0, 5), feed=600)
        path.end()
        target = tmp_path / "out.nc"
        kerf.post(path, post, str(target))
        return code_of(target.read_text())

    plain = written("harmless")
    for text in TEXTS:
        assert written(text) == plain, repr(text)
