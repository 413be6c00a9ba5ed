echo("a");
!echo("root");
echo("b");
