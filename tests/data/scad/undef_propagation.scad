u = undef;
echo(u + 1, u * 2, u[0], u.x, -u, !u, u == u, u ? 1 : 0, len(u), str(u), [u, u], concat(u), u < 1);
function f(x) = x.y; echo(f([1]), f(5), f());
echo(sin(u), max(u), abs(u), norm(u), sqrt(u), round(u));
