#!/usr/bin/env python3
"""Writes the SPDX list (2.3, JSON) of a release and compares it with what is linked.

Usage: spdx.py SOURCE OUTPUT FILE...

Each FILE is a program, a library, a wheel or a Debian package. A library that one of them needs or contains,
and that is neither a component of components.toml nor part of every Linux system, is an error (status 1), and
so is a component whose licence text or notice is missing.
"""

import argparse
import datetime
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import zipfile

# The C and C++ runtime, which the system or the compiler provides.
RUNTIME = {"libc", "libm", "libstdc++", "libgcc_s", "libpthread", "libdl", "librt", "ld-linux-x86-64",
           "ld-linux-aarch64"}


def output(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def library(name):
    """libfmt of libfmt.so.9, libfmt-0a1b2c.so.9 and libfmt.so."""
    return re.sub(r"-[0-9a-f]{8}$", "", name.split("/")[-1].split(".so")[0])


def needed(file):
    """The libraries that an ELF file names."""
    lines = output("objdump", "-p", file).splitlines()
    return {library(line.split()[1]) for line in lines if "NEEDED" in line}


def members(file):
    """(name, bytes) of what is in a wheel or a Debian package."""
    if file.suffix == ".whl":
        with zipfile.ZipFile(file) as archive:
            yield from ((name, archive.read(name)) for name in archive.namelist() if not name.endswith("/"))
        return
    data = subprocess.run(["dpkg-deb", "--fsys-tarfile", file], check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        for member in archive:
            if member.isfile():
                yield member.name, archive.extractfile(member).read()


def libraries(file):
    """The libraries that a program needs, or that the files of a package are or need."""
    if file.suffix not in (".whl", ".deb"):
        return needed(file)
    found = set()
    with tempfile.TemporaryDirectory() as folder:
        for name, data in members(file):
            if not data.startswith(b"\x7fELF"):
                continue
            copy = pathlib.Path(folder) / "file"
            copy.write_bytes(data)
            found |= needed(copy)
            if re.match(r"lib.*\.so", name.split("/")[-1]):
                found.add(library(name))
    return found


def version(component, source):
    if "npm" in component:
        return json.loads((source / "web/package.json").read_text())["dependencies"][component["npm"]]
    text = output("dpkg-query", "-W", "-f", "${Version}", component["package"])
    return re.sub(r"^\d+:|[+~-].*$", "", text)


def package(number, name, version_text, licence, **more):
    return {"SPDXID": f"SPDXRef-{number}", "name": name, "versionInfo": version_text,
            "downloadLocation": "NOASSERTION", "licenseConcluded": licence, "licenseDeclared": licence,
            "copyrightText": "NOASSERTION", "filesAnalyzed": False, **more}


def document(source, components):
    kerf = (source / "VERSION").read_text().strip()
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    time = datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc)
    packages = [package("Kerf", "kerf-cam", kerf, "Apache-2.0")]
    packages += [package(f"Component-{i}", c["name"], version(c, source), c["licence"])
                 for i, c in enumerate(components, 1)]
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                  "relatedSpdxElement": "SPDXRef-Kerf"}]
    relations += [{"spdxElementId": "SPDXRef-Kerf", "relationshipType": "DEPENDS_ON",
                   "relatedSpdxElement": p["SPDXID"]} for p in packages[1:]]
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
            "name": f"kerf-cam-{kerf}", "documentNamespace": f"https://spdx.org/spdxdocs/kerf-cam-{kerf}",
            "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ"),
                             "creators": ["Organization: Kerf", "Tool: kerf-spdx"]},
            "packages": packages, "relationships": relations}


def errors(source, components, files):
    """What the list, the licences and the linked libraries do not agree about."""
    notice = (source / "NOTICE").read_text()
    for component in components:
        if not (source / "licences" / component["text"]).is_file():
            yield f"{component['name']}: licences/{component['text']} is missing"
        if component["name"] not in notice:
            yield f"{component['name']} is not in NOTICE"
    texts = {component["text"] for component in components}
    for text in sorted(path.name for path in (source / "licences").glob("*.txt")):
        if text not in texts:
            yield f"licences/{text} belongs to no component"
    known = {name for component in components for name in component.get("libraries", [])} | RUNTIME
    for file in files:
        for name in sorted(libraries(file) - known):
            yield f"{file.name}: {name} is not in the list"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("files", type=pathlib.Path, nargs="*")
    options = parser.parse_args()
    table = tomllib.loads((pathlib.Path(__file__).parent / "components.toml").read_text())
    components = table["component"]
    found = list(errors(options.source, components, options.files))
    for error in found:
        print(f"spdx: {error}", file=sys.stderr)
    if found:
        return 1
    options.output.write_text(json.dumps(document(options.source, components), indent=1) + "\n")
    print(f"{len(components)} components; {len(options.files)} files need no other library")
    return 0


if __name__ == "__main__":
    sys.exit(main())
