// A program with its stock and tool in comments: a straight slot in a plate. The tests edit its lines.
export const PLATE = `(stockMin:0.00mm, 0.00mm, -6.00mm)
(stockMax:40.00mm, 30.00mm, 0.00mm)
G21 G90 G17
T102 M6
M3 S10000
G0 X5 Y10 Z5
G1 Z-1 F100
G1 X35 F400
G0 Z5
M2
`;
