// children number: what OpenSCAD 2021.01 prints.
module c() { echo("c",$children); children(); }
module w() { c() { echo("in w", $children); echo(2); echo(3); } }
w() { circle(1); circle(2); }
function f() = $children;
module v() { echo(f(), $children); c() { echo(f()); } }
v() { circle(1); circle(2); circle(3);}
echo($children, f());
c() { echo($children); $children = 7; echo($children); }
module e($children=5) { echo($children); children(); }
e() { echo($children); }
e($children=4) { echo($children); }
module g() { let($children=3) { echo($children); children(); } for($children=[1]) echo($children); }
g() { echo($children); }
echo(let($children=3) $children, let($children=3) f());
translate([0,0], $children=8) echo($children);
$children = 11; echo($children);
h = function() $children;
module k() { echo(h()); }
k() { circle(1); circle(2); }
