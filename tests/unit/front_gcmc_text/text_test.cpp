// Lexer and parser: tokens with their positions, the tree, and all errors of a source in one pass.
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "front/gcmc/text/parser.h"

namespace kerf::gcmc {
namespace {

struct Reports final : SourceReport {
  void error(SourceLocation at, Code, std::string message, std::string) override {
    add("error", at, message);
  }
  void warning(SourceLocation at, Code, std::string message) override { add("warning", at, message); }
  void fatal(SourceLocation at, Code, std::string message) override { add("fatal", at, message); }
  void add(const char* severity, SourceLocation at, const std::string& message) {
    all.push_back(std::to_string(at.line) + ":" + std::to_string(at.column) + " " + severity + ": " +
                  message);
  }
  std::vector<std::string> all;
};

TEST(GcmcLexer, TokensHaveTheirPositions) {
  Reports reports;
  Lexer lexer("x += 2.5mm; // rest\n  goto", 0, reports);
  const auto next = [&](Token token, std::uint32_t line, std::uint16_t column) {
    const Word word = lexer.next();
    EXPECT_EQ(word.token, token);
    EXPECT_EQ(word.at.line, line);
    EXPECT_EQ(word.at.column, column);
  };
  next(Token::identifier, 1, 1);
  next(Token::plus_assign, 1, 3);
  next(Token::real, 1, 6);
  next(Token::kw_mm, 1, 9);
  next(Token::semicolon, 1, 11);
  next(Token::identifier, 2, 3);
  EXPECT_EQ(lexer.next().token, Token::end);
  EXPECT_TRUE(reports.all.empty());
}

Tree parsed(const std::string& text, Reports& reports) {
  Tree tree;
  std::deque<Source> sources{{"t.gcmc", text}};
  Parser parser(
      tree, sources, reports, [](const std::string&, Source&, std::string&) { return false; },
      [](std::string_view name) { return name == "move"; });
  parser.parse(0);
  return tree;
}

TEST(GcmcParser, BuildsTheTree) {
  Reports reports;
  const Tree tree = parsed("move([1, 2]); if(1) { x = 2 * 3; }", reports);
  EXPECT_TRUE(reports.all.empty());
  ASSERT_EQ(tree.program.size(), 2u);
  const auto node = [&](NodeId id) { return tree.nodes[static_cast<std::size_t>(id)]; };
  EXPECT_EQ(node(tree.program[0]).kind, NodeKind::expression);
  EXPECT_EQ(node(node(tree.program[0]).a).kind, NodeKind::call);
  EXPECT_EQ(node(tree.program[1]).kind, NodeKind::if_else);
}

TEST(GcmcParser, OnePassReportsEveryError) {
  Reports reports;
  parsed("x = ;\ny = 1;\nz = );\n", reports);
  ASSERT_EQ(reports.all.size(), 2u);
  EXPECT_EQ(reports.all[0].substr(0, 2), "1:");
  EXPECT_EQ(reports.all[1].substr(0, 2), "3:");
}

}  // namespace
}  // namespace kerf::gcmc
