#!/usr/bin/env python3
"""Installs the npm package in a fresh folder and runs what a user runs: the example of its README word for
word, an error with its line, and the types with each resolution of modules that TypeScript has.

Usage: check_npm.py SOURCE PACKAGE FOLDER WEB

PACKAGE is kerf-cam-VERSION.tgz, FOLDER is emptied first, and WEB is a folder made by web/build.sh, whose
TypeScript is used. Exit status 77: npm is not installed.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

SKIPPED = 77
ERROR = """
import { KerfError, open } from 'kerf-cam';
const kerf = await open();
kerf.put('bad.nc', 'G1 X1 F100\\nG1 X[1/\\n');
try {
  kerf.load('bad.nc');
} catch (error) {
  if (!(error instanceof KerfError)) throw error;
  console.log(error.diagnostics[0].origin.line);
}
"""
TYPES = """
import { KerfError, open, type Kerf, type Model } from 'kerf-cam';
export async function removed(text: string): Promise<number> {
  const progress = (phase: string, fraction: number) => console.log(phase, fraction);
  const kerf: Kerf = await open({ progress });
  kerf.put('part.nc', text);
  const model: Model = kerf.load('part.nc');
  // @ts-expect-error: the name is a text. Without types of the package this line is an error.
  kerf.load(1);
  return kerf.download('stl').bytes.length + model.findings.length + new KerfError([]).diagnostics.length;
}
"""


def expect(condition, what):
    print("ok    " if condition else "WRONG ", what, flush=True)
    if not condition:
        raise SystemExit(f"check_npm: {what}")


def output(folder, *words):
    command = [str(word) for word in words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    text = (done.stdout + done.stderr)[-1500:] if done.returncode else ""
    expect(done.returncode == 0, f"{' '.join(command)} {text}")
    return done.stdout


def check_example(source, folder):
    readme = (source / "web/npm/README.md").read_text()
    (folder / "example.mjs").write_text(re.search(r"```js\n(.*?)```", readme, re.S)[1])
    removed, findings = output(folder, "node", "example.mjs").split()
    # A drill of the built-in table in 5 mm: between a hole of 1 mm and one of 10 mm in diameter.
    expect(4 < float(removed) < 400, f"the example removes {removed} mm3, {findings} findings")
    mesh = (folder / "hole.stl").read_bytes()
    triangles = int.from_bytes(mesh[80:84], "little")
    expect(triangles > 12 and len(mesh) == 84 + 50 * triangles, f"hole.stl has {triangles} triangles")


def check_types(folder, web):
    (folder / "use.mts").write_text(TYPES)
    for module, resolution in (("nodenext", "nodenext"), ("node16", "node16"), ("esnext", "bundler")):
        options = {"module": module, "moduleResolution": resolution, "target": "es2022", "strict": True,
                   "noEmit": True, "skipLibCheck": False, "types": [], "lib": ["es2022", "dom"]}
        (folder / "tsconfig.json").write_text(json.dumps({"compilerOptions": options, "files": ["use.mts"]}))
        output(folder, "node", web / "node_modules/typescript/bin/tsc", "--project", "tsconfig.json")


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    source, package, folder, web = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    if shutil.which("npm") is None:
        print("npm is not installed")
        return SKIPPED
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "package.json").write_text('{"private": true, "type": "module"}\n')
    output(folder, "npm", "install", "--offline", "--no-audit", "--no-fund", package)
    installed = folder / "node_modules/kerf-cam"
    described = json.loads((installed / "package.json").read_text())
    expect(described["version"] == (source / "VERSION").read_text().strip(), "the version")
    for name in [*described["files"], "README.md"]:
        expect((installed / name).exists(), name)
    check_types(folder, web)
    check_example(source, folder)
    (folder / "error.mjs").write_text(ERROR)
    expect(output(folder, "node", "error.mjs").strip() == "2", "the line of an error")
    return 0


if __name__ == "__main__":
    sys.exit(main())
