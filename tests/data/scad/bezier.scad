function b(p, t) = len(p) == 1 ? p[0] : b([for (i = [0:len(p) - 2]) p[i] * (1 - t) + p[i + 1] * t], t);
echo([for (t = [0:0.25:1]) b([[0, 0], [10, 0], [10, 10]], t)]);
