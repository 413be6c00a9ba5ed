"""The files of a release that need no build: the package for VS Code, and archives with the same bytes."""
import importlib.util
import json
import os
import xml.etree.ElementTree
import zipfile
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2]
VERSION = (SOURCE / "VERSION").read_text().strip()


@pytest.fixture(scope="module")
def release():
    spec = importlib.util.spec_from_file_location("make_release", SOURCE / "cmake/release/make_release.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_package_for_vs_code_has_each_file_that_it_names(release, tmp_path):
    release.code_package(SOURCE, tmp_path, VERSION, 1700000000)
    with zipfile.ZipFile(tmp_path / f"kerf-cam-{VERSION}.vsix") as archive:
        names = set(archive.namelist())
        package = json.loads(archive.read("extension/package.json"))
        manifest = xml.etree.ElementTree.fromstring(archive.read("extension.vsixmanifest"))
        types = xml.etree.ElementTree.fromstring(archive.read("[Content_Types].xml"))
    assert package["version"] == VERSION
    added = package["contributes"]
    named = [one["path"] for one in added["grammars"]] + [one["configuration"] for one in added["languages"]]
    assert {f"extension/{path.removeprefix('./')}" for path in named} <= names
    assets = [one.get("Path") for one in manifest.iter() if one.tag.endswith("}Asset")]
    assert len(assets) == 3 and set(assets) <= names
    identity = next(one for one in manifest.iter() if one.tag.endswith("}Identity"))
    assert (identity.get("Id"), identity.get("Version")) == (package["name"], VERSION)
    known = {one.get("Extension") for one in types}
    assert {os.path.splitext(name)[1] for name in names - {"[Content_Types].xml"}} <= known


def test_archives_of_the_same_files_have_the_same_bytes(release, tmp_path):
    made = []
    for number, umask_mode in enumerate((0o600, 0o664)):
        folder = tmp_path / f"files{number}"
        (folder / "deep").mkdir(parents=True)
        for name in ("b", "a", "deep/c"):
            (folder / name).write_text(name * 1000)
            (folder / name).chmod(umask_mode)
            os.utime(folder / name, (number * 1e6, number * 1e6))
        release.write_zip(tmp_path / f"{number}.zip", folder, 1700000000)
        release.write_tar(tmp_path / f"{number}.tgz", folder, "package", 1700000000)
        made.append([(tmp_path / f"{number}.{ending}").read_bytes() for ending in ("zip", "tgz")])
    assert made[0] == made[1]
