echo([5:1]);
for (i = [3:1]) echo(i);
echo([for (i = [2:0]) i]);
