// The first value of a name counts, with "$" as without.
$a = 1;
b = 1;
echo(let($a = 2, b = 3, $a = 4) $a * b, let($a = 2, b = 3, b = 5) $a * b);
assign(c = 5) echo(c);
