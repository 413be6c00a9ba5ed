// Undefined numbers in vectors and ranges are equal to all in an order, and equal to none.
n = 0 / 0;
a = [[n], [1], [n, 1], [n, 2], [1, n], [2, n], [n, n], []];
for (x = a) echo(x, [for (y = a) x < y], [for (y = a) x <= y], [for (y = a) x > y], [for (y = a) x >= y],
                 [for (y = a) x == y], [for (y = a) x != y]);
b = [[1:2], [1:n:2], [1:1:3], [n:2], [2:1], [0:2], [1:2:2]];
for (x = b) echo(x, [for (y = b) x < y], [for (y = b) x <= y], [for (y = b) x > y], [for (y = b) x >= y],
                 [for (y = b) x == y], [for (y = b) x != y]);
echo(-1 >= n, n <= 1, n >= n, [[n]] <= [[1]], [[n]] < [[1]]);
echo(max([[n], [1]]), min([[1], [n]]), max([n, 1]), max([1, n]), min([n, 1, 2]), min(1, n), max(n, 1));
