"""Writes the example script, which uses every function, for editing.

    python3 -m cnc25d_api.example_generator [FOLDER]
"""

import shutil
import sys
from pathlib import Path

NAME = "cnc25d_api_example.py"


def main(arguments=None):
    """Copy the example into a folder (default: the current one); an existing file is not replaced."""
    arguments = sys.argv[1:] if arguments is None else arguments
    target = Path(arguments[0] if arguments else ".") / NAME
    if target.exists():
        print(f"{target} already exists; rename or remove it first", file=sys.stderr)
        return 1
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(Path(__file__).with_name(NAME), target)
    print(f"wrote {target}; run it with: python3 {target}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
