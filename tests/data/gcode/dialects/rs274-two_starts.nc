(a router that is stopped to turn the part: heights set by hand)
G21 G90
T1
M3 S12000
G1 X20 F600
M5
M0
M3 S12000
G1 X0 F600
M5
M2
