// From words to the syntax tree, by recursive descent. After an error it continues with the next statement.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/gcmc/text/ast.h"
#include "front/gcmc/text/lexer.h"

namespace kerf::gcmc {

/// A text of a program: its name for messages, and its bytes.
struct Source {
  std::string name;
  std::string bytes;
};

/// Finds an included file. False if there is none; `problem` is the reason if there is one that cannot be
/// read.
using Includer = std::function<bool(const std::string& name, Source& found, std::string& problem)>;
/// True for the name of a built-in function.
using IsBuiltin = std::function<bool(std::string_view name)>;

class Parser {
 public:
  Parser(Tree& tree, std::deque<Source>& sources, SourceReport& report, Includer includer,
         IsBuiltin is_builtin);
  /// Reads all statements of sources[file] and appends them to the program.
  void parse(std::uint16_t file);

 private:
  struct Failure {};  // thrown at a syntax error, caught by the loop over statements

  // words
  NodeId add(Node n, const std::vector<NodeId>& children = {});
  void advance();
  const Word& peek();
  bool is(Token token) const { return word_.token == token; }
  bool accept(Token token);
  bool expect(Token token, std::string_view shown, std::string hint = {});
  [[noreturn]] void fail(std::string message, std::string hint = {});
  void report_error(std::string message, std::string hint = {});
  void synchronise();
  void skip_braces();
  NameId expect_name(std::string_view what);

  // statements
  void lines(std::vector<NodeId>& into, Token until);
  void line(std::vector<NodeId>& into);
  bool compound(std::vector<NodeId>& into);
  NodeId body();
  NodeId condition();
  /// The node of a statement whose keyword has been read.
  Node statement_node(NodeKind kind, SourceLocation at);
  NodeId parse_if(SourceLocation at);
  NodeId parse_for(SourceLocation at);
  NodeId parse_while(SourceLocation at);
  NodeId parse_do(SourceLocation at);
  NodeId parse_foreach(SourceLocation at);
  NodeId parse_repeat(SourceLocation at);
  void parse_function(std::vector<NodeId>& into);
  NodeId parse_function_body(FunctionTree function);
  Parameter parameter(bool& presets_began);
  NodeId parse_return(SourceLocation at);
  void declarations(std::vector<NodeId>& into, NodeKind kind);
  void include(std::vector<NodeId>& into);
  void include_file(const std::string& name, SourceLocation at, std::vector<NodeId>& into);
  void expression_statement(std::vector<NodeId>& into);

  // expressions
  NodeId expression();
  NodeId assignment();
  NodeId ternary();
  NodeId binary(int level);
  NodeId unary();
  NodeId postfix();
  NodeId primary();
  NodeId name_or_call();
  NodeId call(NameId name);
  void warn_of_assignment(NodeId condition);
  void check_function(NameId name);
  NodeId vector_literal();
  NodeId list_literal();
  NodeId number();
  NodeId axis_index(NodeId base);
  bool is_lvalue(NodeId node) const;
  void check_lvalue(NodeId node);
  void check_writable(NodeId node);
  void check_step(NodeId target, const Node& step);
  Node& node(NodeId id) { return tree_.nodes[static_cast<std::size_t>(id)]; }
  const Node& node(NodeId id) const { return tree_.nodes[static_cast<std::size_t>(id)]; }

  Tree& tree_;
  std::deque<Source>& sources_;
  SourceReport& report_;
  Includer includer_;
  IsBuiltin is_builtin_;
  Lexer* lexer_ = nullptr;
  Word word_;                  // the next word, not yet used
  Word last_;                  // the word used last
  std::optional<Word> ahead_;  // the one after word_, if peek() has read it
  int depth_ = 0;              // of expressions and blocks, to limit the recursion
  int include_depth_ = 0;
  bool in_function_ = false;
};

}  // namespace kerf::gcmc
