(A plate of 60 x 40 mm with a hole of 24 mm, each cut in one pass at the full depth:)
(kerf post cuts it in passes with leads and tabs, see docs/manual/passes.md)
(STOCK/BLOCK,84,60,6,14,10,6)
(T1 D=6 - square mill)
G21 G90 G17
T1 M6
M3 S12000
G0 Z5
G0 X-3 Y20
G0 Z1
G1 Z-6 F200
G1 X-3 Y40 F800
G2 X0 Y43 I3 J0
G1 X60
G2 X63 Y40 I0 J-3
G1 Y0
G2 X60 Y-3 I-3 J0
G1 X0
G2 X-3 Y0 I0 J3
G1 Y20
G0 Z5
G0 X39 Y20
G0 Z1
G1 Z-6 F200
G3 X39 Y20 I-9 J0 F800
G0 Z5
M5
M2
