echo(function(x) x, function() 1, function(a, b = 2) a + b * 3, function(x) -x, function(x) !x);
echo(function(x) x > 1 ? "a" : "b\n", function(x) [x, 1], function(x) [1:x], function(x) [1:2:x], function(x) x[0].y);
echo(function(x) f(x, k = 1), function(x) let (a = x) a, function(x) assert(x > 0, "m") x, function(x) echo("e") x);
echo(function(x) [for (i = x) i], function(x) [for (i = [1:3]) if (i > 1) i else 0], function(x) [each x], function($k) $k);
echo(function(x) (x + 1) * 2 && x || x, function(x) x ^ 2 % 3, function(x) undef, function(x) true, function(x) 1.5e10);
