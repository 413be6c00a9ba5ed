x = 1;
function f(x) = let (x = x + 1) let (x = x * 10) x;
echo(f(1), f(x), x);
echo([for (x = [1:2]) for (x = [x * 10, x * 20]) x], x);
module m(x) { x = x + 1; echo(x); }
m(5);
function sin(x) = "own"; echo(sin(30));
module echo2(len) { echo(len); } echo2(len = 3);
len = 4; echo(len, len("ab"));
