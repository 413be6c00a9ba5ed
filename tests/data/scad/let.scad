echo(let (a = 1, b = a + 1) [a, b], let (a = 3) let (b = a) a * b, let () 5);
a = 10;
echo(let (a = a + 1) a, a);
let (x = 1, y = x + 1) echo(x, y);
let (x = 5) { y = x * 2; echo(x, y); }
echo(let (a = 1, a = 2) a);
function f(n) = let (m = n * 2, k = m + 1) m * k;
echo(f(3));
