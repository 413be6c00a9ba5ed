;;;
echo(1);;
{}
{ echo(2); { echo(3); } ; }
module nothing() {} nothing();
module one() echo(4); one();
if (true) {}
for (i = [1:2]) {}
union() {}
union();
