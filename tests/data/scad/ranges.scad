r = [1:5];
echo(r, [0:2:10], [5:-1:1], [0:0.25:1], [1:1], [1:0:1], [0:0.1:0.3]);
echo(r[0], r[1], r[2], r[3], r.begin, r.step, r.end, r.x, len(r));
echo([for (i = [1:5]) i], [for (i = [0:2:9]) i], [for (i = [5:-2:0]) i], [for (i = [0:0.25:1]) i], [for (i = [3:3]) i]);
echo([for (i = [5:1:1]) i], [for (i = [1:-1:5]) i], [for (i = [0:0.1:1]) i], len([for (i = [0:0.1:1]) i]));
echo([1:"a"], [undef:3], [1:undef:3]);
