// A file whose variables depend on the special variables of the caller.
$size = echo("$size") 3;
double = echo("double") 2 * $scale;
function lib_double() = [double, $size, inner()];
function inner() = double + 1;
module lib_show() { echo(double, $size, lib_double()); children(); }
function keep() = function() double;
