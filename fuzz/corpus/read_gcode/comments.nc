(MSG, hi) G0 X1 (a (b)) (c
(TOOL/MILL, 3.175, 0, 12.7, 0)
M6T1
; tail
(stockMin: 0, 0, -1mm)
(stockMax: 10, 10, 0)
(STOCK/BLOCK, 10, 10, 1, 0, 0, 1)
M6 T2
(TOOL/CRMILL, 0.5, 6, 3, 8, 3)
(TOOL/DRILL, 3, 118, 10)
M2