use <parts/values.scad>
use <parts/other.scad>
echo(from_include(1), own());
function own() = "mine";
module show_value(v) echo("mine", v);
show_value(1);
