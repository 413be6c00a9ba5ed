module show() { echo($children); children(); }
show() { echo("a"); echo("b"); }
show() echo("one");
show();
module first() { children(0); }
first() { echo("x"); echo("y"); }
module some() { children([1, 0]); children([0:1]); }
some() { echo(0); echo(1); echo(2); }
module each_child() { for (i = [0:$children - 1]) { echo(i); children(i); } }
each_child() { echo("p"); if (true) { echo("q"); echo("r"); } for (k = [1:2]) echo(k); }
module nest() { show() { children(); echo("in"); } }
nest() echo("top");
show() { a = 5; echo(a); echo(a + 1); }
