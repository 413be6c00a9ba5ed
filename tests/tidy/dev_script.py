"""The scripts are valid shell, and the commands and presets that the documents name exist."""
import json
import re
import subprocess
import sys

from sources import finish, root_of


def main():
    root = root_of(sys.argv)
    problems = []
    for script in ("dev", ".ci/run"):
        run = subprocess.run(["bash", "-n", str(root / script)], capture_output=True, text=True)
        problems += [f"{script}: {line}" for line in run.stderr.splitlines()]
    demo = re.search(r"^demo\(\) \{.*?^\}", (root / "dev").read_text(), re.M | re.S)
    modules = r"build --target kerf kerf_python kerf_outline_python$"
    if demo is None or not re.search(modules, demo.group(), re.M):
        problems.append("dev: demo does not build the Python modules, as README states")
    usage = subprocess.run([str(root / "dev"), "help"], capture_output=True, text=True, check=True).stdout
    known = set(re.findall(r"^  ([a-z0-9]+) ", usage, re.M))
    script = (root / "dev").read_text()
    handled = set(re.findall(r"[a-z0-9-]+", " ".join(re.findall(r"^  ([a-z0-9| -]+)\) ?", script, re.M))))
    problems += [f"dev: {word} of the usage is not handled" for word in sorted(known - handled)]
    fetched = re.search(r'^windows_sources="(.*)"$', script, re.M).group(1).split()
    libraries = (root / "cmake/KerfWindows.cmake").read_text()
    unpacked = re.findall(r'^kerf_source_folder\(\w+ "(.*)-\*', libraries, re.M)
    problems += [f"dev: windows_sources and the folders of cmake/KerfWindows.cmake differ in {name}"
                 for name in sorted(set(fetched) ^ set(unpacked))]
    presets = json.loads((root / "CMakePresets.json").read_text())
    names = {preset["name"] for preset in presets["configurePresets"]}
    for document in ("README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"):
        text = (root / document).read_text()
        problems += [f"{document}: ./dev {word} is not a command"
                     for word in re.findall(r"\./dev ([a-z0-9]+)", text) if word not in known]
        problems += [f"{document}: preset {word} does not exist"
                     for word in re.findall(r"--preset (\w+)", text) if word not in names]
    documents = [root / name for name in ("README.md", "CONTRIBUTING.md", "ARCHITECTURE.md")]
    for path in documents + sorted((root / "docs").rglob("*.md")):
        problems += [f"{path.relative_to(root)}: the link {target} does not exist"
                     for target in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", path.read_text())
                     if not (path.parent / target).exists() ]
    finish("dev_script", problems)


if __name__ == "__main__":
    main()
