"""SVG drawings: kerf outline and kerf cut. Expectations are computed by hand from the SVG specification."""

import math

import pytest

# Lines without a stroke are not drawn.
STROKE = 'stroke="#000" fill="none"'
HEAD = '<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" '
PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50">\n'


def svg(body, page=PAGE):
    return HEAD + page + body + "\n</svg>\n"


@pytest.fixture
def outlines(kerf, program):
    """The outlines of an SVG as (layer, points, closed), after `kerf outline --json`."""

    def run(text, *options):
        done = kerf("outline", program(text, "art.svg"), "--json", *options)
        assert done.status == 0, done.err + done.out
        return done.json["outlines"]

    return run


def ends(outline):
    return [tuple(round(v, 6) for v in outline["first"]["at"])] + [
        tuple(round(v, 6) for v in segment["to"]) for segment in outline["segments"]
    ]


def same_ring(found, wanted):
    """Closed rings with the same points from any start, in the same direction."""
    found, wanted = found[:-1] if found[0] == found[-1] else found, list(wanted)
    turned = [found[k:] + found[:k] for k in range(len(found))]
    return any(ring == wanted for ring in turned)


def test_y_points_up_from_the_lower_edge_of_the_page(outlines):
    (rect,) = outlines(svg('<rect x="10" y="5" width="30" height="20"/>'))
    assert rect["closed"] and rect["layer"] == "#000000"
    assert same_ring(ends(rect), [(10, 45), (40, 45), (40, 25), (10, 25)])


@pytest.mark.parametrize("page, scale", [
    ('width="4in" height="2in" viewBox="0 0 100 50">', 101.6 / 100),
    ('width="100mm" viewBox="0 0 100 50">', 1.0),
    ('height="10cm" viewBox="0 0 100 50">', 2.0),
    ('width="72pt" height="36pt">', 25.4 / 96),  # no viewBox: user units are pixels
    ('width="400Q" height="200Q" viewBox="0 0 1000 500">', 0.1),
])
def test_the_page_gives_true_units(outlines, page, scale):
    (line,) = outlines(svg('<line x1="0" y1="0" x2="30" y2="0" stroke="#000"/>', page))
    (x1, y1), (x2, y2) = ends(line)
    assert math.isclose(abs(x2 - x1), 30 * scale, abs_tol=1e-6) and y1 == y2


@pytest.mark.parametrize("unit, scale", [("mm", 1), ("inch", 25.4), ("px", 25.4 / 96), ("pt", 25.4 / 72)])
@pytest.mark.parametrize("page", [
    'width="100" height="50">', 'viewBox="0 0 100 50">', 'width="100px" height="50px">'])
def test_a_missing_unit_must_be_given(kerf, program, outlines, page, unit, scale):
    text = svg('<line x1="0" y1="50" x2="30" y2="50" stroke="#000"/>', page)
    refused = kerf("outline", program(text, "art.svg"), "--json")
    assert refused.status == 1 and refused.codes() == ["drawing_unit"] and "px" in refused.out
    (line,) = outlines(text, "--unit", unit)
    assert ends(line) == [(0, 0), (round(30 * scale, 6), 0)]


PATHS = [
    # relative, implicit lines, and numbers without separators
    ("m10,10 20,0 0-10z", [(10, 40), (30, 40), (30, 50)]),
    ("M10 10H30V0Z", [(10, 40), (30, 40), (30, 50)]),
    ("M10 10h2e1v-10.0L1.e1,10", [(10, 40), (30, 40), (30, 50)]),
    ("M0 0L10 .5.5.5z", [(0, 50), (10, 49.5), (0.5, 49.5)]),
]


@pytest.mark.parametrize("data, ring", PATHS)
def test_path_data(outlines, data, ring):
    (path,) = outlines(svg(f'<path d="{data}"/>'))
    assert path["closed"] and same_ring(ends(path), ring)


def test_subpaths_that_touch_are_not_joined(outlines):
    made = outlines(svg('<path d="M0 0h10v10h-10zm10 10h10v10h-10z M30 0L40 0 M40 0L50 0"/>'))
    assert sorted((o["closed"], len(o["segments"])) for o in made)[-2:] == [(True, 4), (True, 4)]


