// From words to the tree, by recursive descent. After an error it goes on with the next statement.
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

/// A text that takes part in a program: its name for messages, and its bytes.
struct Source {
  std::string name;
  std::string bytes;
};

/// Finds included files. False if there is none of that name, with what is wrong with the one that cannot be
/// read.
using Includer = std::function<bool(const std::string& name, Source& found, std::string& obstacle)>;
/// True for the name of a built-in function.
using IsBuiltin = std::function<bool(std::string_view name)>;

class Parser {
 public:
  Parser(Tree& tree, std::deque<Source>& sources, SourceReport& report, Includer includer,
         IsBuiltin is_builtin);
  /// Reads all statements of sources[file] and appends them to the program.
  void parse(std::uint16_t file);

 private:
  struct Failure {};  // thrown at a syntax error, caught where the statement began

  // words
  NodeId add(Node n, const std::vector<NodeId>& children = {});
  void advance();
  const Word& peek();
  bool is(Token token) const { return word_.token == token; }
  bool accept(Token token);
  bool expect(Token token, std::string_view shown, std::string hint = {});
  [[noreturn]] void fail(std::string message, std::string hint = {});
  void complain(std::string message, std::string hint = {});
  void synchronise();
  void skip_braces();
  NameId expect_name(std::string_view what);

  // statements
  void lines(std::vector<NodeId>& into, Token until);
  void line(std::vector<NodeId>& into);
  bool compound(std::vector<NodeId>& into);
  NodeId body();
  NodeId condition();
  /// A statement's node; its keyword is behind us.
  Node opened(NodeKind kind, Place at);
  NodeId parse_if(Place at);
  NodeId parse_for(Place at);
  NodeId parse_while(Place at);
  NodeId parse_do(Place at);
  NodeId parse_foreach(Place at);
  NodeId parse_repeat(Place at);
  void parse_function(std::vector<NodeId>& into);
  NodeId parse_function_body(FunctionTree function);
  Parameter parameter(bool& presets_began);
  NodeId parse_return(Place at);
  void declarations(std::vector<NodeId>& into, NodeKind kind);
  void include(std::vector<NodeId>& into);
  void include_file(const std::string& name, Place at, std::vector<NodeId>& into);
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
  std::optional<Word> ahead_;  // the one after word_, where it was looked at
  int depth_ = 0;              // of expressions and blocks, against the machine's own stack
  int include_depth_ = 0;
  bool in_function_ = false;
};

}  // namespace kerf::gcmc
