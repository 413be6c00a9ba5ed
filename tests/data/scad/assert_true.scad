assert(true);
assert(1 == 1, "never");
a = assert(true) 5;
echo(a, assert(1) 6, assert(true, "m") assert(2) 7);
assert(true) echo("child");
function f(x) = assert(x > 0, "positive") sqrt(x);
echo(f(4));
