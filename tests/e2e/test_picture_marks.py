"""Axes, sizes and legends over pictures."""
import pytest
from png_pixels import pixels

PART = """G21 G90
T1 M6
M3 S9000
G0 X10 Y10 Z5
G1 Z-2 F300
G1 X70
G0 Z5
T2 M6
M3 S9000
G0 X10 Y30
G1 Z-2 F300
G1 X70
G0 Z5
M2
"""
WIDTH = 400  # pixels
TOOLS = ("--tool", "1=square d=6 flute=10", "--tool", "2=square d=4 flute=10", "--stock", "80x40x10")


@pytest.fixture
def picture(kerf, program, tmp_path):
    """A function from --show and more options to the pixels of the picture."""

    def shown(show, *more):
        out = tmp_path / "p.png"
        done = kerf("simulate", program(PART), *TOOLS, "-o", out, "--size", "400x300", "--show", show, *more)
        assert done.status == 0, done.err
        return [pixel for row in pixels(out.read_bytes())[2] for pixel in row]
    return shown


def near(pixel, colour, within=40):
    return all(abs(a - b) < within for a, b in zip(pixel, colour))


def count(image, colour):
    return sum(near(pixel, colour) for pixel in image)


def test_the_axes_lead_from_the_work_zero(picture):
    """From above: X to the right and Y upwards from the lower left corner of the top, Z not at all."""
    image = picture("part,axes", "--view", "top")
    red, green, blue = (196, 40, 36), (20, 128, 52), (36, 84, 200)
    x = [(i % WIDTH, i // WIDTH) for i, pixel in enumerate(image) if near(pixel, red)]
    y = [(i % WIDTH, i // WIDTH) for i, pixel in enumerate(image) if near(pixel, green)]
    zero = (min(at for at, _ in x), max(at for _, at in y))
    assert max(at for at, _ in x) - zero[0] > 25 and zero[1] - min(at for _, at in y) > 25
    assert abs(min(at for at, _ in y) - zero[0]) < 10 and abs(max(at for _, at in x) - zero[1]) < 10
    unmarked = picture("part", "--view", "top")
    assert count(image, blue) <= count(unmarked, blue) + 1 and count(unmarked, red) == 0


def test_sizes_leave_room_and_are_as_long_as_the_part(picture):
    """80 of 40 mm from above: the sizes have the length and height of the part, to a pixel."""
    image = picture("size", "--view", "top")
    ink = (40, 44, 52)
    rows, columns = {}, {}
    for i, pixel in enumerate(image):
        if near(pixel, ink, 110):
            rows.setdefault(i // WIDTH, []).append(i % WIDTH)
            columns.setdefault(i % WIDTH, []).append(i // WIDTH)
    long_row = max(rows.values(), key=len)
    long_column = max(columns.values(), key=len)
    width, height = max(long_row) - min(long_row), max(long_column) - min(long_column)
    assert width / height == pytest.approx(2, rel=0.02) and width > 150
    assert min(columns) > 0 and max(columns) < 399 and max(rows) < 299


def test_the_legend_names_each_colour_of_the_picture(picture):
    plain, marked = picture("part"), picture("part,legend")
    changed = [i for i, (a, b) in enumerate(zip(plain, marked)) if a != b]
    assert changed and max(i % WIDTH for i in changed) < 150 and min(i // WIDTH for i in changed) > 200
    lower_left = [pixel for i, pixel in enumerate(marked) if i % WIDTH < 150 and i // WIDTH >= 200]
    for colour in ((222, 196, 156), (86, 140, 190), (106, 168, 110)):  # stock, the two tools
        assert count(lower_left, colour) > 20, colour


@pytest.mark.parametrize("show, message", [
    ("axis", "did you mean axes"), ("part,path", "only one of"), ("burn,axes", "not of a burn"),
    ("", "is not one of")])
def test_other_words_are_refused(kerf, program, show, message):
    done = kerf("simulate", program(PART), *TOOLS, "-o", "p.png", "--show", show)
    assert done.status == 2 and message in done.err, done.err
