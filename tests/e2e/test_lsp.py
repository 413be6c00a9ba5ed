"""kerf lsp, driven as an editor drives it: by messages of the Language Server Protocol."""
import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

KERF = os.environ["KERF"]
SOURCE = Path(os.environ.get("KERF_SOURCE_DIR", Path(__file__).parents[2]))
PART = """G21 G90
T1 M6
M3 S9000
o<hole> sub
  G1 Z-1 F100
  G0 Z5
o<hole> endsub
#<deep> = 3
G0 X10 Y10 Z5
o<hole> call
G1 Z[0-#<deep>] F300
X70 F1200
G0 Z5
M2
"""
GCMC = """function hole(at, deep) {
  goto(at);
  move([-, -, -deep]);
  goto([-, -, 5mm]);
}
feedrate(200mm);
/* depth = 1; */
depth = 2mm;
goto([-, -, 5mm]);
hole([10mm, 20mm], depth);
"""


class Editor:
    def __init__(self, folder):
        self.folder = folder
        self.process = subprocess.Popen([KERF, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        cwd=folder)
        self.id, self.notes = 0, []

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def receive(self):
        length = 0
        while line := self.process.stdout.readline().strip():
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        return json.loads(self.process.stdout.read(length)) if length else None

    def ask(self, method, **parameters):
        self.id += 1
        self.send({"id": self.id, "method": method, "params": parameters})
        while (answer := self.receive()).get("id") != self.id:
            self.notes.append(answer)
        return answer

    def note(self, method, **parameters):
        self.send({"method": method, "params": parameters})

    def uri(self, name):
        return (self.folder / name).as_uri()

    def open(self, name, text=None):
        text = (self.folder / name).read_text() if text is None else text
        self.note("textDocument/didOpen", textDocument={
            "uri": self.uri(name), "languageId": "gcode", "version": 1, "text": text})
        return self.diagnostics(name)

    def change(self, name, text, version=2):
        self.note("textDocument/didChange", textDocument={"uri": self.uri(name), "version": version},
                  contentChanges=[{"text": text}])

    def diagnostics(self, name):
        while True:
            note = self.notes.pop(0) if self.notes else self.receive()
            found = note["params"] if note.get("method") == "textDocument/publishDiagnostics" else {}
            if found.get("uri") == self.uri(name):
                return found

    def at(self, method, name, line, character):
        return self.ask(f"textDocument/{method}", textDocument={"uri": self.uri(name)},
                        position={"line": line, "character": character})["result"]

    def close(self):
        self.ask("shutdown")
        self.note("exit")
        return self.process.wait(timeout=20)


@pytest.fixture
def editor(tmp_path):
    started = Editor(tmp_path)
    answer = started.ask("initialize", capabilities={}, rootUri=tmp_path.as_uri(), processId=None)
    assert answer["result"]["capabilities"]["hoverProvider"] is True
    started.note("initialized")
    yield started
    started.process.kill()
    started.process.wait()


def rows(found):
    return [(d["range"]["start"]["line"], d["code"], d["severity"]) for d in found["diagnostics"]]


def test_messages_while_typing(editor):
    """The text in the editor counts, which is not saved; hazards come when it is opened and saved."""
    bad = PART.replace("X70 F1200", "X7O F1200")
    found = editor.open("part.ngc", bad)
    assert any(line == 11 for line, _, _ in rows(found))
    editor.change("part.ngc", PART)
    found = editor.diagnostics("part.ngc")
    assert found["version"] == 2 and not [r for r in rows(found) if r[2] == 1]
    editor.note("textDocument/didSave", textDocument={"uri": editor.uri("part.ngc")})
    assert (4, "unknown_tool", 1) in rows(editor.diagnostics("part.ngc"))  # the first cut
    assert editor.close() == 0


def test_what_a_line_does(editor):
    editor.open("part.ngc", PART)
    text = editor.at("hover", "part.ngc", 11, 1)["contents"]["value"]
    assert "to X70 Y10 Z-3" in text and "60 mm cut at 1200 mm/min" in text and "tool 1" in text
    assert "3 s" in text and "spindle 9000 rpm" in text  # 60 mm at 1200 mm/min
    called = editor.at("hover", "part.ngc", 9, 0)["contents"]["value"]
    assert "2 motions" in called and "at 100 mm/min" in called  # those of the subroutine
    assert editor.at("hover", "part.ngc", 500, 0) is None


def test_definitions_and_the_outline_of_gcode(editor):
    editor.open("part.ngc", PART)
    found = editor.at("definition", "part.ngc", 9, 4)
    assert found["range"]["start"] == {"line": 3, "character": 0}
    found = editor.at("definition", "part.ngc", 10, 9)
    assert found["range"] == {"start": {"line": 7, "character": 0}, "end": {"line": 7, "character": 7}}
    assert editor.at("definition", "part.ngc", 8, 1) is None
    names = [s["name"] for s in editor.ask("textDocument/documentSymbol",
                                           textDocument={"uri": editor.uri("part.ngc")})["result"]]
    assert names == ["tool 1", "O<HOLE>"]
    words = editor.at("completion", "part.ngc", 8, 0)
    assert next(w for w in words if w["label"] == "G83")["detail"] == "drill with pecks: Q"


def test_numbered_subprograms(editor):
    editor.open("part.nc", "%\nO0001\nG21 G90\nT1 M6\nM3 S900\nM98 P0100\nM30\nO100\nG0 X1 Y1 Z5\nM99\n%\n")
    assert editor.at("definition", "part.nc", 5, 7)["range"]["start"]["line"] == 7


def test_gcmc_with_files_that_are_included(editor, tmp_path):
    (tmp_path / "lib.inc.gcmc").write_text('// "\nfunction hole(at, deep) {\n  goto(at);\n}\n')
    editor.open("part.gcmc", 'include("lib.inc.gcmc");\nä = 1mm;\ndepth = 2mm; hole([ä, depth, -], depth);\n')
    found = editor.at("definition", "part.gcmc", 2, 14)
    assert found["uri"] == editor.uri("lib.inc.gcmc")
    assert found["range"]["start"] == {"line": 1, "character": 9}
    editor.open("own.gcmc", GCMC)
    assert editor.at("definition", "own.gcmc", 9, 22)["range"]["start"]["line"] == 7  # not in the comment
    assert "motion" in editor.at("hover", "own.gcmc", 9, 1)["contents"]["value"]
    names = [(s["name"], s["range"]["end"]["line"]) for s in editor.ask(
        "textDocument/documentSymbol", textDocument={"uri": editor.uri("own.gcmc")})["result"]]
    assert names == [("hole", 4), ("depth", 7)]
    words = {w["label"] for w in editor.at("completion", "own.gcmc", 9, 0)}
    assert {"feedrate", "hole", "depth"} <= words


def test_openscad(editor):
    text = "module slot(deep = 2) {\n  cutline(1, 2, -deep);\n}\nwidth = 3;\nslot(width);\n"
    editor.open("part.scad", text)
    assert editor.at("definition", "part.scad", 4, 6)["range"]["start"]["line"] == 3
    assert {"translate", "slot"} <= {w["label"] for w in editor.at("completion", "part.scad", 4, 0)}


def test_jobs(editor, kerf):
    job = kerf("cut", "--example", "pocket").out
    editor.open("job.toml", job)
    line = next(n for n, row in enumerate(job.splitlines()) if row.startswith("stepdown"))
    assert "maximum depth of a pass" in editor.at("hover", "job.toml", line, 2)["contents"]["value"]
    assert {"stepover", "entry"} <= {w["label"] for w in editor.at("completion", "job.toml", line, 0)}
    names = [s["name"] for s in editor.ask("textDocument/documentSymbol",
                                           textDocument={"uri": editor.uri("job.toml")})["result"]]
    assert "pocket" in names and "tools" in names
    editor.change("job.toml", job.replace("stepdown", "stepdwn"))
    found = editor.diagnostics("job.toml")
    assert (line, 1) in [(r[0], r[2]) for r in rows(found)]


def test_columns_count_as_the_editor_counts(tmp_path):
    """UTF-16 units, or bytes where both sides can: an emoji has 2 units and 4 bytes."""
    text = "a = 1; /* \U0001F600 */ b = a;\n"
    for encodings, column in ((["utf-16"], 21), (["utf-8", "utf-16"], 23)):
        editor = Editor(tmp_path)
        editor.ask("initialize", capabilities={"general": {"positionEncodings": encodings}})
        editor.open("part.gcmc", text)
        assert editor.at("definition", "part.gcmc", 0, column)["range"]["start"]["character"] == 0
        assert editor.close() == 0


@pytest.mark.parametrize("sent, status", [
    (b"", 1), (b"Content-Length: 3\r\n\r\n{}", 1), (b"hello\r\n\r\n", 1),
    (b"Content-Length: 99999999999999\r\n\r\n", 1), (b"Content-Length: -1\r\n\r\n", 1),
    (b"x" * 100_000, 1), (b"Content-Length: 5\r\n\r\n[1,2]", 1), (b"Content-Length: 4\r\n\r\nnull", 1),
    (b'Content-Length: 17\r\n\r\n{"method":"exit"}', 1)])
def test_what_is_no_message_ends_the_server(sent, status, tmp_path):
    done = subprocess.run([KERF, "lsp"], input=sent, capture_output=True, timeout=30, cwd=tmp_path)
    assert done.returncode == status


def test_wrong_requests_are_answered(editor):
    assert editor.ask("textDocument/rename")["error"]["code"] == -32601
    for method in ("hover", "definition", "documentSymbol", "completion"):
        assert editor.ask(f"textDocument/{method}")["result"] in (None, [])
        assert editor.ask(f"textDocument/{method}", textDocument=7, position="x")["result"] in (None, [])
    editor.note("textDocument/didChange", textDocument={"uri": 5}, contentChanges={"a": 1})
    editor.note("textDocument/didOpen")
    editor.send({"id": None, "method": "x"})
    body = b"{"
    editor.process.stdin.write(b"Content-Length: 1\r\n\r\n" + body)
    editor.process.stdin.flush()
    assert editor.receive()["error"]["code"] == -32700
    assert editor.close() == 0


def test_a_newer_text_stops_the_older_one(editor):
    """A program that never ends is given up for the next text."""
    editor.note("textDocument/didOpen", textDocument={
        "uri": editor.uri("part.gcmc"), "languageId": "gcmc", "version": 1, "text": "while(1) { a = 1; }\n"})
    editor.change("part.gcmc", "b = ;\n", version=3)
    found = editor.diagnostics("part.gcmc")
    while found["version"] != 3:
        found = editor.diagnostics("part.gcmc")
    assert [r[2] for r in rows(found)] == [1]


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed; skipped")
def test_the_extension_for_visual_studio_code(tmp_path):
    """Its own client, with a stand-in for the editor."""
    (tmp_path / "part.nc").write_text("G21 G90\nT1 M6\nM3 S9000\nG0 X10 Y10 Z5\nG1 Z-1 F300\nX70\nG0 Z5\n")
    done = subprocess.run(["node", Path(__file__).with_name("vscode_stub.js"),
                           SOURCE / "editors/vscode/extension.js", tmp_path / "part.nc"],
                          capture_output=True, text=True, timeout=60, env={**os.environ, "KERF": KERF})
    assert done.returncode == 0, done.stderr
    shown = json.loads(done.stdout)
    assert shown["errors"] == []
    assert {"line": 4, "code": "unknown_tool", "severity": 0} in shown["opened"]  # 0: error
    assert any(d["line"] == 5 for d in shown["changed"])
    assert "to X10 Y10 Z5" in shown["hover"] and shown["symbols"] == ["tool 1"] and shown["words"] > 50
