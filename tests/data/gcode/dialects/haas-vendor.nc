%
O01001 (PART)
(Machine)
(  vendor: Haas Automation)
(  model: VF-2)
G21 G90
T1 M6
S5000 M3
G0 X0 Y0
G0 Z5
G1 Z-1 F100
G1 X10
G0 Z5
M30
%
