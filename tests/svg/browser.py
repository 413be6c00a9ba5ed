"""SVG files as Chromium draws them, against the outlines of `kerf outline`, in one browser process.

    KERF=build/kerf python3 tests/svg/browser.py FOLDER [-v]

Points of each shape that the browser shows must lie on Kerf's outlines, and points of Kerf's outlines on a
stroke or on the edge of a fill of the browser. `use` is replaced by what it refers to, since its shadow tree
is closed to scripts; the browser's own box of the `use` must stay the same. Texts and
clips are left out here; pictures.py compares them.
"""
import http.server
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

WITHIN = 1e-3  # px
ARC = 5e-4  # of its radius: the browser draws arcs of paths as cubic curves
PX = 25.4 / 96  # mm
PAGE = Path(__file__).with_name("browser.html")


def browser():
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


# ------------------------------------------------------------------------------------------------ Kerf's side


def circle_through(a, v, b):
    """Centre, start angle and signed sweep of the arc from a over v to b."""
    d = 2 * (a[0] * (v[1] - b[1]) + v[0] * (b[1] - a[1]) + b[0] * (a[1] - v[1]))
    if d == 0:
        return None
    squares = [p[0] ** 2 + p[1] ** 2 for p in (a, v, b)]
    x = (squares[0] * (v[1] - b[1]) + squares[1] * (b[1] - a[1]) + squares[2] * (a[1] - v[1])) / d
    y = (squares[0] * (b[0] - v[0]) + squares[1] * (a[0] - b[0]) + squares[2] * (v[0] - a[0])) / d
    angle = [math.atan2(p[1] - y, p[0] - x) for p in (a, v, b)]
    turn = 1 if (v[0] - a[0]) * (b[1] - a[1]) - (v[1] - a[1]) * (b[0] - a[0]) > 0 else -1
    sweep = (turn * (angle[2] - angle[0])) % (2 * math.pi)
    return (x, y), angle[0], turn * (sweep or 2 * math.pi)


def segments(outline):
    """Lines (a, b) and arcs (centre, radius, start, sweep), in mm."""
    at = outline["first"]["at"]
    for segment in outline["segments"]:
        to = segment["to"]
        arc = circle_through(at, segment["via"], to) if "via" in segment else None
        if arc:
            centre, start, sweep = arc
            yield "arc", centre, math.dist(centre, at), start, sweep
        else:
            yield "line", at, to
        at = to


def points_on(segment):
    if segment[0] == "line":
        _, a, b = segment
        return [(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])) for t in (0.03, 0.5, 0.72)]
    _, c, r, start, sweep = segment
    return [(c[0] + r * math.cos(start + t * sweep), c[1] + r * math.sin(start + t * sweep))
            for t in (0.04, 0.5, 0.71)]


def distance(segment, p):
    if segment[0] == "line":
        _, a, b = segment
        dx, dy = b[0] - a[0], b[1] - a[1]
        square = dx * dx + dy * dy
        t = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square)) if square else 0.0
        return math.hypot(a[0] + t * dx - p[0], a[1] + t * dy - p[1])
    _, c, r, start, sweep = segment
    x, y = p[0] - c[0], p[1] - c[1]
    angle = (math.atan2(y, x) - start) * (1 if sweep > 0 else -1) % (2 * math.pi)
    if angle <= abs(sweep):
        return abs(math.hypot(x, y) - r)
    ends = (start, start + sweep)
    return min(math.hypot(c[0] + r * math.cos(e) - p[0], c[1] + r * math.sin(e) - p[1]) for e in ends)


