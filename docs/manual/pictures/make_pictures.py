"""Makes the pictures of the README and the manual from the bundled examples.

    make_pictures.py KERF FOLDER [NAME...]

KERF is the command, FOLDER receives the pictures, NAMEs (without ending) select some of them.
`./dev pictures` makes all in this folder.
"""
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
SIZE = (640, 400)  # pixels
COLOURS = 64  # of the palette: small files

OPERATIONS = ("pocket", "contour", "chamfer", "isolation", "engrave", "face", "drill", "bore", "keyhole",
              "slot", "trochoidal-slot", "thread", "countersink", "vcarve", "vcarve-floor", "raster",
              "waterline", "project")
LASER = ("laser", "laser-cut", "laser-fill", "laser-picture", "laser-test")  # their burn is shown

# Name of the picture, and the commands that make it, after one another: {examples} is the folder of examples,
# {out} the picture. What a command before the last one prints is kept as job.toml.
PICTURES = {
    "demo": "simulate {examples}/demo.nc -o {out}",
    **{name: f"run {{examples}}/gcodepreview/{name}.py -o {{out}}"
       for name in ("box", "commands", "hanger", "relief", "sign")},
    "tray-top": "run {examples}/gcodepreview/tray.py -o {out}.glb",  # a file that the script writes
    **{f"op-{name}": f"cut --example {name}; simulate job.toml -o {{out}}" for name in OPERATIONS},
    **{f"op-{name}": f"cut --example {name}; simulate job.toml -o {{out}} --show burn --spot 0.15"
       for name in LASER},
    # The program written without a post's comments on the stock: it is given again.
    "passes": "post --to grbl --lead 3 --finish 0.3 --step-down 2 --tab-height 1.5 {examples}/one_pass.nc "
              "-o {out}.nc; simulate {out}.nc --stock '-14,-10,-6 to 70,50,0' -o {out}",
    "print-kinds": "simulate {examples}/../tests/data/gcode/slicer/star.gcode --colour kind -o {out} "
                   "--view -30,40",
    "grid-bin": "run {examples}/python/grid_bin.py bin.gcode {out}",
    **{name: f"simulate {{examples}}/{name}.toml -o {{out}}"
       for name in ("adaptive", "inlay", "rest", "shell", "text")},
    **{f"job-{name}": f"simulate {{examples}}/jobs/{name}.toml -o {{out}} --view iso"
       for name in ("sign", "pcb", "relief", "inlay", "box")},
    **{f"path-{number}": f"simulate {{examples}}/path/{number}.1P.dxf -o {{out}} --spoilboard 3"
       for number in ("9001", "9002", "9003", "9004", "9005", "9006", "9008", "9009")},
}


def make(kerf, name, folder):
    """Runs the command of one picture and writes it with a palette; findings are no errors here."""
    from PIL import Image  # only here: the table is read where Pillow is not installed

    with tempfile.TemporaryDirectory() as scratch:
        out = Path(scratch, name + ".png")
        for command in PICTURES[name].split(";"):
            words = [word.format(examples=EXAMPLES, out=out) for word in shlex.split(command)]
            done = subprocess.run([kerf, *words], cwd=scratch, capture_output=True, text=True,
                                  env={**os.environ, "KERF_PYTHON": sys.executable})
            Path(scratch, "job.toml").write_text(done.stdout)
        if not out.exists():
            sys.exit(f"{name}: {PICTURES[name]}: {done.stderr}")
        picture = Image.open(out).convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)
        picture.quantize(COLOURS, dither=Image.Dither.NONE).save(Path(folder, name + ".png"), optimize=True)


def main():
    kerf, folder, *names = sys.argv[1:]
    unknown = [name for name in names if name not in PICTURES]
    if unknown:
        sys.exit(f"no such picture: {', '.join(unknown)}; there are {', '.join(PICTURES)}")
    for name in names or PICTURES:
        make(str(Path(kerf).resolve()), name, folder)
        print(Path(folder, name + ".png"))


if __name__ == "__main__":
    main()
