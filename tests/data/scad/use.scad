use <parts/values.scad>
echo(from_include(3));
echo(base);
show_value("y");
