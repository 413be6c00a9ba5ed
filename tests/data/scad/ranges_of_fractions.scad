// Quotients that are one ulp below a whole number still count the last value.
echo([for (i = [0:0.1:0.3]) i]);
echo(len([for (i = [1:0.1:1.7]) i]), len([for (i = [0:-0.1:-0.3]) i]), len([for (i = [0:0.1:0.29]) i]));
