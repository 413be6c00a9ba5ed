// The parser of gcmc programs.
#include "front/gcmc/text/parser.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "base/codes/files.h"
#include "base/codes/gcmc.h"
#include "base/number.h"

#include "kerf/base/limits.h"

namespace kerf::gcmc {
namespace {

constexpr int kMaxNesting = 400;  // of parentheses, blocks and operators in one statement
constexpr std::size_t kMaxSources = 10'000;
constexpr std::size_t kMaxNodes = 5'000'000;
constexpr std::uint32_t kMaxTreeHeight = 3000;  // a chain of operators is as high as it is long

/// Binary operators by precedence, lowest first.
struct Level {
  std::array<Token, 4> tokens;
  int count;
};
constexpr Level kLevels[] = {
    {{Token::or_or}, 1},
    {{Token::and_and}, 1},
    {{Token::pipe}, 1},
    {{Token::caret}, 1},
    {{Token::amp}, 1},
    {{Token::equal, Token::not_equal}, 2},
    {{Token::less, Token::greater, Token::less_equal, Token::greater_equal}, 4},
    {{Token::shift_left, Token::shift_right}, 2},
    {{Token::plus, Token::minus, Token::add_or, Token::sub_or}, 4},
    {{Token::star, Token::slash, Token::percent}, 3},
};
constexpr int kLevelCount = static_cast<int>(std::size(kLevels));

bool has(const Level& level, Token token) {
  return std::find(level.tokens.begin(), level.tokens.begin() + level.count, token) !=
         level.tokens.begin() + level.count;
}

bool is_assignment(Token t) {
  return t == Token::assign || (t >= Token::plus_assign && t <= Token::sub_or_assign);
}

const std::vector<std::string>& statement_words() {
  static const std::vector<std::string> words = {"break",   "const", "continue", "do",       "elif",
                                                 "else",    "for",   "foreach",  "function", "if",
                                                 "include", "local", "repeat",   "return",   "while"};
  return words;
}

const std::vector<std::string>& unit_words() {
  static const std::vector<std::string> words = {"mm", "in", "mil", "deg", "rad"};
  return words;
}

/// A hint with the most similar of `words`; empty if none is similar.
std::string suggestion(std::string_view word, const std::vector<std::string>& words) {
  const auto near = did_you_mean(word, words);
  return near && *near != word ? fmt::format("did you mean '{}'?", *near) : std::string();
}

struct Deeper {
  explicit Deeper(int& depth) : depth_(depth) { ++depth_; }
  ~Deeper() { --depth_; }
  int& depth_;
};

}  // namespace

NameId Tree::intern(std::string_view name) {
  auto [it, is_new] = name_index.try_emplace(std::string(name), static_cast<NameId>(names.size()));
  if (is_new) names.emplace_back(name);
  return it->second;
}

NodeId Tree::add(Node node) {
  nodes.push_back(std::move(node));
  return static_cast<NodeId>(nodes.size() - 1);
}

NodeId Tree::add_with_children(Node node, const std::vector<NodeId>& list) {
  node.first = static_cast<std::uint32_t>(children.size());
  node.count = static_cast<std::uint32_t>(list.size());
  children.insert(children.end(), list.begin(), list.end());
  return add(std::move(node));
}

Parser::Parser(Tree& tree, std::deque<Source>& sources, SourceReport& report, Includer includer,
               IsBuiltin is_builtin)
    : tree_(tree),
      sources_(sources),
      report_(report),
      includer_(std::move(includer)),
      is_builtin_(std::move(is_builtin)) {}

void Parser::parse(std::uint16_t file) {
  Lexer lexer(sources_[file].bytes, file, report_);
  lexer_ = &lexer;
  word_ = lexer.next();
  lines(tree_.program, Token::end);
  lexer_ = nullptr;
}

// ---- words

/// Adds the node of an expression; an error if the tree is too high for the recursion of the compiler.
NodeId Parser::add(Node n, const std::vector<NodeId>& children) {
  for (NodeId id : {n.a, n.b, n.c})
    if (id != kNoNode) n.height = std::max(n.height, node(id).height + 1);
  for (NodeId id : children)
    if (id != kNoNode) n.height = std::max(n.height, node(id).height + 1);
  if (n.height > kMaxTreeHeight) fail("Expression is nested too deeply");
  return children.empty() ? tree_.add(n) : tree_.add_with_children(n, children);
}

void Parser::advance() {
  last_ = std::move(word_);
  word_ = ahead_ ? std::move(*ahead_) : lexer_->next();
  ahead_.reset();
}

const Word& Parser::peek() {
  if (!ahead_) ahead_ = lexer_->next();
  return *ahead_;
}

bool Parser::accept(Token token) {
  if (!is(token)) return false;
  advance();
  return true;
}

void Parser::report_error(std::string message, std::string hint) {
  report_.error(word_.after, codes::gcmc_syntax, std::move(message), std::move(hint));
}

void Parser::fail(std::string message, std::string hint) {
  report_error(std::move(message), std::move(hint));
  throw Failure{};
}

/// Reports a missing word and continues as if it were present. No report after an unterminated string, which
/// has been reported and may contain the word.
bool Parser::expect(Token token, std::string_view shown, std::string hint) {
  if (accept(token)) return true;
  if (last_.unterminated) return false;
  const bool after_number = last_.token == Token::integer || last_.token == Token::real;
  if (hint.empty() && last_.token == Token::identifier) hint = suggestion(last_.text, statement_words());
  if (hint.empty() && after_number && is(Token::identifier)) hint = suggestion(word_.text, unit_words());
  report_error(fmt::format("'{}' expected", shown), std::move(hint));
  return false;
}

NameId Parser::expect_name(std::string_view what) {
  if (!is(Token::identifier)) {
    if (word_.token >= Token::kw_break && word_.token <= Token::kw_while)
      fail(fmt::format("{} expected", what), fmt::format("'{}' is a keyword", word_.text));
    fail(fmt::format("{} expected", what));
  }
  const NameId name = tree_.intern(word_.text);
  advance();
  return name;
}

/// After an error: skips to the text after the next ';', to a brace or to the end.
void Parser::synchronise() {
  while (!is(Token::end) && !is(Token::right_brace)) {
    if (is(Token::left_brace)) return skip_braces();
    if (accept(Token::semicolon)) return;
    advance();
  }
}

void Parser::skip_braces() {
  int depth = 0;
  do {
    if (is(Token::left_brace)) ++depth;
    if (is(Token::right_brace)) --depth;
    advance();
  } while (depth > 0 && !is(Token::end));
}

// ---- statements

void Parser::lines(std::vector<NodeId>& into, Token until) {
  while (!is(until) && !is(Token::end)) line(into);
}

void Parser::line(std::vector<NodeId>& into) {
  const Deeper deeper(depth_);
  const int depth = depth_;
  const bool in_function = in_function_;
  try {
    if (depth_ > kMaxNesting || tree_.nodes.size() > kMaxNodes)
      fail("The program is nested too deeply or too long");
    if (accept(Token::semicolon)) return;
    if (is(Token::left_brace)) {
      report_error("Syntax error", "a block follows if, for, while, repeat, foreach or function");
      return skip_braces();
    }
    if (compound(into)) return;
    expression_statement(into);
  } catch (const Failure&) {
    depth_ = depth;
    in_function_ = in_function;
    synchronise();
  }
}

bool Parser::compound(std::vector<NodeId>& into) {
  const SourceLocation at = word_.at;
  switch (word_.token) {
    case Token::kw_if: into.push_back(parse_if(at)); return true;
    case Token::kw_for: into.push_back(parse_for(at)); return true;
    case Token::kw_while: into.push_back(parse_while(at)); return true;
    case Token::kw_do: into.push_back(parse_do(at)); return true;
    case Token::kw_foreach: into.push_back(parse_foreach(at)); return true;
    case Token::kw_repeat: into.push_back(parse_repeat(at)); return true;
    case Token::kw_function: parse_function(into); return true;
    case Token::kw_return: into.push_back(parse_return(at)); return true;
    case Token::kw_local: declarations(into, NodeKind::local); return true;
    case Token::kw_const: declarations(into, NodeKind::constant); return true;
    case Token::kw_include: include(into); return true;
    case Token::kw_break:
    case Token::kw_continue: {
      Node node;
      node.kind = is(Token::kw_break) ? NodeKind::break_loop : NodeKind::continue_loop;
      advance();
      node.at = word_.at;
      expect(Token::semicolon, ";");
      into.push_back(tree_.add(node));
      return true;
    }
    default: return false;
  }
}

NodeId Parser::body() {
  Node node;
  std::vector<NodeId> statements;
  node.at = word_.at;
  if (!expect(Token::left_brace, "{")) {  // the single statement becomes the block
    if (!is(Token::end)) line(statements);
    return tree_.add_with_children(node, statements);
  }
  lines(statements, Token::right_brace);
  expect(Token::right_brace, "}");
  return tree_.add_with_children(node, statements);
}

NodeId Parser::condition() {
  expect(Token::left_paren, "(");
  const NodeId cond = expression();
  warn_of_assignment(cond);
  expect(Token::right_paren, ")");
  return cond;
}

void Parser::warn_of_assignment(NodeId condition) {
  if (node(condition).kind != NodeKind::assign || node(condition).parenthesised) return;
  report_.warning(word_.at, codes::gcmc_suspicious,
                  "Assignment in boolean expression may be an inadvertent error, use () to force");
}

Node Parser::statement_node(NodeKind kind, SourceLocation at) {
  Node out;
  out.kind = kind;
  out.at = at;
  advance();
  return out;
}

/// An if with all its elifs, by a loop: each is the else branch of the one before.
NodeId Parser::parse_if(SourceLocation at) {
  const Deeper deeper(depth_);
  std::vector<Node> branches;
  do {
    branches.push_back(statement_node(NodeKind::if_else, branches.empty() ? at : word_.at));
    const NodeId decides = condition();
    const NodeId then = body();
    branches.back().a = decides;
    branches.back().b = then;
  } while (is(Token::kw_elif));
  NodeId otherwise = accept(Token::kw_else) ? body() : kNoNode;
  for (auto branch = branches.rbegin(); branch != branches.rend(); ++branch) {
    branch->c = otherwise;
    otherwise = tree_.add(*branch);
  }
  return otherwise;
}

NodeId Parser::parse_for(SourceLocation at) {
  Node out = statement_node(NodeKind::for_loop, at);
  expect(Token::left_paren, "(");
  if (is(Token::kw_local) || is(Token::kw_const)) {
    report_error("';' expected", "a variable of a for loop is declared before the loop");
    Node nothing;
    return tree_.add_with_children(nothing, {});
  }
  if (!is(Token::semicolon)) out.a = expression();
  expect(Token::semicolon, ";");
  out.b = expression();
  warn_of_assignment(out.b);
  expect(Token::semicolon, ";");
  if (!is(Token::right_paren)) out.c = expression();
  expect(Token::right_paren, ")");
  out.d = body();
  return tree_.add(out);
}

NodeId Parser::parse_while(SourceLocation at) {
  Node out = statement_node(NodeKind::while_loop, at);
  out.a = condition();
  out.b = body();
  return tree_.add(out);
}

NodeId Parser::parse_do(SourceLocation at) {
  Node out = statement_node(NodeKind::do_loop, at);
  out.b = body();
  expect(Token::kw_while, "while");
  out.a = condition();
  expect(Token::semicolon, ";");
  return tree_.add(out);
}

NodeId Parser::parse_foreach(SourceLocation at) {
  Node out = statement_node(NodeKind::foreach_loop, at);
  expect(Token::left_paren, "(");
  out.a = expression();
  expect(Token::semicolon, ";");
  out.name = expect_name("Variable name");
  expect(Token::right_paren, ")");
  out.b = body();
  return tree_.add(out);
}

NodeId Parser::parse_repeat(SourceLocation at) {
  Node out = statement_node(NodeKind::repeat_loop, at);
  expect(Token::left_paren, "(");
  out.a = expression();
  if (accept(Token::semicolon)) out.name = expect_name("Variable name");
  expect(Token::right_paren, ")");
  out.b = body();
  return tree_.add(out);
}

Parameter Parser::parameter(bool& presets_began) {
  Parameter p;
  p.by_reference = accept(Token::amp);
  p.name = expect_name("Argument name");
  if (accept(Token::assign)) {
    presets_began = true;
    if (p.by_reference) {
      report_error(fmt::format("Reference argument '{}' cannot have a default",
                               tree_.names[static_cast<std::size_t>(p.name)]));
    }
    p.preset = ternary();
  } else if (presets_began) {
    report_error(fmt::format("Argument '{}' must have a default value because a previous argument has one",
                             tree_.names[static_cast<std::size_t>(p.name)]));
  }
  return p;
}

void Parser::check_function(NameId id) {
  const std::string& name = tree_.names[static_cast<std::size_t>(id)];
  if (is_builtin_(name)) {
    report_.error(last_.after, codes::gcmc_defined_twice,
                  fmt::format("Function name '{}' is reserved as built-in function", name));
  } else if (tree_.function_index.count(id) != 0) {
    report_.error(last_.after, codes::gcmc_defined_twice,
                  fmt::format("Function name '{}' is already defined", name));
  }
}

void Parser::parse_function(std::vector<NodeId>& into) {
  advance();
  if (in_function_) report_error("Function in functions not supported");
  FunctionTree function;
  function.name = expect_name("Function name");
  check_function(function.name);
  expect(Token::left_paren, "(");
  bool presets_began = false;
  if (!is(Token::right_paren)) {
    do {
      const Parameter p = parameter(presets_began);
      const bool twice = std::any_of(function.parameters.begin(), function.parameters.end(),
                                     [&](const Parameter& other) { return other.name == p.name; });
      if (twice) {
        report_error(
            fmt::format("Argument name '{}' is used twice", tree_.names[static_cast<std::size_t>(p.name)]));
      } else {
        function.parameters.push_back(p);
      }
    } while (accept(Token::comma));
  }
  expect(Token::right_paren, ")");
  into.push_back(parse_function_body(std::move(function)));
}

NodeId Parser::parse_function_body(FunctionTree function) {
  Node out;
  out.kind = NodeKind::function;
  const bool outer = std::exchange(in_function_, true);
  function.body = body();
  in_function_ = outer;
  out.at = last_.at;
  out.a = static_cast<NodeId>(tree_.functions.size());
  tree_.function_index.try_emplace(function.name, out.a);
  tree_.functions.push_back(std::move(function));
  return tree_.add(out);
}

NodeId Parser::parse_return(SourceLocation at) {
  Node out = statement_node(NodeKind::return_value, at);
  if (!is(Token::semicolon)) out.a = expression();
  expect(Token::semicolon, ";");
  return tree_.add(out);
}

void Parser::declarations(std::vector<NodeId>& into, NodeKind kind) {
  advance();
  do {
    Node out;
    out.kind = kind;
    out.name = expect_name("Variable name");
    if (kind == NodeKind::constant && !is(Token::assign)) fail("'=' expected", "a constant requires a value");
    if (accept(Token::assign)) out.a = ternary();
    out.at = word_.at;
    into.push_back(tree_.add(out));
  } while (accept(Token::comma));
  expect(Token::semicolon, ";");
}

void Parser::include(std::vector<NodeId>& into) {
  advance();
  expect(Token::left_paren, "(");
  if (!is(Token::string)) fail("Name of the file expected", "the name of an included file must be in quotes");
  const std::string name = to_utf8(word_.string);
  advance();
  expect(Token::right_paren, ")");
  const SourceLocation at = word_.after;
  if (!is(Token::semicolon)) {
    expect(Token::semicolon, ";");
  }
  include_file(name, at, into);  // before the ';' is skipped, because that reads the next word
  accept(Token::semicolon);
}

void Parser::include_file(const std::string& name, SourceLocation at, std::vector<NodeId>& into) {
  Source source;
  std::string problem;
  if (!includer_(name, source, problem)) {
    if (problem.empty())
      report_.error(at, codes::gcmc_include_missing, fmt::format("Include file '{}' cannot be found", name));
    else
      report_.error(at, codes::file_unreadable, fmt::format("Include file '{}': {}", name, problem));
    return;
  }
  if (include_depth_ >= limits::kMaxIncludeDepth || sources_.size() >= kMaxSources) {
    report_.error(at, codes::gcmc_limit, fmt::format("Include file '{}' is nested too deeply", name),
                  "does the file include itself?");
    return;
  }
  sources_.push_back(std::move(source));
  const auto file = static_cast<std::uint16_t>(sources_.size() - 1);
  Lexer lexer(sources_[file].bytes, file, report_);
  Lexer* outer = std::exchange(lexer_, &lexer);
  Word outer_word = std::exchange(word_, lexer.next());
  ++include_depth_;
  while (!is(Token::end)) {
    lines(into, Token::right_brace);
    if (is(Token::right_brace)) {
      report_error("Syntax error");
      advance();
    }
  }
  --include_depth_;
  lexer_ = outer;
  word_ = std::move(outer_word);
}

void Parser::expression_statement(std::vector<NodeId>& into) {
  if (is(Token::right_brace) || is(Token::right_paren) || is(Token::right_bracket) || is(Token::kw_else) ||
      is(Token::kw_elif) || is(Token::comma) || is(Token::colon)) {
    report_error("Syntax error");
    advance();
    return;
  }
  Node out;
  out.kind = NodeKind::expression;
  out.a = expression();
  out.at = word_.at;
  const NodeKind kind = node(out.a).kind;
  const SourceLocation after = word_.after;
  std::string hint;
  if (kind == NodeKind::call && is(Token::left_brace))  // whiel(1) {
    hint = suggestion(tree_.names[static_cast<std::size_t>(node(out.a).name)], statement_words());
  const bool ended = expect(Token::semicolon, ";", std::move(hint));
  const bool does = kind == NodeKind::call || kind == NodeKind::assign ||
                    (kind == NodeKind::step && is_lvalue(node(out.a).a));
  if (!does && ended) report_.error(after, codes::gcmc_syntax, "Statement has no effect");
  into.push_back(tree_.add(out));
}

// ---- expressions

NodeId Parser::expression() { return assignment(); }

bool Parser::is_lvalue(NodeId id) const {
  while (node(id).kind == NodeKind::index && !node(id).parenthesised) id = node(id).a;
  return node(id).kind == NodeKind::name && !node(id).parenthesised;
}

void Parser::check_lvalue(NodeId id) {
  if (!is_lvalue(id))
    report_error("Lvalue not a variable, cannot be dereferenced");
  else
    check_writable(id);
}

void Parser::check_writable(NodeId id) {
  while (node(id).kind == NodeKind::index) id = node(id).a;
  const std::string& name = tree_.names[static_cast<std::size_t>(node(id).name)];
  if (name == "__global_offset" || name == "__global_position")
    report_error(fmt::format("Assigning to read-only variable '{}' not allowed", name));
}

void Parser::check_step(NodeId target, const Node& step) {
  if (is_lvalue(target)) return check_writable(target);
  report_.error(last_.after, codes::gcmc_syntax,
                fmt::format("Statement {}-{} on a constant has no effect", step.prefix ? "pre" : "post",
                            step.op == Token::plus_plus ? "increment" : "decrement"));
}

NodeId Parser::assignment() {
  const Deeper deeper(depth_);
  if (depth_ > kMaxNesting) fail("Expression is nested too deeply");
  const NodeId left = ternary();
  if (!is_assignment(word_.token)) return left;
  Node out;
  out.kind = NodeKind::assign;
  out.op = word_.token;
  advance();
  out.a = left;
  out.b = assignment();
  out.at = word_.at;
  check_lvalue(left);
  return add(out);
}

NodeId Parser::ternary() {
  const Deeper deeper(depth_);
  if (depth_ > kMaxNesting) fail("Expression is nested too deeply");
  const NodeId cond = binary(0);
  if (!accept(Token::question)) return cond;
  Node out;
  out.kind = NodeKind::condition;
  out.a = cond;
  out.b = assignment();
  expect(Token::colon, ":");
  out.c = assignment();
  out.at = word_.at;
  return add(out);
}

NodeId Parser::binary(int level) {
  if (level == kLevelCount) return unary();
  NodeId left = binary(level + 1);
  while (has(kLevels[level], word_.token)) {
    Node out;
    out.kind = NodeKind::binary;
    out.op = word_.token;
    advance();
    out.a = left;
    out.b = binary(level + 1);
    out.at = word_.at;
    left = add(out);
  }
  return left;
}

NodeId Parser::unary() {
  const Deeper deeper(depth_);
  if (depth_ > kMaxNesting) fail("Expression is nested too deeply");
  Node out;
  out.op = word_.token;
  switch (word_.token) {
    case Token::plus: advance(); return unary();
    case Token::minus:
    case Token::bang:
    case Token::tilde: out.kind = NodeKind::unary; break;
    case Token::plus_plus:
    case Token::minus_minus: out.kind = NodeKind::step; break;
    default: return postfix();
  }
  advance();
  out.a = unary();
  out.prefix = out.kind == NodeKind::step;
  // After a number with its unit, the end of the operand is known without another word.
  const Node& operand = node(out.a);
  out.at = operand.kind == NodeKind::number && operand.number.unit() != Unit::none ? operand.at : word_.at;
  if (out.kind == NodeKind::step) check_step(out.a, out);
  return add(out);
}

NodeId Parser::axis_index(NodeId base) {
  static constexpr std::string_view kAxes = "xyzabcuvw";
  if (!is(Token::identifier) || word_.text.size() != 1 || kAxes.find(word_.text[0]) == std::string_view::npos)
    fail("Index can only be an axis name", "one of x y z a b c u v w");
  Node axis;
  axis.kind = NodeKind::number;
  axis.at = word_.at;
  axis.number = Scalar::integer(static_cast<std::int32_t>(kAxes.find(word_.text[0])));
  Node out;
  out.kind = NodeKind::index;
  out.at = word_.at;
  out.a = base;
  out.b = tree_.add(axis);
  advance();
  return add(out);
}

NodeId Parser::postfix() {
  NodeId base = primary();
  for (;;) {
    if (accept(Token::dot)) {
      base = axis_index(base);
    } else if (accept(Token::left_bracket)) {
      Node out;
      out.kind = NodeKind::index;
      out.a = base;
      out.b = expression();
      out.at = word_.at;
      expect(Token::right_bracket, "]");
      base = add(out);
    } else if (is(Token::plus_plus) || is(Token::minus_minus)) {
      Node out;
      out.kind = NodeKind::step;
      out.op = word_.token;
      out.at = word_.at;
      out.a = base;
      advance();
      check_step(base, out);
      base = add(out);
    } else {
      return base;
    }
  }
}

NodeId Parser::number() {
  Node out;
  out.kind = NodeKind::number;
  out.at = word_.at;
  out.number = word_.number;
  advance();
  switch (word_.token) {
    case Token::kw_mm: out.number = out.number.with_unit(Unit::mm); break;
    case Token::kw_in: out.number = out.number.with_unit(Unit::inch); break;
    case Token::kw_deg: out.number = out.number.with_unit(Unit::deg); break;
    case Token::kw_rad: out.number = out.number.with_unit(Unit::rad); break;
    case Token::kw_mil: out.number = Scalar::real(out.number.number() / 1000.0, Unit::inch); break;
    default: return add(out);
  }
  out.at = word_.at;
  advance();
  return add(out);
}

NodeId Parser::vector_literal() {
  Node out;
  out.kind = NodeKind::vector;
  advance();
  std::vector<NodeId> entries;
  if (!is(Token::right_bracket)) {
    do {
      // A minus alone is an undefined coordinate.
      if (is(Token::minus) && (peek().token == Token::comma || peek().token == Token::right_bracket)) {
        advance();
        entries.push_back(kNoNode);
      } else {
        entries.push_back(expression());
      }
    } while (accept(Token::comma));
  }
  out.at = word_.at;
  expect(Token::right_bracket, "]");
  return add(out, entries);
}

NodeId Parser::list_literal() {
  Node out;
  out.kind = NodeKind::list;
  advance();
  std::vector<NodeId> entries;
  while (!is(Token::right_brace)) {
    entries.push_back(expression());
    if (!accept(Token::comma)) break;
  }
  out.at = word_.at;
  expect(Token::right_brace, "}");
  return add(out, entries);
}

NodeId Parser::call(NameId name) {
  Node out;
  out.kind = NodeKind::call;
  out.name = name;
  advance();
  std::vector<NodeId> arguments;
  if (!is(Token::right_paren)) {
    do arguments.push_back(expression());
    while (accept(Token::comma));
  }
  out.at = word_.at;
  expect(Token::right_paren, ")");
  return add(out, arguments);
}

NodeId Parser::name_or_call() {
  const std::string text(word_.text);
  const NameId name = tree_.intern(text);
  advance();
  if (is(Token::left_paren)) return call(name);
  if (text == "__global_offset" || text == "__global_position") {
    report_.warning(word_.at, codes::gcmc_suspicious,
                    fmt::format("Using internal variable '{}' strongly discouraged", text));
  }
  Node out;
  out.kind = NodeKind::name;
  out.name = name;
  out.at = word_.at;
  return add(out);
}

NodeId Parser::primary() {
  switch (word_.token) {
    case Token::integer:
    case Token::real: return number();
    case Token::identifier: return name_or_call();
    case Token::left_bracket: return vector_literal();
    case Token::left_brace: return list_literal();
    case Token::left_paren: {
      advance();
      const NodeId inside = expression();
      expect(Token::right_paren, ")");
      node(inside).parenthesised = true;
      return inside;
    }
    case Token::string: {
      Node out;
      out.kind = NodeKind::text;
      out.at = word_.at;
      out.name = static_cast<NameId>(tree_.strings.size());
      tree_.strings.push_back(std::move(word_.string));
      advance();
      return add(out);
    }
    default: break;
  }
  if (last_.token == Token::end || last_.token == Token::semicolon || last_.text.empty())
    fail("Syntax error");
  fail(fmt::format("Expression expected after '{}'", last_.text));
}

}  // namespace kerf::gcmc