def test_arcs_of_circles_are_exact(outlines):
    """A half circle of radius 10 above the line from 20,25 to 40,25; flags without separators."""
    (path,) = outlines(svg('<path d="M20 25a10 10 0 0120 0z"/>'))
    assert path["closed"] and math.isclose(path["length_mm"], 20 + 10 * math.pi, abs_tol=1e-9)
    arcs = [s for s in path["segments"] if "via" in s]
    assert [tuple(round(v, 6) for v in s["via"]) for s in arcs] == [(30, 35)]
    # Three quarters of a circle, clockwise on the page.
    (large,) = outlines(svg(f'<path {STROKE} d="M30 15A10 10 0 1 1 20 25"/>'))
    assert math.isclose(large["length_mm"], 15 * math.pi, abs_tol=1e-9)


def test_a_circle_stays_a_circle_and_an_ellipse_is_fitted(outlines):
    made = outlines(svg('<circle cx="20" cy="20" r="5" transform="rotate(30) translate(1 2) scale(2)"/>'))
    assert math.isclose(made[0]["circle"]["radius"], 10, abs_tol=1e-9)
    x, y = 20 * 2 + 1, 20 * 2 + 2
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    assert made[0]["circle"]["at"] == pytest.approx([c * x - s * y, 50 - (s * x + c * y)])
    (ellipse,) = outlines(svg('<ellipse cx="50" cy="25" rx="30" ry="10"/>'), "--tolerance", "0.001")
    assert ellipse["closed"]
    assert math.isclose(ellipse["length_mm"], 133.6489, abs_tol=0.01)  # 4 a E(e), e = sqrt(8) / 3
    for x, y in ends(ellipse):
        assert math.isclose(((x - 50) / 30) ** 2 + ((y - 25) / 10) ** 2, 1, abs_tol=2e-4)


def test_curves_of_one_path_are_one_outline(outlines):
    """Two cubic arches and a line; the smooth command mirrors the control point."""
    (path,) = outlines(svg('<path d="M0 25C0 15 20 15 20 25S40 35 40 25Q40 45 0 45z"/>'))
    assert path["closed"]
    xs = [x for x, _ in ends(path)]
    ys = [y for _, y in ends(path)]
    assert min(xs) == 0 and max(xs) <= 40.01 and max(ys) <= 32.51
    # the cubics' extremes: 25 - 0.75 * 10 above and below, seen with y up
    assert any(abs(y - 32.5) < 0.3 for y in ys)


def test_rounded_rectangles(outlines):
    (rect,) = outlines(svg('<rect x="10" y="10" width="40" height="20" rx="5"/>'))
    assert rect["closed"] and math.isclose(rect["length_mm"], 120 - 40 + 10 * math.pi, abs_tol=1e-9)
    (stadium,) = outlines(svg('<rect x="10" y="10" width="40" height="20" rx="50" ry="50"/>'))
    assert stadium["closed"]


def test_polygons_lines_and_groups_with_transforms(outlines):
    text = svg(
        '<g transform="translate(10,10) scale(2 1)"><polygon points="0,0 10,0 10,10"/></g>'
        f'<polyline {STROKE} points="60 10 70 10,70 20" transform="matrix(1 0 0 1 5 0)"/>'
    )
    ring, line = outlines(text)
    assert same_ring(ends(ring), [(10, 40), (30, 40), (30, 30)])
    assert not line["closed"] and ends(line) == [(65, 40), (75, 40), (75, 30)]


def test_layers_are_those_of_inkscape_else_colours(kerf, program, outlines):
    text = svg(
        '<g inkscape:groupmode="layer" inkscape:label="Pocket 3mm" id="layer1">'
        '<g><rect width="9" height="9"/></g></g>'
        '<rect x="20" width="9" height="9" style="fill:none;stroke:#F00"/>'
        '<rect x="40" width="9" height="9" stroke="rgb(0, 0, 255)" fill="red"/>'
        '<g stroke="green"><rect x="60" width="9" height="9" class="cut"/></g>'
        '<style>.cut { stroke: #0a0; } .not, .hidden { display: none }</style>'
        '<rect x="80" width="9" height="9" class="hidden"/>',
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" ' + PAGE,
    )
    assert [o["layer"] for o in outlines(text)] == ["Pocket 3mm", "#ff0000", "#0000ff", "#00aa00"]
    (one,) = outlines(text, "--layer", "#ff0000")
    assert same_ring(ends(one), [(20, 50), (29, 50), (29, 41), (20, 41)])
    unknown = kerf("outline", "art.svg", "--layer", "Pocket")
    assert unknown.status == 1 and "Pocket 3mm" in unknown.err


