#!/usr/bin/env python3
"""Installs, uses and removes the Debian packages in a root of its own. Run as root.

Usage: check_deb.py SUITE FOLDER DEB...

SUITE is bookworm or trixie. The root is made by debootstrap in FOLDER/SUITE, if it is not there. python3-kerf
fits one version of Python; with another one apt-get must refuse it. Exit status 77: the root cannot be made.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys

SKIPPED = 77
MIRROR = "http://deb.debian.org/debian"
PROGRAM = "G21 G90\nT102 M6\nM3 S9000\nG0 X10 Y10 Z5\nG1 Z-1 F100\nG1 X30\nG0 Z5\nM5\nM30\n"


def expect(condition, what):
    print("ok    " if condition else "WRONG ", what, flush=True)
    if not condition:
        raise SystemExit(f"check_deb: {what}")


class Root:
    """A folder with a Debian system."""

    def __init__(self, folder):
        self.folder = folder

    def run(self, command, status=0):
        """The output of a shell command within the root."""
        set_up = "export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8"
        words = ["chroot", self.folder, "sh", "-c", f"{set_up}; {command}"]
        done = subprocess.run(words, capture_output=True, text=True, timeout=1200)
        expect(done.returncode == status, f"{command}: {done.returncode} {done.stderr[-600:].strip()}")
        return done.stdout


def use_command(root):
    (root.folder / "tmp/part.nc").write_text(PROGRAM)
    version = root.run("kerf --version")
    expect(re.match(r"kerf [\d.]+\nbuild: .*\nfeatures: full page", version), "kerf --version")
    root.run("cd /tmp && kerf simulate part.nc -o part.png -o part.3mf && test -s part.png -a -s part.3mf")
    expect("G21" in root.run("cd /tmp && kerf post --to grbl part.nc"), "kerf post")
    root.run("cd /tmp && kerf info --machine grbl_router part.nc")
    root.run("cd /tmp && kerf cut --op engrave --text AB --height 10 --tool 'V d=6 angle=60' --depth 0.4 "
             "--feed 600 --rpm 9000 -o ab.nc")
    root.run("cd /tmp && printf '<svg/>' > a.svg; kerf outline a.svg", status=1)  # Expat reads it
    root.run("cd /tmp && (kerf view part.nc > view.txt & pid=$!; sleep 3; kill $pid; wait $pid); "
             "grep -q http://127 view.txt")
    completed = root.run("bash -c '. /usr/share/bash-completion/completions/kerf; COMP_WORDS=(kerf sim); "
                         "COMP_CWORD=1; _kerf; echo ${COMPREPLY[@]}'")
    expect(completed.strip() == "simulate", "completion")


def check_documents(root):
    doc = root.folder / "usr/share/doc/kerf"
    wrong = [f"{page.relative_to(doc)}: {link}" for page in doc.rglob("*.md")
             for link in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text())
             if not re.match(r"\w+:", link) and not (page.parent / link).exists()]
    expect(not wrong, f"links of the documents {wrong}")


def use_modules(root):
    root.run("cd /tmp && python3 -c 'import kerf, gcodepreview, cnc25d_api, openscad'")
    (root.folder / "tmp/part.py").write_text("import kerf\nprint(kerf.load('part.nc').toolpath)\n")
    expect("Toolpath" in root.run("cd /tmp && kerf run part.py"), "kerf run")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("suite")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("debs", type=pathlib.Path, nargs="+")
    options = parser.parse_args()
    root = Root(options.folder.resolve() / options.suite)
    if not (root.folder / "usr/bin/apt-get").exists():
        shutil.rmtree(root.folder, ignore_errors=True)
        words = ["debootstrap", "--variant=minbase", options.suite, root.folder, MIRROR]
        if subprocess.run(words).returncode:
            return SKIPPED
    proc = root.folder / "proc"
    subprocess.run(["mount", "-t", "proc", "proc", proc], check=True)
    try:
        for deb in options.debs:
            shutil.copy(deb, root.folder / "tmp" / deb.name)
        command = next(deb.name for deb in options.debs if deb.name.startswith("kerf_"))
        modules = [deb.name for deb in options.debs if deb.name.startswith("python3-kerf_")]
        root.run("apt-get update -qq")
        before = root.run("dpkg -l | grep -c ^ii").strip()
        root.run(f"apt-get install -y -qq --no-install-recommends /tmp/{command}")
        use_command(root)
        check_documents(root)
        python = root.run("apt-cache policy python3 | sed -n 's/.*Candidate: //p'").strip()
        for name in modules:
            wanted = re.search(r"python3 \(<< ([\d.]+)\)", root.run(f"dpkg-deb -f /tmp/{name} Depends"))[1]
            fits = subprocess.run(["dpkg", "--compare-versions", python, "lt", wanted]).returncode == 0
            root.run(f"apt-get install -y -qq --no-install-recommends /tmp/{name}", status=0 if fits else 100)
            if fits:
                use_modules(root)
        root.run("apt-get purge -y -qq kerf python3-kerf; apt-get autoremove -y -qq --purge")
        expect(root.run("dpkg -l | grep -c ^ii").strip() == before, "all packages are gone")
        left = root.run("find /usr /etc /var/lib -ipath '*kerf*' -not -path '/var/lib/apt/*'").split()
        expect(not left, f"nothing is left {left}")
    finally:
        subprocess.run(["umount", proc], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
