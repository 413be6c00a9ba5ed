// A number that is undefined has no order.
n = 0 / 0;
echo(-1 >= n, n <= 1, n >= n, n <= n, n < 1, n > 1, n == n, n != n);
echo([n] <= [1], [1, n] > [0, 2]);
