module m(a, b = 2) { echo(a, b); }
m(1); m(1, 3); m(b = 4, a = 5); m(); m(1, 2, 3);
module outer() { v = 1; module inner() { echo(v, w); } w = 2; inner(); }
outer();
module twice() echo("first"); module twice() echo("second");
twice();
module rec(n) { if (n > 0) { echo(n); rec(n - 1); } }
rec(3);
module f() { function k(x) = x * z; z = 3; echo(k(4)); }
f();