def test_use_symbol_and_nested_svg(outlines):
    text = svg(
        '<defs><rect id="r" width="10" height="5"/></defs>'
        '<symbol id="s"><rect width="2" height="2"/></symbol>'
        '<use href="#r" x="10" y="10"/><use xlink:href="#s" transform="translate(50 20)"/>'
        '<svg x="80" y="30" width="20" height="20" viewBox="0 0 10 10"><rect width="5" height="5"/></svg>',
        'xmlns:xlink="http://www.w3.org/1999/xlink" ' + PAGE,
    )
    rings = [ends(o) for o in outlines(text)]
    assert same_ring(rings[0], [(10, 40), (20, 40), (20, 35), (10, 35)])
    assert same_ring(rings[1], [(50, 30), (52, 30), (52, 28), (50, 28)])
    assert same_ring(rings[2], [(80, 20), (90, 20), (90, 10), (80, 10)])


def test_a_region_with_a_hole(kerf, program):
    text = svg('<path fill-rule="evenodd" d="M0 0h20v20h-20z M5 5h10v10h-10z"/>')
    run = kerf("outline", program(text, "art.svg"), "--region", "--json")
    assert run.status == 0 and math.isclose(run.json["region"]["area_mm2"], 300, abs_tol=1e-6)


SQUARES = '<rect width="20" height="20"/><rect x="10" y="10" width="20" height="20"/>'
SHAPES = [  # area of two squares of 20 x 20 that overlap in 10 x 10, and of a ring and its inside
    (SQUARES, {"drawn": 700, "nested": 600}),
    (f'<g {STROKE}><rect width="20" height="20"/><rect x="5" y="5" width="10" height="10"/></g>',
     {"drawn": 300, "nested": 300, "united": 400}),
    ('<path d="M0 0h20v20h-20z M5 5h10v10h-10z"/>', {"drawn": 400, "nested": 300}),  # nonzero by default
    ('<path fill-rule="evenodd" d="M0 0h20v20h-20z M5 5h10v10h-10z"/>', {"drawn": 300, "united": 300}),
    ('<path stroke="red" d="M0 0h20v20h-20"/>', {"drawn": 400}),  # its fill is closed, its stroke is not
]


@pytest.mark.parametrize("body, areas", SHAPES)
def test_the_area_is_that_of_the_fills(kerf, program, body, areas):
    for how, area in areas.items():
        run = kerf("outline", program(svg(body), "art.svg"), "--region", "--combine", how, "--json")
        assert run.status == 0 and math.isclose(run.json["region"]["area_mm2"], area, abs_tol=1e-6), how


STROKES = [  # the area of a stroke of 2 mm, by its definition
    ('<path d="M10 10H30"/>', 20 * 2),
    ('<path stroke-linecap="square" d="M10 10H30"/>', 22 * 2),
    ('<path stroke-linecap="round" d="M10 10H30"/>', 40 + math.pi),
    ('<path d="M10 10H30V20"/>', 20 * 2 + 10 * 2),
    ('<path stroke-linejoin="bevel" d="M10 10H30V20"/>', 60 - 0.5),
    ('<path stroke-linejoin="round" d="M10 10H30V20"/>', 60 - 1 + math.pi / 4),
    ('<path stroke-miterlimit="1" d="M10 10H30V20"/>', 60 - 0.5),
    ('<rect x="10" y="10" width="20" height="10"/>', 22 * 12 - 18 * 8),
    ('<rect x="10" y="10" width="20" height="10" fill="red"/>', 22 * 12),
    ('<circle cx="20" cy="20" r="5"/>', math.pi * (36 - 16)),
    ('<circle cx="20" cy="20" r="0.5"/>', math.pi * 1.5 ** 2),
    ('<g transform="scale(2)"><path d="M10 10H20"/></g>', 20 * 4),
    ('<path d="M10 10H30M20 5V15"/>', 20 * 2 + 10 * 2 - 4),
]


