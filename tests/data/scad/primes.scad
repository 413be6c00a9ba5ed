function prime(n, d = 2) = n < 2 ? false : d * d > n ? true : n % d == 0 ? false : prime(n, d + 1);
echo([for (i = [0:50]) if (prime(i)) i]);
