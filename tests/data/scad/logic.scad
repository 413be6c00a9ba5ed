echo(true && false, true || false, !true, !0, !"", ![], !"a", ![0], !undef, !!1);
echo(1 && "a", 0 || "", undef || 5, [] && 1);
echo(true ? 1 : 2, false ? 1 : 2, undef ? 1 : 2, [] ? 1 : 2, [0] ? 1 : 2, "" ? 1 : 2, "0" ? 1 : 2, (0 / 0) ? 1 : 2, [1:0:1] ? 1 : 2);
echo(true ? false ? 1 : 2 : 3, false || true && false, 1 < 2 == true);
