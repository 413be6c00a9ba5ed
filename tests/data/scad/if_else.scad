if (1) echo("a"); else echo("b");
if (0) echo("a"); else echo("b");
if (0) echo("a"); else if (1) echo("b"); else echo("c");
if (false) { echo("x"); } else { echo("y"); echo("z"); }
if (undef) echo("u"); if ("") echo("e"); if ([]) echo("v"); if ("a") echo("s");
if (true) { if (false) echo(1); else echo(2); }
if (true); else echo("never");
