for (i = [1:2]) for (j = [i:3]) if (i != j) echo(i, j); else echo("same", i);
for (i = [0:1], j = [i:1]) echo(i, j);
intersection_for (i = [1:2]) echo("in", i);
for (i = [0:2]) let (k = i * i) echo(k);
