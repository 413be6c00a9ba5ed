*echo("disabled");
%echo("background");
#echo("highlight");
union() { *echo("no"); echo("yes"); }
module m() { echo($children); }
m() { *echo(1); %echo(2); echo(3); }