@pytest.mark.parametrize("body, area", STROKES)
def test_strokes_as_areas(kerf, program, body, area):
    art = program(svg(f'<g stroke="#000" stroke-width="2" fill="none">{body}</g>'), "art.svg")
    run = kerf("outline", art, "--strokes", "areas", "--region", "--json")
    assert run.status == 0 and run.json["region"]["area_mm2"] == pytest.approx(area, abs=1e-6), run.out
    assert all(o["closed"] for o in run.json["outlines"])


def test_a_job_combines_shapes_as_the_drawing_does(kerf, program, tmp_path):
    """The pocket of two overlapping squares has no island; as nested outlines they leave their overlap."""
    art = program(svg(SQUARES), "art.svg")
    how = ("--op", "pocket", "--tool", "square d=2", "--depth", "1", "--feed", "600", "--rpm", "9000")
    removed = {}
    for combine in ("drawn", "nested"):
        assert kerf("cut", art, *how, "--combine", combine, "--layers", "black", "-o", "part.nc").status == 0
        run = kerf("simulate", "--json", "--tool", "1=square d=2", "--resolution", "0.1", "part.nc")
        removed[combine] = run.json["removed_mm3"]
    corners = (1 - math.pi / 4) * 1.0  # of a corner that the tool's radius of 1 mm does not reach
    assert removed["drawn"] == pytest.approx(700 - 6 * corners, abs=2)
    assert removed["nested"] < 600


def test_texts_and_images_are_reported(kerf, program):
    text = svg('<text>a</text><image/><rect width="5" height="5"/>')
    run = kerf("outline", program(text, "a.svg"), "--json")
    assert run.status == 0 and "drawing_ignored" in run.codes() and "1 text" in run.out


@pytest.mark.parametrize("body, code, line, words", [
    ('<rect width="1o" height="5"/>', "svg_value", 3, 'rect: width="1o"'),
    ('\n<path d="M0 0L10 10 20"/>', "svg_value", 4, "character 14"),
    ('<path d="L0 0"/>', "svg_value", 3, "character 1"),
    ('<path d="M0 0X"/>', "svg_value", 3, "character 5"),
    ('<polygon points="0 0 1"/>', "svg_value", 3, "points"),
    ('<g transform="turn(3)"/>', "svg_value", 3, "transform"),
    ('<g fill="greenish"/>', "svg_value", 3, "greenish"),
    ('<use href="#none"/>', "svg_reference", 3, "#none"),
    ('<use href="other.svg#a"/>', "svg_reference", 3, "another file"),
    ('<g clip-path="url(#c)"/>', "svg_ignored", 3, "clip-path"),
    ('<style>rect:has(a) { fill: red }</style>', "svg_ignored", None, "rect:has(a)"),
])
def test_what_is_invalid_is_a_warning_with_its_line(kerf, program, body, code, line, words):
    run = kerf("outline", program(svg(body + '<rect width="3" height="3"/>'), "art.svg"), "--json")
    assert run.status == 0 and len(run.json["outlines"]) == 1, run.out
    found = next(d for d in run.json["diagnostics"] if d["name"] == code)
    assert found["severity"] == "warning" and words in found["message"]
    assert line is None or found["origin"]["line"] == line


def test_xml_that_is_not_well_formed_is_refused(kerf, program):
    run = kerf("outline", program(svg('<g><rect width="5" height="5">'), "art.svg"), "--json")
    assert run.status == 1 and run.codes() == ["svg_xml"] and "mismatched" in run.out


