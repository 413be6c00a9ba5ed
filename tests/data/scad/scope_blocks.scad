x = 1;
if (true) { x = 2; echo(x); y = 3; echo(y); }
echo(x, y);
{ z = 4; }
echo(z);
module m() { x = 10; echo(x); if (true) { x = x + 1; echo(x); } echo(x); }
m();
echo(x);
union() { x = 20; echo(x); }
