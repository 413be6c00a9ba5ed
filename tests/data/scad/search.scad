echo(search("a", "abcdabcd"), search("e", "abcd"), search("a", "abcdabcd", 0), search("a", "abcdabcd", 1), search("abc", "abcdabcd"), search("ab", "abcdabcd", 2));
d = [["a", 1], ["b", 2], ["c", 3], ["d", 4], ["a", 5], ["b", 6], ["e", 3]];
echo(search("a", d), search("abc", d), search("a", d, 0), search("abe", d, 0));
echo(search(3, d, 0, 1), search(3, d, 1, 1), search([3, 4], d, 0, 1), search([3, 9], d, 1, 1));
echo(search(["b"], d), search(["zz"], d), search(["a", "e"], d, 0));
echo(search(2, [1, 2, 3, 2]), search(2, [1, 2, 3, 2], 0), search([1, 2], [[1, 2], [3]]), search([[1, 2]], [[1, 2], [3]]));
echo(search("", "abc"), search([], [1]), search(5, "abc"), search("a", 5));
