// Blocks within blocks have no scope of their own.
if (true) { { echo(1); } }
union() { { echo(2); { echo(3); } } a = 4; }
{ echo(5); }
for (i = [6]) { { echo(i); } echo(7); }
