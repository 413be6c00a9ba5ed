a = [1, 2, 3];
echo(a.x + a.y * a.z, [4, 5].y, ([1, 2] + [3, 4]).x, [[1, 2], [3, 4]].y.x);
f = [function(x) x + 1, function(x) x * 10];
echo(f[0](1), f[1](2), f.x(3));
echo(undef.x, "abc".x, [1].y);
