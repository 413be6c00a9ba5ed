q = 7;
function f(a, b = q, c = [1, 2], d = b) = [a, b, c, d];
b = 3;
echo(f(1), f(1, 2), f(1, c = 0), f(d = 4));
module m(a = 1, b = q + 1) { echo(a, b); }
m(); m(5); m(b = 2); m(undef, undef); m(b = 1, a = 2);
