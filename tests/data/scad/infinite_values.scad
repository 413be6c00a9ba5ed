inf = 1 / 0; nan = 0 / 0;
echo(inf, -inf, nan, inf - inf, inf * 0, nan == nan, inf == inf, inf > 1e308, nan < 1, nan > 1, !nan);
echo([for (i = [0:nan]) i], [for (i = [nan:3]) i], min(inf, 1), max(-inf, 1), floor(inf), str(inf), round(nan));
echo([1, 2][inf], [1, 2][nan], "ab"[inf], chr(inf), inf % 2, 5 % inf);
