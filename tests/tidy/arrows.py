"""Dependencies of modules: reads every #include and fails on a wrong arrow or a cycle (see ARCHITECTURE.md).

A new module or public header is added to the two tables below, in the same change as to ARCHITECTURE.md.
"""
import re
import sys

from sources import CPP, files, finish, root_of

GEOMETRY = {"geom", "base"}
PATH = {"path", "tool", "stock"} | GEOMETRY
OP = {"op"} | PATH
CODEC = {"codec_drawing", "codec_font", "codec_gcode", "codec_heights", "codec_mesh", "codec_picture",
         "codec_zip"}
FRONT = {"front_gcode", "front_gcmc", "front_outline", "front_pathdxf", "front_cut", "front_native",
         "front_scad"}
BACK = {"back_drawing", "back_gcode", "back_native", "back_pathdxf"}
BELOW_JOB = OP | CODEC | FRONT | BACK | {"sim", "formats", "design"}


def rooms(module, uses, order):
    """Rows for the rooms of a module, folders inside its folder: each uses what the module uses, and of the
    rooms before it those that `order` names."""
    return {f"{module}_{room}": uses | {f"{module}_{other}" for other in others}
            for room, others in order.items()}


# What each module may include besides itself. There is no cycle, as each line uses only lines above it. A
# module may include its own rooms; permission for a module covers its rooms.
ALLOWED = {
    "base": set(),
    "base_codes": {"base"},  # the tables of diagnostics
    **rooms("geom", {"base"}, {
        "base": [],
        "outline": ["base"],
        "fit": ["outline", "base"],
        "solid": ["outline", "base"],
        "region": ["outline", "base"],
        "offset": ["region", "outline", "base"],
        "medial": ["region", "outline", "base"],
        "text": ["region", "fit", "outline", "base"],
        "shapes": ["offset", "region", "fit", "outline", "base"],
    }),
    "tool": GEOMETRY,
    "stock": GEOMETRY,
    "path": {"tool", "stock"} | GEOMETRY,
    **rooms("op", PATH, {
        "base": [],
        "mill": ["base"],
        "mesh": ["base"],
        "laser": ["base"],
        "print": ["base"],
        "rework": ["base"],
    }),
    "op": PATH,  # the tests of its rooms
    **{codec: {"base"} for codec in CODEC},
    "codec_mesh": {"codec_zip", "base"},  # 3MF is a zip
    "formats": PATH | {"codec_mesh", "codec_zip"},
    **rooms("design", OP | {"codec_drawing", "codec_mesh"}, {  # the machine of gcodepreview
        "call": [],
        "machine": ["call"],
        "commands": ["machine", "call"],
    }),
    **{front: OP | CODEC for front in FRONT},
    **rooms("front_gcode", OP | CODEC, {
        "comments": [],
        "program": ["comments"],
        "run": ["program", "comments"],
    }),
    **rooms("front_gcmc", OP | CODEC, {
        "value": [],
        "text": ["value"],
        "code": ["text", "value"],
        "run": ["code", "text", "value"],
        "out": ["run", "code", "text", "value"],
    }),
    **rooms("front_scad", OP | CODEC | {"design"}, {
        "value": [],
        "commands": ["value"],
        "text": ["value"],
        "run": ["text", "value"],
    }),
    **rooms("front_pathdxf", OP | CODEC, {
        "text": [],
        "model": ["text"],
        "compile": ["model", "text"],
    }),
    **{back: PATH | CODEC for back in BACK},
    **rooms("sim", PATH, {
        "dexel": [],
        "sweep": ["dexel"],
        "kernel": ["sweep", "dexel"],
        "cut": ["kernel", "sweep", "dexel"],
        "mesh": ["dexel"],
        "exact": ["cut", "mesh", "sweep", "dexel"],
        "render": ["mesh", "dexel"],
        "compare": ["render", "exact", "cut", "mesh", "dexel"],
        "burn": ["render"],
        "rotary": ["mesh", "sweep", "dexel"],
        "print": ["mesh", "dexel"],
    }),
    **rooms("job", BELOW_JOB, {"stored": []}),
    "job": BELOW_JOB,
    "job_record": BELOW_JOB | {"job"},
    "app": BELOW_JOB | {"job"},
    **rooms("app", BELOW_JOB | {"job"}, {
        "report": [],
        "shown": ["report"],
        "browser": ["shown", "report"],
        "browser_wasm": ["browser", "shown", "report"],
        "view": ["shown", "report"],
        "lsp": ["report"],
        "options": ["report"],
        "help": ["options", "report"],
        "commands": ["help", "options", "lsp", "view", "shown", "report"],
    }),
    "python": BELOW_JOB | {"job"},
}
OUTSIDE = BELOW_JOB | {"job"}  # benchmarks, fuzz targets and the WebAssembly smoke test
# Public headers (include/kerf) by the module that they belong to.
PUBLIC = {
    "back_drawing": ["drawing/toolpath_drawing.h"],
    "back_gcode": ["program/post.h"],
    "base": ["base/diagnostics.h", "base/files.h", "base/limits.h", "base/origin.h", "base/progress.h",
             "base/tolerance.h", "base/units.h"],
    "codec_drawing": ["drawing/drawing_files.h", "drawing/dxf.h", "drawing/svg.h"],
    "codec_heights": ["formats/measured.h"],
    "codec_mesh": ["formats/mesh_files.h"],
    "formats": ["formats/printer_files.h", "formats/workshop_files.h"],
    "front_cut": ["program/cut_job.h"],
    "front_gcode_comments": ["program/gcode_options.h"],
    "front_gcode_run": ["program/gcode.h"],
    "front_pathdxf_text": ["program/path_drawing.h"],
    "front_outline": ["drawing/drawing_outlines.h", "drawing/outline_files.h"],
    "geom_base": ["geom/geometry.h"],
    "geom_fit": ["geom/fit.h"],
    "geom_offset": ["geom/offset.h"],
    "geom_outline": ["geom/outline.h"],
    "geom_region": ["geom/region.h"],
    "geom_shapes": ["geom/shapes.h"],
    "geom_solid": ["geom/mesh_check.h"],
    "geom_text": ["geom/text.h"],
    "job": ["job/cut_program.h", "job/findings.h", "job/job.h", "job/live_job.h", "job/outputs.h",
            "job/posting.h", "job/program.h", "job/save.h", "kerf.h"],
    "job_stored": ["job/program_file.h"],
    "op_base": ["op/operation.h", "op/rows.h"],
    "op_laser": ["op/laser.h"],
    "op_mesh": ["op/surface.h"],
    "op_mill": ["op/holes.h", "op/mill.h"],
    "op_print": ["op/printer.h"],
    "op_rework": ["op/level.h", "op/rework.h"],
    "path": ["path/check.h", "path/estimate.h", "path/machine.h", "path/passes.h", "path/report.h",
             "path/toolpath.h"],
    "sim_burn": ["sim/burn.h"],
    "sim_compare": ["sim/compare.h"],
    "sim_cut": ["sim/live.h", "sim/simulate.h"],
    "sim_dexel": ["sim/workpiece.h"],
    "sim_exact": ["sim/exact_mesh.h"],
    "sim_mesh": ["sim/mesh.h"],
    "sim_print": ["sim/print.h"],
    "sim_render": ["sim/render.h"],
    "sim_rotary": ["sim/rotary.h"],
    "sim_sweep": ["sim/simulation_options.h"],
    "stock": ["stock/stock.h"],
    "tool": ["tool/material.h", "tool/tool.h"],
}
HEADER_MODULE = {f"include/kerf/{header}": module for module, headers in PUBLIC.items() for header in headers}


