module give(v) { $v = v; children(); }
give(1) give(2) echo($v);
give(3) echo($v, $children);
module grid(n) { for (i = [0:n - 1]) { $i = i; children(); } }
grid(3) echo($i * $i);
module pass() { give(9) children(); }
pass() echo($v);
