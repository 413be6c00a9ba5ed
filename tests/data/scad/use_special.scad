use <parts/special.scad>
$k = 1;
echo(read_k(), read_k($k = 5));
show_k();
show_k($k = 6);
