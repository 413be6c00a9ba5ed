echo("abc", "", "a\"b", "tab\there", "line\nbreak", "back\\slash", "\u00e9", "\x41", "\U01F600");
echo(len("abc"), len(""), len("h\u00e9"), "h\u00e9llo"[1], "abc"[3], "abc"[-1]);
echo(str(), str(1), str("a", 1, true, undef, [1, "b"]), str([1:3]), str(1.50), str("\u00e9"));
echo(["a\"b", "c"], str(["a"]), str("a", ["b\n"]));
echo(chr(65), chr(65, 66), chr([67, 68]), chr([69:71]), chr(0), chr(-1), chr(8364), chr("a"), chr());
echo(ord("A"), ord("abc"), ord("\u20ac"), ord(""), ord(5), ord());
