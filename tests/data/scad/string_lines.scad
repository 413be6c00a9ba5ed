echo("first
second");
echo("café", len("café"), "über"[0]);
