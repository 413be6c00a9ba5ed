echo([for (i = 0; i < 5; i = i + 1) i]);
echo([for (a = 0, b = 1; a < 30; t = a + b, a = b, b = t) a]);
echo([for (i = 10; i > 0; i = i - 3) let (k = i * i) k]);
echo([for (i = 0; i < 4; i = i + 1) if (i != 2) i]);
echo([for (i = 0; false; i = i + 1) i]);
echo([for (i = 0, s = ""; i < 3; i = i + 1, s = str(s, i)) s]);
