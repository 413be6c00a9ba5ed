// children scope: what OpenSCAD 2021.01 prints.
module n(a, x) { echo("n", a, x, $t, $s); children(); }
x = 1; y = 2;
n(x) { x = 5; echo(x); }
n(a=y) { y = x+5; echo(y); }
n($t) { $t = 5; echo($t); }
module c($u=3) { $s=9; children(); $s2=4; echo($s,$s2,$u); }
c() { $s=1; $u=2; echo($s,$u); }
c($t=7, $s=6, $u=$t) { $t=1; echo($s,$t,$u); }
c($s=6) { echo($s); }
c($s=$t, $t=3) { $t=4; echo($s,$t); }
module d() { translate([0,0]) children(); }
d() { $s=1; k=$s+1; echo($s,k); }
module e() { $s=2; for(i=[0,1]) { $s=i; children(); } }
e() { $s=11; k=$s+1; echo($s,k); }
e() { k=$s; echo($s,k); }
translate([x,0], $t=x) { x=3; $q=8; echo(x,$t,$q); }
translate([echo(x,$q) x,0], $t=x) { x=3; $q=8; $t=5; echo(x,$t,$q); }
module f() { echo(x, $children, y); }
f() { x = 4; y=7; }
module g() { module h() echo("h", $s); h(); children(); h() {$s=3;} }
g() { $s=12; echo($s); }



for (i=[0,1]) n(i) { i = 5; echo(i); }
n(k) { k = function(q) q+x; x = 7; echo(k(1)); }
if (x==1) { x = 2; echo(x); } else { x=3; echo(x); }
module p() { if (true) { $z=1; children(); } let($z=2) children(); }
p() { w = $z; echo(w, $z); }
p() { $z = 6; w = $z; echo(w, $z); }
if (x==1) { x = echo("inif") 2; echo(x); }
union() { x = 3; y = x; n() { x = 4; z = x; echo(x,y,z); } }
module q() { n() { y = 20; children(); echo(y); } }
q() { y = 30; echo(y); }
module n(a) { echo("n", a, $s, $children); }
module c(a) { echo("c"); children(); echo("d"); children(0); }
n(echo("arg") 1) { x = echo("x") 1; echo("child"); }
n(echo("arg") 1) { $s = echo("$s") 1; x = echo("x") $s;  echo("child"); }
n() { $s = 7; x = echo("x", $s) $s;  }
echo("--c");
c(echo("arg") 1) { $s = echo("$s") 1; x = echo("x") 1;  echo("child", $s, x); }
echo("--tr");
translate([echo("arg") 1, 0]) { $s = echo("$s") 1; x = echo("x") 1;  echo("child", $s, x); }
echo("--for");
for (i=[0,1]) { $s = echo("$s") 1; x = echo("x") 1;  echo("child", $s, x); }
n() { $s = echo("$s", is_undef(y)) 1; y = 3; $t = echo("$t") 4; echo("child"); }
