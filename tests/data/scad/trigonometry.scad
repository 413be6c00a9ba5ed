echo([for (a = [-90:30:360]) sin(a)]);
echo([for (a = [-90:30:360]) cos(a)]);
echo([for (a = [-60:30:60]) tan(a)], tan(90), tan(270), tan(-90), tan(45), tan(135));
echo(sin(45), cos(45), sin(1), cos(1), sin(1e10), cos(123456789), sin(0.001));
echo(asin(0.5), asin(1), asin(2), acos(0.5), acos(-1), atan(1), atan(-1), atan(1e300));
echo(atan2(1, 1), atan2(0, -1), atan2(-1, 0), atan2(0, 0), atan2(1, 0), atan2(3, 4));
echo(sin(30) == 0.5, cos(60) == 0.5, sin(180) == 0, cos(90) == 0, tan(45) == 1, sin(360) == 0, asin(0.5) == 30);
echo(sin(1 / 0), cos(0 / 0), sin("a"), sin(), sin(1, 2), sin([1]));
