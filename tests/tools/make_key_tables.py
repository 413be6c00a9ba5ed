#!/usr/bin/env python3
"""Writes the tables of keys of docs/manual/operations.md and laser.md from the rows of the operations.

Usage: PYTHONPATH=build/python tests/tools/make_key_tables.py. tests/python/test_op.py compares them.
"""

import pathlib
import re

import kerf

MANUAL = pathlib.Path(__file__).parents[2] / "docs" / "manual"
PAGES = {"operations.md": False, "laser.md": True}  # whether its operations are those of lasers
BLOCK = re.compile(r"(<!-- keys: [^>]*-->\n).*?(<!-- end of keys -->)", re.DOTALL)

LAYOUT = re.compile(r"(<!-- layout: [^>]*-->\n).*?(<!-- end of layout -->)", re.DOTALL)


def value_text(row):
    """What a key may be: its choices, or its unit and range."""
    if "enum" in row:
        return ", ".join(f"`{word}`" for word in row["enum"])
    if row["type"] == "array":
        return "point" if "number" in row["items"]["type"] else "list of texts"
    if row["type"] == "string":
        return "text"
    if "x-tool" in row:
        return "number of a tool"
    low, above, high = row.get("minimum"), row.get("exclusiveMinimum"), row.get("maximum")
    least = "" if low is None else f"from {low:.10g}"
    if above is not None:
        least = f"above {above:.10g}"
    words = [row.get("$comment", ""), least, "" if high is None else f"to {high:.10g}"]
    return " ".join(word for word in words if word) or "number"


def default_text(row):
    if "x-required" in row:
        return "required"
    if "x-otherwise" in row:
        return row["x-otherwise"]
    default = row.get("default", "")
    return f"`{default:g}`" if isinstance(default, (int, float)) else f"`{default}`" if default else ""


def grouped(rows, text):
    """The texts of operations, with the operations where they differ."""
    groups = {}
    for op, row in rows.items():
        groups.setdefault(text(row), []).append(op)
    parts = [t if i == 0 else f"{', '.join(ops)}: {t}" for i, (t, ops) in enumerate(groups.items()) if t]
    return "; ".join(parts)


def operations_text(ops, everything):
    if len(ops) == len(everything):
        return "all"
    others = [op for op in everything if op not in ops]
    return "all but " + ", ".join(others) if len(others) < 5 and len(others) < len(ops) else ", ".join(ops)


def table(laser):
    known = {op: row for op, row in kerf.job_schema()["$defs"].items() if ("x-laser" in row) == laser}
    keys = dict.fromkeys(key for row in known.values() for key in row["properties"] if key != "op")
    lines = ["| key | value | default | of | meaning |", "|---|---|---|---|---|"]
    for key in keys:
        rows = {op: row["properties"][key] for op, row in known.items() if key in row["properties"]}
        cells = [
            f"`{key}`",
            grouped(rows, value_text),
            grouped(rows, default_text),
            operations_text(list(rows), list(known)),
            grouped(rows, lambda row: row["description"]),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def layout_table():
    rows = {key: row for key, row in kerf.job_schema()["properties"].items() if "x-layout" in row}
    lines = ["| key | value | meaning |", "|---|---|---|"]
    lines += [f"| `{key}` | {value_text(row)} | {row['description']} |" for key, row in rows.items()]
    return "\n".join(lines) + "\n"


def page(name):
    """The page with its table of keys as the rows are now."""
    text = (MANUAL / name).read_text()
    text = LAYOUT.sub(lambda match: match[1] + "\n" + layout_table() + "\n" + match[2], text)
    return BLOCK.sub(lambda match: match[1] + "\n" + table(PAGES[name]) + "\n" + match[2], text)


if __name__ == "__main__":
    for name in PAGES:
        (MANUAL / name).write_text(page(name))
