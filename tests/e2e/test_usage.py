"""Wrong usage, help and version: exit status 2 with what was probably meant; help with examples."""

import pytest
from conftest import VALID

COMMANDS = ["simulate", "check", "info", "steps", "tools list", "tools show"]


@pytest.mark.parametrize("arguments", [[], ["--help"], ["help"], ["-h"]])
def test_help_names_every_command_and_the_exit_statuses(kerf, arguments):
    run = kerf(*arguments)
    assert run.status == 0
    for word in ("simulate", "check", "info", "steps", "tools", "Examples:", "Exit status"):
        assert word in run.out


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_examples(kerf, command):
    run = kerf(*command.split(), "--help")
    assert run.status == 0
    assert "Examples:\n  kerf " + command in run.out
    assert "--json" in run.out and "--quiet" in run.out
    assert run.out == kerf("help", *command.split()).out


@pytest.mark.parametrize("arguments, meant", [
    (["simlate", "part.nc"], "simulate"),
    (["infp", "part.nc"], "info"),
    (["tools", "lst"], "list"),
    (["simulate", "--resolutoin", "1", "part.nc"], "--resolution"),
    (["check", "part.nc", "--jsom"], "--json"),
    (["simulate", "part.nc", "--view", "tpo"], "top"),
    (["simulate", "part.nc", "--show", "prt"], "part"),
    (["check", "part.nc", "--format", "sarfi"], "sarif"),
    (["check", "part.nc", "--material", "plywod"], "plywood"),
    (["check", "part.nc", "--dialect", "linuxnc"], "linuxcnc"),
    (["check", "part.nc", "--tool", "sqare d=3"], "square"),
    (["check", "part.nc", "--tool", "square diamter=3"], "diameter"),
    (["post", "part.nc", "--to", "grlb"], "grbl"),
    (["post", "part.nc", "--to", "grbl", "--tool-change", "puase"], "pause"),
    (["level", "--over", "part.nc", "--to", "grlb"], "grbl"),
    (["cut", "part.dxf", "--op", "pocket", "--tool", "square d=6", "--to", "grlb"], "grbl"),
    (["cut", "part.dxf", "--op", "pokcet", "--tool", "square d=6"], "pocket"),
    (["cut", "--example", "pokcet"], "pocket"),
    (["completion", "bsh"], "bash"),
])
def test_misspelt_words_are_corrected(kerf, program, arguments, meant):
    program()
    run = kerf(*arguments)
    assert run.status == 2
    assert f"did you mean {meant}?" in run.err
    assert run.out == ""


@pytest.mark.parametrize("option, word, meant", [
    ("--machine", "grbl_ruoter", "grbl_router"),
    ("--printer", "endr_3", "ender_3"),
])
def test_misspelt_names_of_files_are_corrected(kerf, program, option, word, meant):
    run = kerf("check", program(), option, word)
    assert run.status == 1
    assert f"did you mean {meant}?" in run.err


@pytest.mark.parametrize("arguments", [
    ["simulate"], ["info"], ["steps"], ["tools"], ["tools", "show"],
    ["simulate", "part.nc", "other.nc"],
    ["simulate", "part.nc", "-o"],
    ["simulate", "part.nc", "--resolution", "fine"],
    ["simulate", "part.nc", "--resolution", "nan"],
    ["simulate", "part.nc", "--resolution", "-1"],
    ["simulate", "part.nc", "--resolution", "1e308"],
    ["simulate", "part.nc", "--threads", "1000000"],
    ["simulate", "part.nc", "--size", "0x0"],
    ["simulate", "part.nc", "--size", "1000000x1000000"],
    ["simulate", "part.nc", "--size", "big"],
    ["simulate", "part.nc", "--view", "10,100"],
    ["simulate", "part.nc", "--view", "nan,0"],
    ["simulate", "part.nc", "--stock", "a lot"],
    ["simulate", "part.nc", "--tool", "spoon d=3"],
    ["simulate", "part.nc", "--tool", "1=spoon d=3"],
    ["check", "part.nc", "--tool", ""],
    ["check", "part.nc", "--threads", "many"],
    ["compare", "part.nc", "part.stl", "--threads", "-1"],
    ["info", "part.nc", "--stock", "1x1x1e999"],
    ["simulate", "part.nc", "-o", "part.xyz"],
    ["simulate", "part.nc", "-o", "part"],
    ["simulate", "part.nc", "-o", "a.stl", "-o", "./a.stl"],
    ["simulate", "part.nc", "--resolution", "0.01ft"],
    ["simulate", "part.nc", "--stock", ""],
    ["simulate", "part.nc", "--stock", "40inx30x10"],
    ["help", "foo"],
    ["help", "tools", "foo"],
    ["--nothing"],
])
def test_wrong_usage_is_status_2_with_a_message(kerf, program, files, arguments):
    program()
    run = kerf(*arguments)
    assert run.status == 2, run.out + run.err
    assert "error" in run.err
    assert files() == ["part.nc"]


