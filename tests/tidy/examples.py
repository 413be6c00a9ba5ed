"""The bundled examples equal the output of their scripts."""
import subprocess
import sys

from sources import finish, root_of


def main():
    root = root_of(sys.argv)
    script = str(root / "examples/make_demo.py")
    run = subprocess.run([sys.executable, script], capture_output=True, text=True)
    same = run.stdout == (root / "examples/demo.nc").read_text()
    finish("examples", [] if same else ["demo.nc differs from the output of make_demo.py" + run.stderr])


if __name__ == "__main__":
    main()
