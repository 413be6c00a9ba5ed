echo(abs(-1.5), abs(0), sign(-3), sign(0), sign(2), floor(-1.5), ceil(-1.5), round(2.5), round(-2.5), round(0.49));
echo(sqrt(16), sqrt(2), sqrt(-1), exp(0), exp(1), ln(1), ln(0), ln(-1), log(1000), log(0), pow(2, 10), pow(2, 0.5), pow(-1, 0.5));
echo(min(3, 1, 2), max(3, 1, 2), min([4, 2, 8]), max([4, 2, 8]), min(5), max([7]), min([]), max("a"), min(1, "a"), min());
echo(norm([3, 4]), norm([1, 2, 2]), norm([]), norm(["a"]), norm(5), norm([-5]));
echo(cross([1, 0, 0], [0, 1, 0]), cross([1, 2, 3], [4, 5, 6]), cross([1, 2], [3, 4]), cross([1], [2]), cross(1, 2));
echo(floor(1e300), round(1e15 + 0.3), ceil(1 / 0), abs("a"), sqrt("a"), pow(1), exp());
