(Klipper, hull of a model ship)
G21 G90
M3 S8000
G0 Z5
G4 P2
G1 X5 F100
M2
