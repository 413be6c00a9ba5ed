"""Bad input: an error with file and line, a non-zero status, bounded time and memory, no partial output."""
import os
import resource
import signal
import subprocess
import time

import pytest
from conftest import KERF, VALID

COMMANDS = [["simulate"], ["check"], ["info"], ["steps"]]
RELIEF = "".join(f"G1 X{i % 97} Y{i % 89} Z-{1 + i % 3} F900\n" for i in range(400_000))


def junk(seed, size=20_000):
    """Pseudo-random bytes, the same in every run."""
    state, out = seed, bytearray()
    while len(out) < size:
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        out += state.to_bytes(8, "little")
    return bytes(out)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("name, text", [
    ("binary", junk(1)),
    ("zeros", bytes(5000)),
    ("nan", b"G1 Xnan Y1 F100\n"),
    ("infinite", b"G1 X1e308 Y1e308 F1e308\n"),
    ("huge", b"G1 X" + b"9" * 400 + b" F100\n"),
    ("far", b"M6 T102\nG1 X99999999999999 F100\nM2\n"),
    ("cut off", VALID.encode()[:VALID.index("G3") + 4]),
    ("letter alone", b"G1 X\n"),
])
def test_bad_text_is_an_error_with_file_and_line(kerf, program, files, command, name, text):
    run = kerf(*command, program(text, "bad.nc"), timeout=60)
    assert run.status == 1, run.out + run.err
    assert "bad.nc:" in run.err and "error" in run.err
    assert files() == ["bad.nc"]


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("text", ["", "\n\n", "%\n%\n", "(nothing)\n"])
def test_an_empty_file_is_an_error(kerf, program, command, text):
    run = kerf(*command, program(text))
    assert run.status == 1
    assert "[1012]" in run.err and run.err.count(": error: ") == 1  # nothing_to_cut


def test_utf_16_is_named_in_the_message(kerf, program):
    run = kerf("info", program(VALID.encode("utf-16")))
    assert run.status == 1 and run.err.count("\n") == 2
    assert "part.nc:1:1: error: the file is UTF-16" in run.err and "iconv" in run.err


def test_junk_gives_few_messages(kerf, program):
    assert kerf("info", program(junk(3))).err.count("\n") == 1
    letters = "".join(f"{chr(65 + i % 26)}{chr(66 + i % 13)}!\n" for i in range(900))
    run = kerf("info", program(letters))
    assert run.status == 1 and run.err.count(": error: ") < 25
    assert "more [2002] (--json lists" in run.err


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("path, words", [("nothing.nc", "No such"), (".", "folder"), ("", "cannot read")])
def test_a_file_that_cannot_be_read(kerf, command, path, words):
    run = kerf(*command, path)
    assert run.status == 1
    assert words in run.err and "[1001]" in run.err  # file_unreadable


def test_a_file_of_unknown_kind(kerf, program):
    run = kerf("info", "--json", program(b"\x7fELF" + junk(2), "part.bin"))
    assert run.status == 1
    assert run.codes() == ["input_kind_unknown"]
    assert ".nc" in run.json["diagnostics"][0]["hint"]


def test_gcode_with_an_unknown_ending_is_read_with_a_note(kerf, program):
    run = kerf("info", "--json", program(name="part.job"))
    assert run.status == 0
    assert "input_kind_guessed" in run.codes()


def test_output_that_cannot_be_written(kerf, program, files):
    run = kerf("simulate", program(), "-o", "nowhere/part.stl")
    assert run.status == 1
    assert "[1003]" in run.err and "nowhere" in run.err  # file_unwritable
    assert files() == ["part.nc"]


def test_all_outputs_or_none(kerf, program, files, tmp_path):
    (tmp_path / "b.stl").mkdir()
    run = kerf("simulate", program(), "-o", "a.stl", "-o", "b.stl")
    assert run.status == 1
    assert files() == ["b.stl", "part.nc"]


def test_an_old_output_stays_when_the_program_is_bad(kerf, program, tmp_path):
    (tmp_path / "part.stl").write_text("old")
    assert kerf("simulate", program("G1 X\n"), "-o", "part.stl").status == 1
    assert (tmp_path / "part.stl").read_text() == "old"


def test_a_full_standard_output_is_an_error(program):
    with open("/dev/full", "wb") as full:
        done = subprocess.run([KERF, "steps", program()], stdout=full, stderr=subprocess.PIPE, timeout=60)
    assert done.returncode == 1
    assert b"cannot write to standard output" in done.stderr


