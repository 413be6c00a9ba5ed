function f(x) = assert(is_num(x), "number") x;
module m(x) { echo("in"); echo(f(x)); echo("out"); }
m(1);
m("a");
m(2);
