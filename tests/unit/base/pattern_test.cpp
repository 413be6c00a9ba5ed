// Regular expressions: what they match, what is refused, and that none takes exponential time.
#include "base/pattern.h"

#include <chrono>
#include <gtest/gtest.h>
#include <string>

namespace kerf {
namespace {

Pattern pattern(std::string_view text, LetterCase letters = LetterCase::distinct) {
  std::string problem;
  auto p = Pattern::compile(text, letters, problem);
  EXPECT_TRUE(p) << text << ": " << problem;
  return p ? *p : *Pattern::compile("", letters, problem);
}

std::string found(std::string_view expression, std::string_view text) {
  const auto match = pattern(expression).search(text);
  return match ? std::string(text.substr(match->start, match->end - match->start)) : "none";
}

TEST(Pattern, FindsTheLeftmostMatchThatABacktrackingMatcherFinds) {
  EXPECT_EQ(found("b+", "aabbbcb"), "bbb");
  EXPECT_EQ(found("b+?", "aabbbcb"), "b");
  EXPECT_EQ(found("a|ab", "xab"), "a");
  EXPECT_EQ(found("ab|a", "xab"), "ab");
  EXPECT_EQ(found("(a|ab)(c|bcd)", "abcd"), "abcd");
  EXPECT_EQ(found("[^0-9]+", "12abc3"), "abc");
  EXPECT_EQ(found("\\d{2,3}", "1 1234"), "123");
  EXPECT_EQ(found("x{2}", "x"), "none");
  EXPECT_EQ(found("x{,2}", "x{,2}"), "x{,2}");
  EXPECT_EQ(found("^b", "ab"), "none");
  EXPECT_EQ(found("b$", "abab"), "b");
  EXPECT_EQ(found("\\bcat\\b", "concat cat"), "cat");
  EXPECT_EQ(found("[]x-]+", "a-]x"), "-]x");
  EXPECT_EQ(found("mm.*min", "(Sum: 5 mm ca. 1 min)"), "mm ca. 1 min");
  EXPECT_EQ(found(".", "\xC3\xBC"), "\xC3\xBC");
  EXPECT_EQ(found("(a*)*b", "aaab"), "aaab");
}

TEST(Pattern, GivesGroups) {
  const Pattern p = pattern("([0-9]{4})(?:[.]([0-9]+))?");
  EXPECT_EQ(p.groups(), 2u);
  const auto full = p.search("x8998.12");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->groups, (std::vector<std::string>{"8998", "12"}));
  EXPECT_EQ(full->start, 1u);
  EXPECT_EQ(full->end, 8u);
  const auto next = p.search("8998 8999", full->start + 1);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->groups, (std::vector<std::string>{"8999", ""}));
}

TEST(Pattern, MatchesTheWholeText) {
  const Pattern p = pattern("([0-9]{4})[.]([0-9]+)([A-Z])", LetterCase::ignored);
  EXPECT_TRUE(p.match_whole("8999.1P"));
  EXPECT_TRUE(p.match_whole("8999.01p"));
  EXPECT_FALSE(p.match_whole("8999.1PQ"));
  EXPECT_FALSE(p.match_whole("18999.1P"));
  EXPECT_TRUE(pattern("a|ab").match_whole("ab"));
}

TEST(Pattern, RefusesWhatIsNoExpression) {
  for (const char* text : {"(", ")", "a)", "[a", "*", "a**", "(?=a)", "(?<=a)b", "\\1", "a{3,2}", "a{5000}",
                           "\\", "[z-a]", "(?<name", "((((a{999}){999}){999}){999}){9}"}) {
    std::string problem;
    EXPECT_FALSE(Pattern::compile(text, LetterCase::distinct, problem)) << text;
    EXPECT_FALSE(problem.empty()) << text;
  }
  std::string problem;
  EXPECT_FALSE(Pattern::compile(std::string(100'000, '('), LetterCase::distinct, problem));
}

TEST(Pattern, NeedsNoExponentialTime) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(found("(a+)+b", std::string(5000, 'a')), "none");
  EXPECT_EQ(found("(a|a|aa)*c", std::string(5000, 'a')), "none");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace kerf
