t = [[-200, 5], [-50, 20], [-20, 18], [80, 25], [150, 2]];
echo(lookup(-300, t), lookup(-200, t), lookup(-125, t), lookup(0, t), lookup(80, t), lookup(100, t), lookup(150, t), lookup(1000, t));
echo(lookup(1, [[1, 10]]), lookup(5, [[1, 10]]), lookup(2, [[3, 30], [1, 10]]));
