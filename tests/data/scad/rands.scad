echo(rands(0, 1, 3, 42), rands(-5, 5, 4, 1), rands(10, 20, 2, 0), rands(0, 1, 0, 5), rands(3, 3, 2, 1));
echo(len(rands(0, 1, 5)), rands(5, 1, 2, 7));
a = rands(0, 10, 100);
echo(min(a) >= 0, max(a) < 10);
