a = 1;
include <parts/values.scad>
base = 2;
echo(a, base, doubled);