def test_elements_that_use_themselves_are_left_out(kerf, program):
    loop = svg('<g id="a"><use href="#a"/><use href="#b"/></g>'
               '<g id="b"><use href="#a"/><rect width="9" height="9"/></g>')
    run = kerf("outline", program(loop, "art.svg"), "--json")
    assert run.status == 0 and "svg_reference" in run.codes() and len(run.json["outlines"]) == 1
    uses = [f'<use href="#g{i}"/>' for i in range(40)]
    doubled = "".join(f'<g id="g{i}">{2 * uses[i - 1]}</g>' for i in range(1, 40))
    many = svg(f'<defs><rect id="g0" width="1" height="1"/>{doubled}</defs><use href="#g39"/>')
    refused = kerf("outline", program(many, "many.svg"), "--json")
    assert refused.status == 1 and "svg_limit" in refused.codes()
    deep = svg("<g>" * 500 + "</g>" * 500)
    assert kerf("outline", program(deep, "deep.svg")).status == 1
    other = program('<?xml version="1.0"?>\n<html><svg/></html>', "page.svg")
    assert kerf("outline", other).status == 1


COLOURS = ["black", "#000", "#000000", "rgb(0,0,0)", "rgb(0%,0%,0%)", "#000000ff", "Black", "rgba(0,0,0,1)",
           "rgb(0 0 0 / 100%)", "hsl(120, 100%, 0%)", "currentColor", "light-dark(rgb(0, 0, 0), #fff)"]


def test_a_colour_is_one_layer_in_all_its_forms(outlines):
    rects = "".join(f'<rect x="{8 * i}" width="5" height="5" fill="none" stroke="{colour}"/>'
                    for i, colour in enumerate(COLOURS))
    assert {o["layer"] for o in outlines(svg(rects))} == {"#000000"}
    text = svg('<rect width="5" height="5" fill="hsl(240 100% 50%)"/>'
               '<rect x="9" width="5" height="5" fill="tomato"/>')
    for name in ("blue", "#00f", "rgb(0, 0, 100%)"):
        assert [o["layer"] for o in outlines(text, "--layer", name)] == ["#0000ff"]
    assert [o["layer"] for o in outlines(text)] == ["#0000ff", "#ff6347"]


# Right edge and lower edge of a 200 x 200 viewBox in a page of 200 mm x 100 mm, from SVG 2, section 8.6.
ASPECTS = [("xMinYMin meet", 0, 100), ("xMidYMid", 50, 150), ("xMaxYMax", 100, 200), ("none", 0, 200)]


@pytest.mark.parametrize("aspect, left, right", ASPECTS)
def test_preserve_aspect_ratio(outlines, aspect, left, right):
    page = f'width="200mm" height="100mm" viewBox="0 0 200 200" preserveAspectRatio="{aspect}">'
    (rect,) = outlines(svg('<rect width="200" height="200"/>', page))
    assert {x for x, _ in ends(rect)} == {left, right} and {y for _, y in ends(rect)} == {0, 100}


def test_relative_lengths(outlines):
    text = svg('<rect x="10%" y="20%" width="50%" height="50%"/>'
               '<g font-size="2"><rect x="1em" y="1rem" width="3em" height="2"/></g>'
               '<svg x="50" width="50%" height="50" viewBox="0 0 10 10"><rect width="100%" height="5"/>'
               '</svg>')
    a, b, c = [ends(o) for o in outlines(text)]
    assert same_ring(a, [(10, 40), (60, 40), (60, 15), (10, 15)])
    assert same_ring(b, [(2, 34), (8, 34), (8, 32), (2, 32)])
    assert same_ring(c, [(50, 50), (100, 50), (100, 25), (50, 25)])


def test_style_sheets(outlines):
    """Each rectangle is where the rules put it; a rule of a lower rank would put it elsewhere."""
    text = svg("""<style>/* .a { x: 90px } */
      rect { x: 1px; width: 2px; height: 2px } .a { x: 10px } .a.b { x: 20px } .a { x: 11px } #i { x: 30px }
      g > rect[y='5'] { x: 40px !important } @media print { rect { x: 99px } }
      @media screen { .s { x: 50px } }
      rect + .next, rect:first-child.f { x: 60px }</style>
      <rect/><path/><rect class="a"/><path/><rect class="a b"/><path/><rect class="a b" id="i"/>
      <g><rect y="5" style="x: 98px"/></g><path/><rect class="s"/><rect class="next"/>
      <g><rect class="f" y="9"/></g>""")
    assert [min(x for x, _ in ends(o)) for o in outlines(text)] == [1, 11, 20, 30, 40, 50, 60, 60]


