( post: Mach3 Mill, mm )
G21 G90
M3 S8000
G0 Z5
G1 X5 F100
M30
