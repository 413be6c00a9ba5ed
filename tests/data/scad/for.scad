for (i = [1:3]) echo(i);
for (i = [1, "a", [2]], j = [0:1]) echo(i, j);
for (c = "ab") echo(c);
for (i = 7) echo(i);
for (i = undef) echo("never");
for (i = []) echo("never");
for (i = [[1, 2], [3, 4]]) echo(i[0] + i[1]);
for (i = [1:2]) { a = i * 10; echo(a); }
for (i = [1:2]) { i = i + 100; echo(i); }
for (i = true) echo(i);
