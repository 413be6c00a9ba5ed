#!/usr/bin/env python3
"""Gathers the files of a release in FOLDER, with the SPDX list, the notes and the checksums.

Usage: make_release.py SOURCE FOLDER

The wheel, the Debian packages, the page without a server and the page's npm packages must have been built
before: `./dev release` does all of it. The environment variable SOURCE_DATE_EPOCH is the time of every file
in an archive, so that the same commit gives the same bytes.
"""

import argparse
import gzip
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import time
import zipfile
from xml.sax.saxutils import escape


def fail(message):
    raise SystemExit(f"make_release: {message}")


def run(*words, **options):
    subprocess.run([str(word) for word in words], check=True, **options)


def notes(source, version):
    """The section of CHANGELOG.md for this version."""
    text = (source / "CHANGELOG.md").read_text()
    found = re.search(rf"^## {re.escape(version)}\b[^\n]*\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    if not found:
        fail(f"CHANGELOG.md has no section {version}")
    return f"# Kerf {version}\n\n{found[1].strip()}\n"


def archive_sources(source, folder, name):
    """The files of the commit, as `git archive` writes them."""
    data = subprocess.run(["git", "-C", source, "archive", "--format=tar", f"--prefix={name}/", "HEAD"],
                          check=True, capture_output=True).stdout
    (folder / f"{name}.tar.gz").write_bytes(gzip.compress(data, 9, mtime=0))


def files_below(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def write_zip(target, folder, epoch):
    moment = time.gmtime(max(epoch, 315532800))[:6]  # the first date of a zip
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in files_below(folder):
            entry = zipfile.ZipInfo(str(path.relative_to(folder)), moment)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, path.read_bytes())


def write_tar(target, folder, prefix, epoch):
    with open(target, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as packed, \
            tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for path in files_below(folder):
            entry = tarfile.TarInfo(f"{prefix}/{path.relative_to(folder)}")
            entry.size, entry.mode, entry.mtime = path.stat().st_size, 0o644, epoch
            with open(path, "rb") as content:
                archive.addfile(entry, content)


def with_version(file, version):
    data = json.loads(file.read_text())
    data["version"] = version
    file.write_text(json.dumps(data, indent=2) + "\n")


def add_licences(source, folder):
    for name in ("LICENSE", "NOTICE"):
        shutil.copy(source / name, folder / name)
    shutil.copytree(source / "licences", folder / "licences")


def npm_package(source, folder, build, version, epoch):
    """The library in WebAssembly with its module and types."""
    made = folder / "npm"
    shutil.copytree(source / "web/npm", made)
    dist = build / "web/dist/npm"
    shutil.copy(dist / "library.mjs", made / "library.mjs")
    shutil.copytree(dist / "types", made / "types")
    shutil.copy(build / "page/kerf.js", made / "kerf.cjs")
    shutil.copy(build / "page/kerf.wasm", made / "kerf.wasm")
    add_licences(source, made)
    with_version(made / "package.json", version)
    write_tar(folder / f"kerf-cam-{version}.tgz", made, "package", epoch)
    shutil.rmtree(made)


def code_package(source, folder, version, epoch):
    """The package for VS Code, in the form of vsce."""
    made = folder / "vsix"
    shutil.copytree(source / "editors/vscode", made / "extension")
    shutil.copy(source / "LICENSE", made / "extension/LICENSE.txt")
    grammars = made / "extension/syntaxes"
    grammars.mkdir()
    for grammar in sorted((source / "editors").glob("*.tmLanguage.json")):
        shutil.copy(grammar, grammars / grammar.name)
    with_version(made / "extension/package.json", version)
    package = json.loads((made / "extension/package.json").read_text())
    template = (source / "cmake/release/extension.vsixmanifest.in").read_text()
    values = {"ID": package["name"], "VERSION": version, "PUBLISHER": package["publisher"],
              "TITLE": package["displayName"], "DESCRIPTION": package["description"],
              "ENGINE": package["engines"]["vscode"]}
    for key, value in values.items():
        template = template.replace(f"@{key}@", escape(value, {'"': "&quot;"}))
    (made / "extension.vsixmanifest").write_text(template)
    types = "".join(f'<Default Extension=".{ending}" ContentType="{kind}"/>' for ending, kind in
                    (("js", "text/javascript"), ("json", "application/json"), ("md", "text/markdown"),
                     ("txt", "text/plain"),
                     ("vsixmanifest", "text/xml")))
    (made / "[Content_Types].xml").write_text(
        '<?xml version="1.0" encoding="utf-8"?>\n'
        f'<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">{types}</Types>\n')
    write_zip(folder / f"kerf-cam-{version}.vsix", made, epoch)
    shutil.rmtree(made)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    source, folder = options.source.resolve(), options.folder.resolve()
    epoch = int(os.environ["SOURCE_DATE_EPOCH"])
    version = (source / "VERSION").read_text().strip()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "NOTES.md").write_text(notes(source, version))
    archive_sources(source, folder, f"kerf-{version}")
    built = [*(source / "build-wheel/dist").iterdir(), *(source / "build-package").glob("*.deb")]
    for file in built:
        shutil.copy(file, folder)
    npm_package(source, folder, source / "build-wasm", version, epoch)
    code_package(source, folder, version, epoch)
    write_zip(folder / f"kerf-page-{version}.zip", source / "build-wasm/site", epoch)
    linked = [file for file in built if file.suffix in (".whl", ".deb")]
    spdx = folder / f"kerf-{version}.spdx.json"
    run(sys.executable, source / "cmake/release/spdx.py", source, spdx, *linked)
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
            for path in sorted(folder.iterdir())]
    (folder / "SHA256SUMS").write_text("".join(sums))
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size:10d} bytes  {path.name}")


if __name__ == "__main__":
    main()