def test_what_is_not_painted_is_not_drawn(outlines):
    hidden = ['fill="none"', 'fill="none" stroke="red" stroke-width="0"', 'opacity="0"', 'fill-opacity="0"',
              'fill="transparent"', 'fill="url(#no)"', 'visibility="hidden"', 'style="display:none"',
              'transform="scale(0)"', 'systemLanguage="is"', 'requiredExtensions="x"']
    rects = "".join(f'<rect width="5" height="5" {how}/>' for how in hidden)
    choice = ('<switch><rect systemLanguage="is" width="4" height="4"/><rect width="6" height="6"/>'
              '<rect width="7" height="7"/></switch>')
    (shown,) = outlines(svg(rects + choice + "<unknown><rect width='8' height='8'/></unknown>"))
    assert same_ring(ends(shown), [(0, 50), (6, 50), (6, 44), (0, 44)])


def test_fills_close_their_subpaths_and_strokes_do_not(outlines):
    (fill,) = outlines(svg('<path d="M0 0H10V10"/><path d="M0 30H20"/>'))  # a line has no area
    assert fill["closed"] and same_ring(ends(fill), [(0, 50), (10, 50), (10, 40)])
    (stroke,) = outlines(svg(f'<path {STROKE} d="M0 0H10V10"/>'))
    assert not stroke["closed"]


def test_an_svg_is_cut_like_a_dxf(kerf, program):
    """The same rectangle as SVG and as DXF gives the same program."""
    art = program(svg('<rect x="10" y="10" width="40" height="20"/>'), "art.svg")
    drawn = kerf("outline", art, "--dxf", "art.dxf")
    assert drawn.status == 0, drawn.err
    how = ("--op", "pocket", "--tool", "square d=6", "--depth", "3", "--feed", "600", "--json")
    programs = []
    for file, extra in ((art, ()), ("art.dxf", ("--unit", "mm"))):
        run = kerf("cut", file, *how, *extra, "-o", "part.nc")
        assert run.status == 0, run.out + run.err
        info = kerf("info", "part.nc", "--json").json["motion"]
        programs.append((info["cut_bounds_mm"], round(info["cut_mm"], 3)))
    assert programs[0] == programs[1]
    (low, high), _ = programs[0]
    assert low[:2] == pytest.approx([13, 23]) and high[:2] == pytest.approx([47, 37])


CLIP = ('<clipPath id="c"><rect x="5" y="5" width="10" height="30"/></clipPath>'
        '<g clip-path="url(#c)"><rect width="20" height="20"/><path stroke="red" fill="none" d="M0 30H40"/>'
        '<rect x="6" y="6" width="2" height="2"/></g>')


@pytest.mark.parametrize("fill", ['fill="none"', "", 'fill="red"'])
def test_clips_cut_areas_and_lines(kerf, program, fill):
    """The square loses what is outside of 5..15 x 5..35, the line its ends; the small square is inside. A
    straight line has no area, whatever its fill is."""
    run = kerf("outline", program(svg(CLIP.replace('fill="none"', fill)), "art.svg"), "--json")
    first, small, cut = sorted(run.json["outlines"], key=lambda o: (o["layer"], -o["length_mm"]))
    assert same_ring(ends(first), [(5, 45), (5, 30), (15, 30), (15, 45)])
    assert same_ring(ends(small), [(6, 44), (8, 44), (8, 42), (6, 42)])
    assert sorted(ends(cut)) == [(5, 20), (15, 20)] and cut["layer"] == "#ff0000"
    notes = [d for d in run.json["diagnostics"] if d["name"] == "svg_clip"]
    assert [d["severity"] for d in notes] == ["note"] * 2
    assert "clip-path url(#c) clips 1 element" in notes[0]["message"]
    assert notes[0]["origin"]["line"] == 3 and notes[0]["origin"]["column"] == 71
    assert "clips hide 2 outlines" in notes[1]["message"]