def kerf_outlines(file):
    """The segments of a drawing, and what Kerf says of it."""
    command = [os.environ["KERF"], "outline", str(file), "--json", "--tolerance", "0.0001",
               "--texts", "none", "--no-clips"]
    done = subprocess.run(command, capture_output=True, timeout=120)
    reported = json.loads(done.stdout)
    if any(d["name"] == "drawing_unit" for d in reported["diagnostics"]):
        done = subprocess.run([*command, "--unit", "px"], capture_output=True, timeout=120)
        reported = json.loads(done.stdout)
    found = [s for o in reported.get("outlines", []) for s in segments(o)]
    names = [d["name"] for d in reported["diagnostics"] if d["severity"] == "error"]
    return {"segments": found, "status": done.returncode, "errors": names}


# ------------------------------------------------------------------------------------------------ the browser


def frame_size(text):
    """Of the frame in which a page without a size of its own is shown."""
    box = re.search(r"<(?:svg:)?svg\b[^>]*?\bviewBox\s*=\s*[\"']([^\"']*)", text, re.S)
    numbers = re.findall(r"[-+.\deE]+", box.group(1)) if box else []
    return [float(n) for n in numbers[2:4]] if len(numbers) == 4 else [200, 200]


def ask_browser(files, drawn):
    """What the page measures, by file name."""
    cases = [{"name": f.name, "size": frame_size(f.read_text(encoding="utf-8", errors="replace")),
              "points": [p for s in drawn[f.name]["segments"] for p in points_on(s)]} for f in files]
    return run_page(PAGE, files, cases)


def run_page(page, files, cases):
    """What a page of this folder answers on the cases, one for each file."""
    result, done = {}, threading.Event()

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            path = self.path.split("?")[0]
            if path == "/":
                kind, body = "text/html; charset=utf-8", page.read_bytes()
            elif path == "/cases":
                kind, body = "application/json", json.dumps(cases).encode()
            elif re.fullmatch(r"/case/\d+", path):
                kind, body = "image/svg+xml", files[int(path[6:])].read_bytes()
            else:
                self.send_error(404)
                return
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.end_headers()
            self.wfile.write(body)

        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            self.send_response(204)
            self.end_headers()
            result.update(json.loads(body))
            done.set()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            [browser(), "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--lang=en-US", f"--user-data-dir={profile}", f"http://127.0.0.1:{server.server_port}/"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        finished = done.wait(timeout=540)
        process.terminate()
        process.wait(timeout=20)
    server.shutdown()
    if not finished:
        raise TimeoutError("the browser did not answer")
    return result


# ------------------------------------------------------------------------------------------------ both


def difference(seen, drawn):
    """What differs between the browser and Kerf; empty if nothing does."""
    if "error" in seen:
        return "browser: " + seen["error"]
    height = seen["height"]
    worst = {}
    for shape in seen["shapes"]:
        within = WITHIN + (ARC * shape["radius"] if shape["arcs"] else 0.0)
        for x, y in shape["points"]:
            p = (x * PX, (height - y) * PX)
            off = min((distance(s, p) for s in drawn["segments"]), default=math.inf) / PX
            if off > within and off > worst.get(shape["name"], (0,))[0]:
                worst[shape["name"]] = (off, x, y)
    lacks = [f"{name} at {x:.4g}, {y:.4g} is {off:.3g} px off" for name, (off, x, y) in worst.items()]
    extra = [f"nothing at {x:.4g}, {y:.4g}" for x, y in seen["strangers"][:1]]
    refused = ["refused: " + ", ".join(drawn["errors"])] if drawn["status"] and seen["shapes"] else []
    return "; ".join(refused + lacks + extra)


def compare(folder):
    """The differences by file name."""
    files = sorted(Path(folder).glob("*.svg"))
    drawn = {f.name: kerf_outlines(f) for f in files}
    seen = ask_browser(files, drawn)
    return {f.name: difference(seen[f.name], drawn[f.name]) for f in files}


if __name__ == "__main__":
    differences = compare(sys.argv[1])
    wrong = {name: text for name, text in differences.items() if text}
    for name, text in wrong.items():
        print(f"{name}: {text}")
    print(f"{len(differences) - len(wrong)} of {len(differences)} files agree")
    sys.exit(1 if wrong else 0)
