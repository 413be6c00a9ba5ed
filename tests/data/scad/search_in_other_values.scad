// Where search() has no vector to search in.
echo(search([1, 2], undef));
echo(search([1, 2, 3], 5));
echo(search([1, "a"], "aba"));
echo(search([], 5));
echo(search(undef, true));
echo(search([undef], [undef]));
// Numbers of six digits.
echo(-0, -999999, 1e6, 0.5, 1 / 3, 2 / 3, 0.000001, 123456.5, 123456.4999999, 999999.5, -1e300);
echo(2.5e-7, 1234565, 0.1234565, 1.000005, 100000.5, 0.00001234565, 1e-5, 1e15, 123456.5000000001);
