"""Options of `kerf.load` for what a G-code program leaves open."""
import kerf
import pytest

HEAD = "G21 G90 G17\nT1 M6 (T1 D=6 CR=0 - flat end mill)\nS9000 M3\nG0 X50 Y40\n"


def load(tmp_path, text, **options):
    file = tmp_path / "part.nc"
    file.write_text(HEAD + text + "M30\n")
    return kerf.load(file, **options)


def test_centres_of_arcs(tmp_path):
    text = "G1 X60 Y40 F900\nG3 X70 Y50 I60 J50\n"
    with pytest.warns(UserWarning, match="read as coordinates"):
        detected = load(tmp_path, text)
    stated = load(tmp_path, text, arc_centres="absolute")
    assert [s for s in map(dict, detected.toolpath)][-3]["centre"] == (60, 50)
    assert detected.toolpath == stated.toolpath
    with pytest.raises(kerf.Error, match="from its centre"):
        load(tmp_path, text, arc_centres="offsets")
    with pytest.raises(ValueError, match="'offsets' or 'absolute', not 'near'"):
        load(tmp_path, text, arc_centres="near")


def test_offsets_of_compensation(tmp_path):
    text = "G1 Z-1 F200\nG41 D1 Y60 F600\nX90\nG40 Y90\n"
    ends = [[s["to"][1] for s in map(dict, load(tmp_path, text, comp=comp).toolpath) if s["step"] == "cut"]
            for comp in (None, {1: 0}, {1: 2})]
    assert [e[-2] for e in ends] == [63, 60, 62]
