x = echo("first", 1) 5;
echo(x);
function f(n) = echo(n = n) n == 0 ? 0 : f(n - 1);
echo(f(2));
echo(a = 1, 2, b = "s", [3]);
echo();
y = echo("no value");
echo(y);
echo(echo("inner") 3);
