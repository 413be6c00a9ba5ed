// Lengths and texts: what OpenSCAD 2021.01 prints.
echo(len([1:5]), len(undef), len("\u20ac"), concat(), concat(1,[2],[[3]]), concat(undef), concat([1:3]), concat("a"), str(), str(undef,[1:2],1/0), str([" "]), str("a\"b"));
