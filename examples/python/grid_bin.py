"""Prints a bin of 4 x 8 units for a drawer, with rounded corners and walls that taper at the floor:
grid_bin.py BIN.gcode BIN.png"""
import sys

import kerf

WIDTH, HEIGHT = 1.2, 0.4  # mm, of the beads
UNIT, COLUMNS, ROWS, TOP = 25, 4, 8, 13.2  # mm
GAP, RADIUS = 0.05, 6.85  # mm, between two bins and of the outer corners

length, depth, inset = COLUMNS * UNIT - GAP, ROWS * UNIT - GAP, RADIUS
core = kerf.Region([[(inset, inset), (length - inset, inset), (length - inset, depth - inset),
                     (inset, depth - inset), (inset, inset)]])
printer = kerf.Printer(WIDTH, HEIGHT, speed=2400, max_flow=8, travel_speed=1200 * 5, retract=0.8, hop=0.4)
printer.start(nozzle=210, bed=50)
taper = 0.4 * WIDTH  # of the lowest layer
while printer.z < TOP - HEIGHT / 2:
    layer = round(printer.next_layer() / HEIGHT)
    outside = core.offset(RADIUS - taper)
    inside = printer.walls(outside, 2 if layer < 5 else 1)
    if layer <= 2:
        printer.path.fan(1.0)
        printer.fill(inside, angle=90 * (layer - 1))
    taper = max(taper - WIDTH * HEIGHT / 2, 0)
printer.iron(outside - inside, spacing=WIDTH / 4)
printer.finish(lift=20)

printed = kerf.simulate_print(printer.path)
total = printed.total
print(f"{printed.roads} beads, {total['extruded_mm3']:.0f} mm3, overlap "
      f"{100 * total['overlap_mm3'] / total['extruded_mm3']:.2f}%, hollow {total['hollow_mm3']:.1f} mm3")
printed.save(sys.argv[2], view="iso")
kerf.post(printer.path, "marlin", sys.argv[1])
