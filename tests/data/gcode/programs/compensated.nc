(the outside of a square, compensated to the left)
G21 G90 G17 G40
T4 M6 (4mm endmill)
S9000 M3
G0 X-20 Y-20 Z5
G1 Z-2 F150
G41 D4 X-10 Y0 F600
G1 X0 Y0
Y30
X30
Y0
X-10
G40 G0 Z5
M5
M30
