function sum(n, acc = 0) = n == 0 ? acc : sum(n - 1, acc + n);
echo(sum(10), sum(5000), sum(100000));
function count(n) = n == 0 ? "end" : let (m = n - 1) count(m);
echo(count(20000));
function down(n) = n <= 0 ? 0 : 1 + down(n - 1);
echo(down(500));
function ping(n) = n == 0 ? "ping" : pong(n - 1);
function pong(n) = n == 0 ? "pong" : ping(n - 1);
echo(ping(10001));
