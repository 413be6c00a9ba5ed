#1=2 #<depth> = [#1 * [2 + 1]]
G1 X#1 Y[1+2] Z-#<z> Jatan[1]/[2]
O100 sub
O100 endsub
o<x> call [1]
