// Used and included by the programs beside this folder.
base = 10;
doubled = base * 2;
function from_include(x) = x * base;
module show_value(v) { echo("value", v, base); }
echo("in parts");