def test_the_edge_of_a_viewport_clips(kerf, program):
    body = '<svg x="10" y="10" width="20" height="20"><rect x="-5" y="5" width="50" height="5"/></svg>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json")
    (rect,) = run.json["outlines"]
    assert same_ring(ends(rect), [(10, 35), (10, 30), (30, 30), (30, 35)]) and "svg_clip" in run.codes()
    shown = svg(body.replace("<svg ", '<svg overflow="visible" '))
    line = '<svg width="20" height="20"><polyline stroke="red" points="-5,8 30,8"/></svg>'
    (cut,) = kerf("outline", program(svg(line), "line.svg"), "--json").json["outlines"]
    assert sorted(ends(cut)) == [(0, 42), (20, 42)]
    for text, options in ((shown, ()), (svg(body), ("--no-clips",))):
        (rect,) = kerf("outline", program(text, "art.svg"), "--json", *options).json["outlines"]
        assert same_ring(ends(rect), [(5, 35), (55, 35), (55, 30), (5, 30)])


@pytest.mark.parametrize("clip, words", [
    ('<clipPath id="c"><text>a</text></clipPath>', "url(#c)"),
    ('<clipPath id="c" display="none"><rect width="1" height="1"/></clipPath>', "url(#c)"),  # as Chromium
    ('<mask id="c"/>', "url(#c)"),
])
def test_clips_that_are_not_read_are_named(kerf, program, clip, words):
    body = f'{clip}<rect width="5" height="5" clip-path="url(#c)" mask="url(#m)" marker-end="url(#e)"/>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json")
    named = [d["message"] for d in run.json["diagnostics"] if d["name"] == "svg_ignored"]
    assert run.status == 0 and len(run.json["outlines"]) == 1
    assert [m.split(" of ")[0] for m in named] == [f"clip-path {words}", "marker-end url(#e)", "mask url(#m)"]


def test_clips_that_refer_to_themselves(kerf, program):
    loop = ('<clipPath id="a" clip-path="url(#b)"><rect width="9" height="9" clip-path="url(#a)"/></clipPath>'
            '<clipPath id="b"><rect width="9" height="9" clip-path="url(#a)"/></clipPath>'
            '<rect width="5" height="5" clip-path="url(#a)"/>')
    run = kerf("outline", program(svg(loop), "art.svg"), "--json")
    assert run.status == 0 and len(run.json["outlines"]) == 1


def messages(run, name):
    return [d["message"] for d in run.json["diagnostics"] if d["name"] == name]


@pytest.mark.parametrize("data, words", [
    ("M0 0L10 10 20", 'they end where a number was expected'),
    ("M0 0L10 10 x", 'a command was expected, found "x"'),
    ("10 10L20 20", 'the command M or m was expected, found "10 10L20 20"'),
    ("M0 0L10 ?", 'a number was expected, found "?"'),
    ("M0 0A5 5 0 2 1 9 9", 'a flag, 0 or 1, was expected, found "2 1 9 9"'),
])
def test_path_data_that_is_invalid_names_what_was_expected(kerf, program, data, words):
    body = f'<path d="{data}"/><rect width="3" height="3"/>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json")
    assert words in messages(run, "svg_value")[0]


def test_a_pattern_is_named_where_the_whole_shape_is_used(kerf, program):
    pattern = '<pattern id="dots" width="9" height="9"><rect width="3" height="3"/></pattern>'
    body = f'{pattern}\n<rect width="5" height="5" fill="url(#dots)"/>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json")
    assert run.status == 0 and len(run.json["outlines"]) == 1
    (found,) = [d for d in run.json["diagnostics"] if d["name"] == "svg_ignored"]
    assert found["message"] == ("fill url(#dots) of 1 element is a pattern, which is not drawn: "
                                "the whole fill is used")
    assert found["origin"]["line"] == 4


def test_a_transform_out_of_the_page_is_one_warning(kerf, program):
    tilted = '<rect width="5" height="9" style="transform: rotateX(60deg)"/>'
    run = kerf("outline", program(svg("\n" + tilted + tilted), "art.svg"), "--json")
    (message,) = messages(run, "svg_value")
    assert "out of the page" in message and run.json["diagnostics"][0]["origin"]["line"] == 4
    ys = [y for _, y in ends(run.json["outlines"][0])]
    assert max(ys) - min(ys) == pytest.approx(4.5)  # 9 cos 60