@pytest.mark.parametrize("which", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_simulation_writes_nothing(program, files, tmp_path, which):
    path = program("M6 T101\nM3 S1000\n" + RELIEF + "M2\n")
    arguments = [KERF, "simulate", path, "--stock", "100x100x20", "--resolution", "0.02", "-o", "part.stl"]
    process = subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(0.5)
    process.send_signal(which)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert out == b"" and b"[1004]" in err  # stopped
    assert files() == ["part.nc"]


def test_a_waiting_read_is_interrupted(tmp_path):
    process = subprocess.Popen([KERF, "info", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=10) == 130


def megabytes(words):
    """Runs the command; its exit status, its messages and its maximum memory in MB."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    err = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), err, used.ru_maxrss / 1024


@pytest.mark.parametrize("words", [f"{KERF} info /dev/zero", f"yes G1 | {KERF} info -"])
def test_an_endless_stream_ends_at_a_limit(words):
    status, err, used = megabytes(["bash", "-c", words])
    assert status == 1
    assert b"[1002]" in err and b"regular files" in err  # file_too_large
    assert used < 1000


def test_an_endless_stream_is_interrupted_at_once(tmp_path):
    endless = subprocess.Popen(["yes", "G1"], stdout=subprocess.PIPE)
    process = subprocess.Popen([KERF, "info", "-"], stdin=endless.stdout, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    time.sleep(0.05)
    process.send_signal(signal.SIGTERM)
    started = time.monotonic()
    _, err = process.communicate(timeout=60)
    endless.kill()
    assert process.returncode in (130, -signal.SIGTERM), err  # the latter: before it was ready
    assert time.monotonic() - started < 5


def test_a_limit_on_the_size_of_files_leaves_no_partial_file(program, files, tmp_path):
    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))

    done = subprocess.run([KERF, "simulate", program(), "-o", "part.stl"], cwd=tmp_path, capture_output=True,
                          preexec_fn=limited, timeout=60)
    assert done.returncode == 1
    assert b"[1003]" in done.stderr  # file_unwritable
    assert files() == ["part.nc"]


def test_a_pipe_as_output_is_written_to(kerf, program, tmp_path):
    pipe = tmp_path / "part.stl"
    os.mkfifo(pipe)
    with open(tmp_path / "taken", "wb") as taken, subprocess.Popen(["cat", pipe], stdout=taken) as reader:
        assert kerf("simulate", program(), "-o", pipe).status == 0
        assert reader.wait(timeout=60) == 0
    kerf("simulate", program(), "-o", "same.stl")
    assert (tmp_path / "taken").read_bytes() == (tmp_path / "same.stl").read_bytes()
    assert pipe.is_fifo()


def test_a_line_without_end_takes_bounded_memory(program):
    path = program("")
    with open(path, "r+b") as file:
        file.truncate(2 << 30)  # a hole of 2 GB: one line of zero bytes
    limit = 4 << 30

    def bounded():
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    done = subprocess.run([KERF, "info", path], capture_output=True, preexec_fn=bounded, timeout=120)
    assert done.returncode == 1
    assert b"part.nc:1" in done.stderr and len(done.stderr) < 100_000


def test_many_wrong_lines_give_one_message(kerf, program):
    run = kerf("check", program("G1 X\n" * 300_000))
    assert run.status == 1
    assert run.err.count("\n") == 2, run.err  # one line for all, with the first line numbers
    assert "part.nc:1:4: error" in run.err and "and 299999 more in line 2, 3, 4, 5, 6 ..." in run.err


def test_control_bytes_do_not_reach_the_terminal(kerf, program):
    run = kerf("info", program(b"(\x1b[2J)\nG1 X\x1b\n"))
    assert run.status == 1 and "\x1b" not in run.err + run.out


@pytest.mark.skipif(os.name != "posix", reason="needs a terminal of its own")
def test_progress_and_colour_are_for_terminals_only(program, tmp_path):
    path = program("M6 T77\nG1 X1 F1\nM2\n")
    for env, coloured in (({"TERM": "xterm"}, True), ({"TERM": "xterm", "NO_COLOR": "1"}, False)):
        leader, follower = os.openpty()
        subprocess.run([KERF, "simulate", path], stderr=follower, stdout=subprocess.DEVNULL, timeout=60,
                       env={**{k: v for k, v in os.environ.items() if k != "NO_COLOR"}, **env})
        os.close(follower)
        shown = os.read(leader, 65536)
        os.close(leader)
        assert (b"\x1b[1;31merror\x1b[0m" in shown) == coloured
    plain = subprocess.run([KERF, "simulate", path], capture_output=True, timeout=60)
    assert b"\x1b" not in plain.stderr + plain.stdout
    for words, coloured in ((["--color=always"], True), (["--color", "always"], True),
                            (["--color", "never"], False), (["--color=auto"], False)):
        for call in ([*words, "simulate", path], ["simulate", path, *words]):
            piped = subprocess.run([KERF, *call], capture_output=True, timeout=60,
                                   env={**os.environ, "NO_COLOR": "1"})
            assert (b"\x1b[1;31merror\x1b[0m" in piped.stderr) == coloured, call


@pytest.mark.parametrize("words", [["--color"], ["--color=red"], ["--color", "red"], ["--color="]])
def test_other_words_than_the_choices_of_colours_are_refused(kerf, program, words):
    run = kerf("info", program(), *words)
    assert run.status == 2 and "--color" in run.err
