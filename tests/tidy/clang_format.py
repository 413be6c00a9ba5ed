"""Every C++ file is formatted by clang-format. `--fix` formats them.

Exit status 77 says that clang-format is not installed.
"""
import shutil
import subprocess
import sys

from sources import CPP, files, finish, root_of

PROGRAM = "clang-format-14"  # versions differ


def main():
    root = root_of(sys.argv)
    if shutil.which(PROGRAM) is None:
        print(f"clang_format: skipped, {PROGRAM} is not installed (./dev test installs it)")
        sys.exit(77)
    sources = [str(root / p) for p in files(root, CPP)]
    if "--fix" in sys.argv:
        sys.exit(subprocess.run([PROGRAM, "-i", *sources]).returncode)
    run = subprocess.run([PROGRAM, "--dry-run", "-Werror", *sources], capture_output=True, text=True)
    problems = [line for line in run.stderr.splitlines() if "error:" in line]
    if problems:
        problems.append("./dev format fixes these")
    finish("clang_format", problems or ([run.stderr] if run.returncode else []))


if __name__ == "__main__":
    main()
