function s() = $r;
$r = 1;
echo(s(), s($r = 2), let ($r = 3) s(), s());
module m() { echo($r); n(); } module n() { echo($r); }
m(); m($r = 5);
module o() { $r = 6; n(); } o(); n();
echo($fn, $fa, $fs, $t);
module p() { echo($fn); } p($fn = 8); p();
echo([for ($r = [7:8]) s()]);
for ($r = [1, 2]) n();
function with($r) = s(); echo(with(11));
