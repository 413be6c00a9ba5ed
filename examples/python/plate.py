"""Loads a gcmc program, checks it, writes it for GRBL and draws what it makes."""
import sys

import kerf

source, gcode, picture = sys.argv[1:]
program = kerf.load(source, defines=["depth=3mm"])
for finding in kerf.check(program):
    print(f"{finding['origin']}: {finding['message']}")
kerf.post(program, "grbl", gcode)
kerf.simulate(program, resolution=0.2).save(picture, view="iso")
minutes = kerf.estimate(program)["total"] / 60
print(f"{len(program)} steps, about {minutes:.1f} minutes")
