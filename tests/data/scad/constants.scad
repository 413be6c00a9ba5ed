echo(PI, undef, true, false, version(), version_num());
echo(2 * PI, sin(PI), PI == 3.141592653589793);
PI = 3;
echo(PI);
