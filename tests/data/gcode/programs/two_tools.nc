(two tools: a slot, then its chamfer)
G21 G90
T1 M6 (6mm endmill)
M3 S8000
G0 X0 Y0 Z5
G1 Z-3 F150
X50 F500
G0 Z5
M5
M1
T3 M6 (90 degree 12mm v-bit)
M3 S10000
G4 P1.5
G0 X0 Y0
G1 Z-2 F150
X50 F500
G0 Z5
M5
M30