def module_of(path):
    """The module of a file of the library, app or python: the names of its folders below src, joined by "_".
    None for files outside of them."""
    parts = path.split("/")
    if path.startswith("include/"):
        return HEADER_MODULE.get(path, "?")
    if parts[0] == "python":
        return "python"
    if parts[0] == "src" and len(parts) > 2:
        return "_".join(parts[1:-1])
    return None


def within(module, modules):
    """Whether a module, or one that it is a room of, is among `modules`."""
    return module in modules or ("_" in module and within(module.rsplit("_", 1)[0], modules))


def allowed_for(path):
    """The modules a file may include, or None if the file or its module is unknown."""
    module = module_of(path)
    if module is not None:
        return ALLOWED[module] | {module} if module in ALLOWED else None
    parts = path.split("/")
    if parts[0] == "tests" and parts[1] == "unit":
        tested = parts[2]
        return ALLOWED[tested] | {tested} if tested in ALLOWED else None
    # The requests of kerf view are checked in the command, outside of the library.
    return OUTSIDE | {"app_view", "app_shown"} if parts[-1] == "view_request.cpp" else OUTSIDE


def resolve(including, name, known):
    """The repository's file that an #include "name" means, or None for a library's header."""
    folder = including.rsplit("/", 1)[0]
    for candidate in (f"{folder}/{name}", f"src/{name}", f"include/{name}", f"python/{name}"):
        if candidate in known:
            return candidate
    return None


