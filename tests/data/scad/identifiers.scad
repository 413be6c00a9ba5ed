_a = 1; a1 = 2; A = 3; a = 4; long_name_with_1234 = 5;
echo(_a, a1, A, a, long_name_with_1234);
$my = 6;
echo($my);
2d = 7;
echo(2d);
for1 = 8; iff = 9; lets = 10;
echo(for1, iff, lets);
