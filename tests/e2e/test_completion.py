"""Completion scripts and manual pages, made of the tables of options. The shells themselves complete."""
import os
import pty
import re
import select
import shutil
import signal
import subprocess

import pytest

FILES = ("part.nc", "PLATE.NGC", "model.stl", "notes.md", "tools.toml", "left.kstock", "job.py")


@pytest.fixture
def scripts(kerf, tmp_path):
    """The completion scripts, in a folder with files of several kinds."""
    for name in FILES:
        (tmp_path / name).write_text("")
    (tmp_path / "sub").mkdir()
    for shell in ("bash", "zsh", "fish"):
        run = kerf("completion", shell)
        assert run.status == 0 and not run.err
        (tmp_path / f"kerf.{shell}").write_text(run.out)
    return tmp_path


def in_bash(folder, line):
    code = f"""source kerf.bash
COMP_WORDS=({line}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _kerf; printf '%s\\n' "${{COMPREPLY[@]}}" """
    return run_shell(folder, ["bash", "--norc", "-c", code])


def in_fish(folder, line):
    line = line.replace("''", "")
    return run_shell(folder, ["fish", "--no-config", "-c", f"source kerf.fish; complete -C '{line}'"])


ZSHRC = r"""
autoload -Uz compinit; compinit -u -D
source ./kerf.zsh
compadd() {
  if [[ " $* " == *" -"[a-zA-Z]#[OAD]" "* ]]; then builtin compadd "$@"; return; fi  # no match yet
  local -a hits; builtin compadd -A hits "$@"; print -rl -- $hits >> hits.txt
  builtin compadd "$@"
}
setopt extended_glob
zle -C matches complete-word _main_complete
after() { zle matches; print END >> hits.txt }
zle -N after; bindkey '^X' after
"""


def in_zsh(folder, line):
    """Zsh completes in a terminal only. Its matches pass a function that notes them."""
    (folder / ".zshrc").write_text(ZSHRC)
    hits = folder / "hits.txt"
    hits.write_text("")
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(folder)
        os.execvpe("zsh", ["zsh", "-i"], {**os.environ, "ZDOTDIR": str(folder), "TERM": "dumb"})
    try:
        os.write(terminal, line.replace("''", "").encode() + b"\x18")
        for _ in range(200):
            if select.select([terminal], [], [], 0.1)[0]:
                os.read(terminal, 10000)
            if "END\n" in hits.read_text():
                return set(hits.read_text().split("\n")) - {"END", ""}
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        os.close(terminal)
    raise AssertionError("zsh does not answer")


def run_shell(folder, words):
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=60)
    assert not done.stderr, done.stderr
    return {line.split("\t")[0] for line in done.stdout.splitlines()}


SHELLS = [
    pytest.param(complete, id=name,
                 marks=pytest.mark.skipif(not shutil.which(name), reason=f"{name} is not installed"))
    for name, complete in (("bash", in_bash), ("fish", in_fish), ("zsh", in_zsh))
]


# line, words that are offered, words that are not
CASES = [
    ("kerf sim", {"simulate"}, {"check"}),
    ("kerf tools ''", {"list", "show", "import"}, {"simulate"}),
    ("kerf help printer ''", {"list", "import"}, {"simulate"}),
    ("kerf simulate --res", {"--resolution"}, {"--view"}),
    ("kerf pathdxf --prob", {"--probe-feed", "--probe"}, set()),
    ("kerf simulate --view ''", {"top", "iso"}, {"part.nc"}),
    ("kerf simulate --show ''", {"part", "burn"}, {"part.nc"}),
    ("kerf post --to gr", {"grbl", "grblhal"}, {"linuxcnc"}),
    ("kerf level --to ''", {"grbl"}, {"svg"}),
    ("kerf check --machine ''", {"grbl_router", "tools.toml"}, {"part.nc"}),
    ("kerf tools show 10", {"102"}, {"201"}),
    ("kerf cut --op pock", {"pocket"}, {"contour"}),
    ("kerf simulate ''", {"part.nc", "PLATE.NGC", "sub/"}, {"notes.md", "model.stl"}),
    ("kerf run ''", {"job.py"}, {"part.nc"}),
    ("kerf simulate part.nc --stock-mesh ''", {"model.stl"}, {"part.nc"}),
    ("kerf simulate part.nc --stock-left ''", {"left.kstock"}, {"model.stl"}),
    ("kerf post --include ''", {"sub/"}, {"part.nc"}),
]


@pytest.mark.parametrize("complete", SHELLS)
@pytest.mark.parametrize("line, offered, not_offered", CASES)
def test_completion(scripts, complete, line, offered, not_offered):
    if not line.endswith("''") and line.endswith(" "):
        line += "''"
    words = complete(scripts, line)
    folders = {word.rstrip("/") for word in words}
    assert {word.rstrip("/") for word in offered} <= folders
    # fish puts other files last instead of leaving them out
    if complete is not in_fish or not any("." in word for word in not_offered):
        assert not not_offered & words


def test_bash_after_an_equals_sign(scripts):
    assert in_bash(scripts, "kerf post --to = gr") == {"grbl", "grblhal"}


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_each_option_of_the_help_is_completed(kerf, scripts, shell):
    text = (scripts / f"kerf.{shell}").read_text()
    for command in ("simulate", "post", "cut", "view", "tools export"):
        for option in re.findall(r"^ +(?:-\w,)?--([a-z-]+)", kerf(*command.split(), "--help").out, re.M):
            assert (f"-l {option}" if shell == "fish" else f"--{option}") in text, (command, option)


def test_an_unknown_shell_is_wrong_usage(kerf):
    assert kerf("completion", "tcsh").status == 2


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("man")
    subprocess.run([os.environ["KERF"], "man", folder / "man1"], check=True)
    return folder / "man1"


def test_there_is_a_page_for_each_command(kerf, pages):
    listed = kerf("--help").out.split("Subcommands:")[-1].split("Examples:")[0]
    commands = re.findall(r"^  (\w+) ", listed, re.M)
    assert {"simulate", "tools", "gcmc"} <= set(commands)
    names = {page.name for page in pages.iterdir()}
    assert {f"kerf-{command}.1" for command in commands} | {"kerf.1", "kerf-tools-show.1"} <= names


def test_a_page_has_the_options_and_examples_of_the_help(kerf, pages):
    text = (pages / "kerf-simulate.1").read_text()
    for option in re.findall(r"^ +(?:-\w,)?--([a-z-]+)", kerf("simulate", "--help").out, re.M):
        assert "\\-\\-" + option.replace("-", "\\-") in text, option
    assert ".SH EXAMPLES" in text and "kerf simulate part.nc \\-o part.stl" in text


@pytest.mark.skipif(not shutil.which("man"), reason="man is missing")
def test_man_formats_every_page_without_a_warning(pages):
    for page in sorted(pages.iterdir()):
        words = ["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page]
        variables = {"PATH": "/usr/bin:/bin", "MANWIDTH": "80", "LC_ALL": "C.UTF-8"}
        done = subprocess.run(words, capture_output=True, text=True, env=variables)
        assert done.returncode == 0 and not done.stderr, (page.name, done.stderr)


def test_a_folder_that_cannot_be_written_is_an_error(kerf, tmp_path):
    (tmp_path / "file").write_text("")
    assert kerf("man", tmp_path / "file").status == 1
