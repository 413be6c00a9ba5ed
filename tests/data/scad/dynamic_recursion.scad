module tree(n, depth = 0) { echo(n, depth, $parent_modules); if (n > 1) { tree(n - 1, depth + 1); } }
tree(3);
function hanoi(n, a, b, c) = n == 0 ? 0 : hanoi(n - 1, a, c, b) + 1 + hanoi(n - 1, c, b, a);
echo(hanoi(8, "a", "b", "c"));
function gcd(a, b) = b == 0 ? a : gcd(b, a % b);
echo(gcd(1071, 462), gcd(17, 5));
function ack(m, n) = m == 0 ? n + 1 : n == 0 ? ack(m - 1, 1) : ack(m - 1, ack(m, n - 1));
echo(ack(2, 3));
