"""Runs every benchmark program of a build and prints each figure with its ratio to the previous run.

    bench/report.py BUILD_FOLDER [FILTER]

Those in Python are run with BUILD_FOLDER/python on the path, if it was built there. FILTER is a regular
expression over benchmark names. The figures are kept in BUILD_FOLDER/bench-last.json; those of benchmarks
that did not run this time stay.
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

# Counters of a row other than those of Google Benchmark.
RATES = {"items_per_second": "items/s", "bytes_per_second": "B/s"}
PEERS = "peers"
PEAK = "peak_MB"  # memory of a job in addition to its input
TIMES_REAL = "times_real"  # how many times faster than the program that Kerf replaces
PEER = re.compile(r"([\w.]+?)_(cpu_s|s|ms)$")  # counters that quote another program's time
OWN = {"real_time", "cpu_time", "items_per_second"}  # of the library, though they end like a quoted time
SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def run(program, pattern):
    """{name: row} of one program: seconds of wall time, and the rates and counters it reports."""
    options = ["--benchmark_format=json"] + ([f"--benchmark_filter={pattern}"] if pattern else [])
    words = [sys.executable] if program.suffix == ".py" else []
    done = subprocess.run([*words, str(program), *options], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{program.name} ended with status {done.returncode}")
    rows = {}
    for row in json.loads(done.stdout or '{"benchmarks": []}')["benchmarks"]:
        if row.get("error_occurred"):
            sys.exit(f"{row['name']}: {row.get('error_message')}")
        rates = {label: row[key] for key, label in RATES.items() if key in row}
        rates.update({label: row[label] for label in (TIMES_REAL, PEAK) if label in row})
        peers = [f"{m[1]} {value:g} {m[2].replace('_', ' ')}" for key, value in row.items()
                 if key not in OWN and (m := PEER.match(key))]
        if peers:
            rates[PEERS] = ", ".join(peers)
        rows[row["name"]] = {"seconds": row["real_time"] * SECONDS[row["time_unit"]], **rates}
    return rows


def time_text(seconds):
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def rate_text(row):
    texts = [f"{row[label] / 1e6:10.3f} M{label}" for label in RATES.values() if label in row][:1]
    if TIMES_REAL in row:
        texts.append(f"{row[TIMES_REAL]:.1f} times the real program's speed")
    if PEAK in row:
        texts.append(f"{row[PEAK]:.0f} MB")
    if PEERS in row:
        texts.append(f"({row[PEERS]})")
    return "  ".join(texts)


def line(name, row, before):
    """One row: name, time, ratio to the previous run (below 1 is faster), rate."""
    ratio = f"x{row['seconds'] / before['seconds']:.2f}" if before and before["seconds"] > 0 else "new"
    return f"{name:<48} {time_text(row['seconds']):>10} {ratio:>7} {rate_text(row)}".rstrip()


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    build, pattern = Path(sys.argv[1]), sys.argv[2] if len(sys.argv) == 3 else ""
    store = build / "bench-last.json"
    last = json.loads(store.read_text()) if store.exists() else {}
    programs = sorted(p for p in (build / "bench").glob("bench_*") if p.is_file())
    if (build / "python").is_dir():
        os.environ["PYTHONPATH"] = str((build / "python").resolve())
        programs.append(Path(__file__).parent / "python" / "calls.py")
    print(f"{'benchmark':<48} {'time':>10} {'ratio':>7} rate (ratio: time now / time before)")
    for program in programs:
        for name, row in run(program, pattern).items():
            print(line(name, row, last.get(name)), flush=True)
            last[name] = row
    store.write_text(json.dumps(last, indent=1))
    print(f"{len(programs)} benchmark programs; figures kept in {store}")


if __name__ == "__main__":
    main()
