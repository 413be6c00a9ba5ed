use <parts/varying.scad>
$scale = 5;
echo(lib_double(), lib_double($scale = 7));
lib_show($scale = 9) { $size = 4; echo($size, $scale); }
f = keep($scale = 11);
echo(f());
$size = 8;
lib_show();
