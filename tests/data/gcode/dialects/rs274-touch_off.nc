(touch off by G38.2, a spindle set by hand)
G21 G90
G38.2 Z-20 F100
G92 Z0
G0 Z5
M3
G0 X0 Y0
G1 Z-1 F100
X10
G0 Z5
M5
M30
