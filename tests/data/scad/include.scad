include <parts/values.scad>
echo(base, from_include(3));
base = 20;
show_value("x");
