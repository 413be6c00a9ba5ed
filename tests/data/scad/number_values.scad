// number values: what OpenSCAD 2021.01 prints.
echo(parent_module(), parent_module(0), parent_module("a"), parent_module(-1), parent_module(1/0));
echo(chr(65.7), chr(-1), chr([65,[66]]), chr("a"), chr(65,66), chr([65:68]), chr(0), chr(1114112), chr(55296), chr(1/0), chr(true));
echo(ord("ab"), ord(""), ord("\u20ac"));
echo(lookup(1,[]), lookup(1,[[0,1]]), lookup(1/0,[[0,1],[2,5]]), lookup(-1/0,[[0,1],[2,5]]), lookup(0/0,[[0,1],[2,5]]), lookup(1,[[2,5],[0,1]]), lookup(1,[[0,1],"a",[2,3]]), lookup(1,[[0,1,9],[2,3]]), lookup(1,[["a",1],[2,3]]), lookup(1,[[0,"a"],[2,3]]), lookup(1,[[1,5],[1,7]]),lookup(1,[[0,1],1]));
echo(norm([]), norm([1,"a"]), norm([1/0]), norm([[3,4]]), norm([0/0]));
echo(min(), max(), min([]), min([1,"a"]), max(["a",1]), max(["a","b"]), min([[1,2],[0,5]]), min(0/0,1), min(1,0/0), max(0/0,1), max(1,0/0), max([1,0/0]), max([0/0,1]), max([1:3]), min([true,false]), min([undef,1]), min([1,undef]), max([[1],2]),min("abc"));
echo(abs(-0), sign(-0), sign(0/0), floor(1/0), round(-0.5), round(0.5), round(2.5), round(-2.5), sqrt(-1), ln(0), ln(-1), exp(1000), pow(-8,1/3), pow(0,0), pow(2,-1), 0^0, (-8)^(1/3), 2^0.5, 5%3, -5%3, 5%-3, 5.5%2, 5%0, 1/0%2, 5%(1/0));
echo(atan2(0,0), atan2(0,-1), atan2(-0,-1), atan2(1,0), atan2(1/0,1/0), asin(2), acos(1), acos(0.5), asin(0.5), atan(1), atan(1/0), sin(1e10), cos(1e20), tan(90), tan(45), tan(-45), sin(30), cos(60), sin(360), sin(-180), cos(90), tan(135),cos(-1/0));
echo(123456, 1234567, 0.000012345, 1e5, 1e6, 1e21, 0.1+0.2, 1/3, -1e-7, 100000.5, 999999.5, 0.99999999, 1.7976931348623157e308);
echo(rands(0,1,2,5), rands(1,0,2,5), rands(0,10,3,-1), rands(0,1,0,1), rands(0,1,2.9,1), rands(0,1,1,0.5), rands(5,5,2,1), rands(0,1,2,"a")==undef, rands(0,1,-2,1));
