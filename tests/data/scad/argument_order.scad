function t(n, v) = echo(n) v;
function f(a, b, c) = [a, b, c];
echo(f(t("a", 1), 2, 3));
echo([t("x", 1), t("y", 2)], t("l", false) && t("r", true), t("l", true) || t("r", true), t("c", true) ? t("y", 1) : t("n", 2));
