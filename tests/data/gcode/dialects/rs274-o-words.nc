(for 3 parts, rows: GOTO 5, IF [any])
G21 G90
O100 while [#1 LT 3]
#1=[#1+1]
O100 endwhile
O101 if [#1 GT 1] 
G0 X1 Y2
O101 endif
M2
