function make(n) = function(x) x * n;
a = make(2); b = make(3);
echo(a(10), b(10));
counter = [for (i = [1:3]) let (k = i) function() k];
echo([for (c = counter) c()]);
compose = function(f, g) function(x) f(g(x));
inc = function(x) x + 1;
echo(compose(inc, a)(5), compose(a, inc)(5));
y = 4;
late = function() y;
echo(late());
module m(f) { echo(f(2)); }
m(function(x) x + y); m(a);