def test_a_stock_that_is_not_understood_is_named_with_a_hint(kerf, program):
    run = kerf("simulate", program(), "--stock", "100x60")
    assert run.status == 2
    assert "--stock: error: " in run.err and "hint: expected" in run.err
    assert "[4101]" in run.err  # stock_option


def test_an_output_must_not_replace_the_input(kerf, program):
    path = program(name="part.stl")  # whatever it holds
    run = kerf("simulate", path, "-o", path)
    assert run.status == 2
    assert "[1008]" in run.err  # output_is_input


def test_an_output_of_unknown_kind_lists_the_known_ones(kerf, program):
    run = kerf("simulate", program(), "-o", "part.step")
    assert run.status == 2
    assert "[1007]" in run.err and ".stl" in run.err and ".png" in run.err  # output_kind_unknown


def test_wrong_option_values_are_in_the_json_too(kerf, program):
    run = kerf("simulate", "--json", program(), "--stock", "much")
    assert run.status == 2
    assert run.codes() == ["stock_option"]


@pytest.mark.parametrize("spec, words", [
    ("-1=301", "-1 is not a tool number: expected an integer from 0"),
    ("1.5=301", "1.5 is not a tool number"),
    ("9999999999=301", "9999999999 is not a tool number"),
    ("=301", 'no tool number before "="'),
    ("=", 'no tool number before "="'),
    ("1=", 'the shape of tool 1 is missing after "="'),
    ("", "the tool is missing"),
    ("2=spoon d=3", 'unknown tool shape "spoon"'),
])
def test_a_bad_tool_option_is_shown_with_what_is_wrong(kerf, program, spec, words):
    run = kerf("simulate", program(), "--tool", spec)
    assert run.status == 2
    assert run.err.startswith(f'--tool "{spec}": error: ') and words in run.err and "hint: " in run.err


def test_an_unknown_position_of_zero_lists_the_positions(kerf, program):
    run = kerf("simulate", program(), "--stock", "100x60x12 at edge")
    assert run.status == 2
    for word in ("lower-left", "centre", "top-right", "top or bottom"):
        assert word in run.err


def test_help_of_a_command_ignores_further_arguments(kerf, program):
    assert kerf("help", "simulate", program()).out == kerf("simulate", "--help").out


def test_options_without_effect_are_reported(kerf, program):
    run = kerf("simulate", "--json", program(), "--tool", "2=301", "--view", "top", "--size", "100x100")
    assert run.status == 0
    unused = [d for d in run.json["diagnostics"] if d["name"] == "option_unused"]
    assert [d["origin"]["call"] for d in unused] == ["--view", "--size", "--tool 2=..."]
    assert "102" in unused[-1]["hint"]


def test_a_tool_option_for_a_program_without_tool_changes_is_used(kerf, program):
    path = program(VALID.replace("M6 T102\n", ""))
    run = kerf("simulate", "--json", path, "--tool", "5=square d=3 flute=9")
    assert "option_unused" not in run.codes() and run.json["removed_mm3"] > 0
