function identity(n) = [for (i = [0:n - 1]) [for (j = [0:n - 1]) i == j ? 1 : 0]];
m = [[1, 2, 3], [0, 1, 4], [5, 6, 0]];
echo(identity(3) * m == m, m * [1, 0, 0], [1, 0, 0] * m);
function transpose(m) = [for (j = [0:len(m[0]) - 1]) [for (i = [0:len(m) - 1]) m[i][j]]];
echo(transpose(m), transpose([[1, 2], [3, 4], [5, 6]]));
function rot(a) = [[cos(a), -sin(a)], [sin(a), cos(a)]];
echo(rot(90) * [1, 0], rot(30) * rot(60), rot(45));
echo([[1, 2], [3]] * [1, 2], [[1, 2], 3] * [1, 2], [1, 2] * [[1, 2], [3]]);
