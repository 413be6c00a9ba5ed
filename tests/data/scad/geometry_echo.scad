module box(s) { echo(s); cube(s); }
translate([1, 2, 3]) { echo("moved"); box([1, 2, 3]); }
difference() { echo("first"); box(2); echo("second"); }
color("red") echo("red");
linear_extrude(5) { echo("profile"); square(3); }
rotate(90) scale(2) mirror([1, 0, 0]) echo("deep");
