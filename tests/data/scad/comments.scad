// a line
echo(1); // after
/* a
block */ echo(2 /* inside */ + 3);
/**/ echo("// no comment", "/* none */");
echo(4 /* a * / b */);
// echo("no");
/* // */ echo(5);
