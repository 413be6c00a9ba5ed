"""Sweeps of parameters, long calls beside an event loop, and warnings as records of `logging`."""

import asyncio
import logging
import threading
import time
import warnings

import pytest

import kerf

PLATE = kerf.Region([(50, 30, 20)])


def pocket(d, depth=2.0, name="pocket"):
    how = {"depth": depth, "stepdown": 2, "feed": 900, "rpm": 9000, "name": name}
    return kerf.op.pocket(PLATE, f"square d={d} flute=20", **how)


def test_a_sweep_has_a_row_for_each_combination():
    seen = []
    table = kerf.sweep(
        lambda d, depth: {"removed": kerf.simulate(pocket(d, depth), "100x60x12").removed_mm3},
        d=[3, 6],
        depth=(1.0, 2.0),
        show=lambda text, fraction: seen.append((text, fraction)),
    )
    assert [(row["d"], row["depth"]) for row in table] == [(3, 1), (3, 2), (6, 1), (6, 2)]
    for row in table:
        assert row["removed"] == pytest.approx(3.14159 * 400 * row["depth"], rel=0.02)
    assert seen == [("1 of 4", 0.25), ("2 of 4", 0.5), ("3 of 4", 0.75), ("4 of 4", 1.0)]
    assert table.best("removed")["depth"] == 1
    assert str(table).splitlines()[0].split() == ["d", "depth", "removed"]
    assert "<th>removed</th>" in table._repr_html_() and table._repr_html_().count("<tr>") == 5


def test_a_sweep_keeps_errors_in_their_rows():
    table = kerf.sweep(pocket, d=[6, 90, -1], show=lambda text, fraction: None)
    assert [type(row.get("error")).__name__ for row in table] == ["NoneType", "Error", "Error"]
    assert isinstance(table[0]["result"], kerf.Program)
    with pytest.raises(ValueError, match="no row has a result 'seconds'"):
        table.best("seconds")


def test_a_sweep_in_threads_has_the_same_rows():
    measure = lambda d: len(pocket(d).toolpath)
    quiet = lambda text, fraction: None
    sizes = [2, 3, 4, 5, 6, 8]
    one, four = (kerf.sweep(measure, d=sizes, threads=n, show=quiet) for n in (1, 4))
    assert one == four == [{"d": d, "result": len(pocket(d).toolpath)} for d in sizes]


def test_wrong_sweeps_name_the_argument():
    with pytest.raises(TypeError, match="d must be a list of values, not 6"):
        kerf.sweep(pocket, d=6)
    with pytest.raises(ValueError, match="threads must be at least 1"):
        kerf.sweep(pocket, d=[6], threads=0)


def test_a_sweep_shows_a_bar(capsys):
    kerf.sweep(lambda d: d, d=[1, 2])
    assert "2 of 2" in capsys.readouterr().err


# ---- beside an event loop


def test_the_event_loop_goes_on():
    async def work():
        ticks = 0
        task = asyncio.ensure_future(
            kerf.in_background(kerf.simulate, pocket(3), "100x60x12", resolution=0.03)
        )
        while not task.done():
            await asyncio.sleep(0.001)
            ticks += 1
        return task.result(), ticks

    part, ticks = asyncio.run(work())
    assert part.removed_mm3 == pytest.approx(3.14159 * 400 * 2, rel=0.01) and ticks > 1


def test_errors_of_a_call_in_the_background_are_its_own():
    with pytest.raises(kerf.Error):
        asyncio.run(kerf.in_background(kerf.simulate, pocket(3), "0x60x12"))


def test_a_cancelled_call_stops():
    program = kerf.op.repeat(pocket(2, 10), 6, 6, pitch=(100, 60))
    stopped, began = threading.Event(), threading.Event()

    def work():
        began.set()
        try:
            kerf.simulate(program, "600x360x12", resolution=0.04)
        finally:
            stopped.set()

    async def cancel():
        task = asyncio.ensure_future(kerf.in_background(work))
        while not began.is_set():
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.2)
        task.cancel()
        start = time.monotonic()
        with pytest.raises(asyncio.CancelledError):
            await task
        return time.monotonic() - start

    assert asyncio.run(cancel()) < 20 and stopped.is_set()


def test_progress_is_shown_for_calls_in_the_background():
    phases = set()
    with kerf.progress(lambda phase, fraction: phases.add(phase)):
        asyncio.run(kerf.in_background(kerf.simulate, pocket(2), "100x60x12", resolution=0.02))
    assert phases


def test_warnings_become_records_of_logging(caplog):
    logging.captureWarnings(True)
    try:
        with warnings.catch_warnings(), caplog.at_level(logging.WARNING, logger="py.warnings"):
            logging.captureWarnings(False)
            logging.captureWarnings(True)
            warnings.simplefilter("always")
            kerf.op.drill([(10, 10)], "drill d=3 flute=9", depth=20, feed=100, rpm=9000)
    finally:
        logging.captureWarnings(False)
    assert any("flute length" in record.getMessage() for record in caplog.records)