def rings(graph):
    """Include cycles, as text."""
    done, found = set(), []

    def visit(node, trail):
        if node in trail:
            found.append("ring of includes: " + " -> ".join(trail[trail.index(node):] + [node]))
            return
        if node in done:
            return
        for after in graph.get(node, []):
            visit(after, trail + [node])
        done.add(node)

    for node in sorted(graph):
        visit(node, [])
    return found


def check(texts):
    """Problems of a repository given as {path: text}."""
    problems, graph = [], {}
    for path, text in sorted(texts.items()):
        if path.endswith(".def"):
            continue
        allowed = allowed_for(path)
        if allowed is None:
            problems.append(f"{path}: unknown module; add it to the tables of tests/tidy/arrows.py")
            continue
        for number, line in enumerate(text.splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*["<]([^">]+)[">]', line)
            if not match:
                continue
            target = resolve(path, match.group(1), texts)
            if target is None:
                if match.group(1).startswith("kerf/"):
                    problems.append(f"{path}:{number}: {match.group(1)} does not exist")
                continue
            graph.setdefault(path, []).append(target)
            module = module_of(target)
            if module is not None and not within(module, allowed):
                problems.append(
                    f"{path}:{number}: wrong arrow: may not include {match.group(1)} of module {module}")
    return problems + rings(graph)


def check_links(texts):
    """Problems of the DEPENDS of kerf_module() in src/**/CMakeLists.txt, given as {path: text}."""
    problems = []
    for path, text in sorted(texts.items()):
        for name, arguments in re.findall(r"kerf_module\((\w+)([^)]*)\)", text):
            depends = re.search(r"DEPENDS\s+((?:(?!LIBRARIES)\w+\s*)*)", arguments)
            linked = set(depends.group(1).split()) if depends else set()
            wrong = {other for other in linked if not within(other, ALLOWED.get(name, set()) | {name})}
            if name not in ALLOWED:
                problems.append(f"{path}: module {name} is not in the tables of tests/tidy/arrows.py")
            for other in sorted(wrong):
                problems.append(f"{path}: wrong arrow: {name} links {other}")
    return problems


def check_table(text):
    """Differences between the public headers in the table of ARCHITECTURE.md, given as text, and those of
    this file. A module belongs to the row whose folder is the longest one above it."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()
            if re.match(r"\| `", line)]
    folders = {folder: number for number, row in enumerate(rows)
               for folder in re.findall(r"`(src/[\w/]+)`", row[0])}
    wanted = {number: set() for number in range(len(rows))}
    problems = []
    for module, headers in PUBLIC.items():
        above = [f for f in folders if f"src/{module.replace('_', '/')}/".startswith(f + "/")]
        if above:
            wanted[folders[max(above, key=len)]] |= set(headers)
        else:
            problems.append(f"ARCHITECTURE.md: no row for the module {module}")
    for number, row in enumerate(rows):
        stated = set(re.findall(r"`([\w/]+\.h)`", row[2])) if len(row) > 2 else set()
        for header in sorted(wanted[number] ^ stated):
            what = "lacks" if header in wanted[number] else "has no"
            problems.append(f"ARCHITECTURE.md: the row of {row[0]} {what} {header}")
    return problems


def main():
    root = root_of(sys.argv)
    folders = ("src/", "include/", "python/", "tests/unit/", "tests/wasm/", "bench/", "fuzz/")
    chosen = [p for p in files(root, CPP | {".def"}) if p.as_posix().startswith(folders)]
    texts = {p.as_posix(): (root / p).read_text(errors="replace") for p in chosen}
    lists = [p for p in files(root, {".txt"}) if p.name == "CMakeLists.txt" and p.parts[0] == "src"]
    links = {p.as_posix(): (root / p).read_text() for p in lists}
    table = check_table((root / "ARCHITECTURE.md").read_text())
    finish("arrows", check(texts) + check_links(links) + table)


if __name__ == "__main__":
    main()
