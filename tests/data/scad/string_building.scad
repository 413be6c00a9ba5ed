function join(l, s = ", ", i = 0) = i == len(l) ? "" : str(i == 0 ? "" : s, l[i], join(l, s, i + 1));
echo(join(["a", "b", "c"]), join([1, 2], "-"), join([]));
function repeat(s, n) = n <= 0 ? "" : str(s, repeat(s, n - 1));
echo(repeat("ab", 4));
function upper(s) = chr([for (c = s) let (o = ord(c)) o >= 97 && o <= 122 ? o - 32 : o]);
echo(upper("Hello, world"));
function index(s, c) = [for (i = [0:len(s) - 1]) if (s[i] == c) i];
echo(index("banana", "a"));