def test_strokes_that_do_not_scale_have_their_width_on_the_page(outlines):
    """SVG 2, 8.13: non-scaling-stroke; the width is in pixels of the page. 10 px are 2.6458 mm."""
    line = '<path transform="scale(3 0.5)" d="M10 50h10" stroke="red" stroke-width="10" fill="none" {}/>'
    (area,) = outlines(svg(line.format('vector-effect="non-scaling-stroke"')), "--strokes", "areas")
    assert same_ring([(round(x, 3), round(y, 3)) for x, y in ends(area)],
                     [(30, 23.677), (60, 23.677), (60, 26.323), (30, 26.323)])
    (scaled,) = outlines(svg(line.format("")), "--strokes", "areas")
    assert same_ring([(round(x, 3), round(y, 3)) for x, y in ends(scaled)],
                     [(30, 22.5), (60, 22.5), (60, 27.5), (30, 27.5)])


def test_dashes_and_dots_are_named_where_strokes_are_lines(kerf, program):
    style = 'stroke="red" fill="none" stroke-linecap="round"'
    body = f'<path {style} stroke-dasharray="3 1" d="M0 0h10"/><path {style} d="M20 20z M30 20z"/>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json")
    assert len(run.json["outlines"]) == 1
    assert [m.split(",")[0] for m in messages(run, "drawing_ignored")] == [
        "the gaps of 1 dashed stroke are not left out",
        "2 dots of strokes that have no length are no outline"]
    areas = kerf("outline", program(svg(body), "art.svg"), "--json", "--strokes", "areas")
    assert len(areas.json["outlines"]) == 5 and not messages(areas, "drawing_ignored")


def test_a_stroke_of_too_many_dashes_is_drawn_whole(kerf, program):
    body = '<path stroke="red" stroke-dasharray="1e-7" d="M0 10h90"/>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json", "--strokes", "areas")
    assert len(run.json["outlines"]) == 1 and "too many dashes" in messages(run, "drawing_ignored")[0]


def test_custom_properties_that_grow_without_end_are_left_out(kerf, program):
    """Each is twice the one before: 2^60 characters."""
    rules = "--v0: 1px;" + "".join(f"--v{i}: var(--v{i - 1}) var(--v{i - 1});" for i in range(1, 60))
    rules = f":root {{ {rules} }} rect {{ stroke-width: var(--v59) }}"
    body = f'<style>{rules}</style><rect width="5" height="5"/>'
    run = kerf("outline", program(svg(body), "art.svg"), "--json")
    assert run.status == 0 and len(run.json["outlines"]) == 1


def test_a_unit_of_a_font_names_what_is_assumed(kerf, program):
    run = kerf("outline", program(svg('<rect width="2ex" height="5"/>'), "art.svg"), "--json")
    assert messages(run, "svg_value") == ['rect: width="2ex" depends on the font; 1ex is assumed to be 8 px']


def test_boxes_and_clips_of_long_chains_are_limited(kerf, program):
    """Each group has the box of the next one, each clip contains a clipped group."""
    box = 'style="rotate: 1deg; transform-box: fill-box"'
    chain = "".join(f'<g id="g{i}" {box}><use href="#g{i + 1}"/></g>' for i in range(20_000))
    groups = f'<defs>{chain}<rect id="g20000"/></defs><use href="#g0"/>'
    refused = kerf("outline", program(svg(groups), "a.svg"))
    assert refused.status == 1 and "nested more than" in refused.err + refused.out
    inner = 100 * "<g>" + '<rect width="9" height="9" clip-path="url(#c{})"/>' + 100 * "</g>"
    clips = "".join(f'<clipPath id="c{i}">{inner.format(i + 1)}</clipPath>' for i in range(400))
    run = kerf("outline", program(svg(clips + '<rect width="5" height="5" clip-path="url(#c0)"/>'), "b.svg"))
    assert run.status == 1 and "nested more than" in run.err + run.out
    doubled = "".join(f'<g id="h{i}" {box}>{2 * f"""<use href="#h{i + 1}"/>"""}</g>' for i in range(40))
    many = svg(f'<defs>{doubled}<rect id="h40" width="1" height="1"/></defs><use href="#h0"/>')
    assert kerf("outline", program(many, "c.svg")).status == 1
