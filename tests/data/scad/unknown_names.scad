echo(nope);
echo(nope + 1);
echo(nofunc(1));
nomodule();
echo($nospecial);
nomodule2() echo("child");
echo(is_undef(nope), is_undef($nospecial), is_undef(undef), is_undef(1));
