// Recursive descent with recovery: after an error it continues behind the next semicolon or brace.
#include "front/scad/text/parser.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "base/file_names.h"
#include "front/scad/text/customizer.h"
#include "front/scad/text/lexer.h"
#include "front/scad/text/resolve.h"

namespace kerf::scad {
namespace {

/// A syntax error has been reported; the statement is given up. Thrown inside of this file only.
struct Failed {};
/// A limit was exceeded: parsing ends.
struct TooMuch {};

constexpr std::uint16_t kMaxTreeDepth = 2000;  // of an expression, such as a sum of so many terms

/// Whether a variable is looked up in the callers. $children is not: it belongs to the module around it.
bool is_special(const std::string& name) { return !name.empty() && name[0] == '$' && name != "$children"; }

/// Files that are part of Kerf: their commands are built in.
bool is_built_in_file(const std::string& name) {
  const std::string base = file_name_of(name);
  return base == "gcodepreview.py" || base == "gcodepreview.scad";
}

class Parser {
 public:
  Parser(Program& program, const ReadSource& read, const ParseLimits& limits, Diagnostics& diagnostics)
      : program_(program), read_(read), limits_(limits), diagnostics_(diagnostics) {}

  void run(Source main, const std::vector<std::string>& defines) {
    program_.files.push_back(main.name);
    Unit* unit = add_unit(main.identity);
    const std::uint32_t source = program_.sources.add(std::move(main));
    program_.parameters = custom_parameters(program_.sources[source].text, source);
    parse_source(*unit, source);
    for (const std::string& text : defines) {
      std::string statement = text;
      statement += ';';
      parse_source(*unit, program_.sources.add({"<-D " + text + ">", statement, {}}));
    }
    // Used files may use further ones: the list grows.
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      const Waiting next = waiting_[i];
      parse_source(*next.unit, next.source);
    }
  }

 private:
  struct Waiting {
    Unit* unit;
    std::uint32_t source;
  };

  // ---- files

  Unit* add_unit(const std::string& path) {
    program_.units.push_back(std::make_unique<Unit>());
    Unit* unit = program_.units.back().get();
    unit->path = path;
    unit->index = program_.units.size() - 1;
    unit->block = new_block();
    return unit;
  }

  void parse_source(Unit& unit, std::uint32_t source) {
    lexers_.clear();
    lexers_.push_back(std::make_unique<Lexer>(program_.sources, source, diagnostics_));
    unit_ = &unit;
    block_ = unit.block;
    advance();
    statements_until_end();
  }

  void statements_until_end() {
    while (token_.word != Word::end) {
      if (token_.is('}')) {
        error("\"}\" without a \"{\" before it");
        advance();
        continue;
      }
      recovering([&] { statement(); });
    }
  }

  std::optional<Source> open(const Token& name, std::string_view how) {
    const std::string from = program_.sources[name.at.source].name;
    if (auto source = read_(name.text, from)) return source;
    diagnostics_.error(
        codes::scad_file, program_.sources.locate(name.at),
        fmt::format("{} <{}>: there is no such file beside the program or in the folders of --include", how,
                    name.text));
    return std::nullopt;
  }

  void check_file_count(Position at) {
    if (program_.sources.size() <= limits_.max_files) return;
    diagnostics_.error(codes::scad_limit, program_.sources.locate(at),
                       fmt::format("the program reads more than {} files", limits_.max_files));
    throw TooMuch{};
  }

  /// The words of an included file replace its include, wherever that is. A file that is being
  /// included is not included again, as in OpenSCAD; the program's own file is, once.
  void include_file(const Token& name) {
    if (is_built_in_file(name.text)) return;
    auto source = open(name, "include");
    if (!source) return;
    check_file_count(name.at);
    if (std::find(including_.begin(), including_.end(), source->identity) != including_.end()) {
      diagnostics_.warning(
          codes::scad_file, program_.sources.locate(name.at),
          fmt::format("cannot open include file {}: it is being included already", source->name));
      return;
    }
    if (including_.size() >= limits_.max_includes) {
      diagnostics_.error(codes::scad_limit, program_.sources.locate(name.at),
                         fmt::format("include is nested more than {} times", limits_.max_includes));
      return;
    }
    note_file(source->name);
    including_.push_back(source->identity);
    lexers_.push_back(
        std::make_unique<Lexer>(program_.sources, program_.sources.add(std::move(*source)), diagnostics_));
  }

  void use_file() {
    advance();
    const Token name = token_;
    if (name.word != Word::file) fail("a file name in <>");
    advance_over_optional_semicolon();
    if (is_built_in_file(name.text)) return;
    const std::string_view ending =
        name.text.size() > 4 ? std::string_view(name.text).substr(name.text.size() - 4) : "";
    if (ending == ".ttf" || ending == ".otf") {
      if (const auto font = open(name, "use")) program_.fonts.push_back(font->name);
      return;
    }
    auto source = open(name, "use");
    if (!source) return;
    check_file_count(name.at);
    Unit* used = nullptr;
    for (const auto& unit : program_.units)
      if (unit->path == source->identity) used = unit.get();
    if (used == nullptr) {
      note_file(source->name);
      used = add_unit(source->identity);
      waiting_.push_back({used, program_.sources.add(std::move(*source))});
    }
    // A ring of uses is no error: each file has the functions of the others.
    if (used == unit_) return;
    auto& list = unit_->used;
    list.erase(std::remove(list.begin(), list.end(), used), list.end());
    list.insert(list.begin(), used);  // the last one is searched first
  }

  void note_file(const std::string& name) {
    if (std::find(program_.files.begin(), program_.files.end(), name) == program_.files.end())
      program_.files.push_back(name);
  }

  // ---- words

  void advance() {
    for (;;) {
      token_ = lexers_.back()->next();
      if (token_.word == Word::key_include) {
        token_ = lexers_.back()->next();
        if (token_.word == Word::file) {
          include_file(token_);
          continue;
        }
        error(fmt::format("{} instead of a file name in <> after include", describe(token_)));
      }
      if (token_.word != Word::end || lexers_.size() == 1) return;
      lexers_.pop_back();
      including_.pop_back();
    }
  }
  void advance_over_optional_semicolon() {
    advance();
    if (token_.is(';')) advance();
  }
  bool take(char sign) {
    if (!token_.is(sign)) return false;
    advance();
    return true;
  }
  bool take(Word word) {
    if (token_.word != word) return false;
    advance();
    return true;
  }
  void expect(char sign, std::string_view after) {
    if (!take(sign)) fail(fmt::format("\"{}\" {}", sign, after));
  }
  void error(std::string message) {
    diagnostics_.error(codes::scad_syntax, program_.sources.locate(token_.at), std::move(message));
  }
  [[noreturn]] void fail(std::string_view expected) {
    error(fmt::format("{} instead of {}", describe(token_), expected));
    throw Failed{};
  }

  /// Runs `parse_one`; after an error in it, skips to the end of the statement.
  template <class Parse>
  void recovering(Parse parse_one) {
    const int nesting = nesting_;
    Body* block = block_;
    try {
      parse_one();
    } catch (const Failed&) {
      nesting_ = nesting;
      block_ = block;
      skip_statement();
    }
  }

  void skip_statement() {
    int depth = 0;
    while (token_.word != Word::end) {
      if (token_.is('{')) ++depth;
      if (token_.is('}')) {
        if (depth == 0) return;
        if (--depth == 0) {
          advance();
          return;
        }
      }
      const bool is_end = token_.is(';') && depth == 0;
      advance();
      if (is_end) return;
    }
  }

  /// Counts a level of nesting for as long as it exists.
  class Level {
   public:
    explicit Level(Parser& p) : parser_(p) {
      if (++parser_.nesting_ <= parser_.limits_.max_nesting) return;
      parser_.diagnostics_.error(codes::scad_limit, parser_.program_.sources.locate(parser_.token_.at),
                                 fmt::format("more than {} levels of parentheses, blocks and operators",
                                             parser_.limits_.max_nesting));
      throw TooMuch{};
    }
    ~Level() { --parser_.nesting_; }
    Level(const Level&) = delete;

   private:
    Parser& parser_;
  };

  // ---- nodes

  template <class Node>
  void check_count(const std::vector<Node>& list) {
    if (list.size() < limits_.max_nodes) return;
    diagnostics_.error(
        codes::scad_limit, program_.sources.locate(token_.at),
        fmt::format("the program has more than {} expressions or statements", limits_.max_nodes));
    throw TooMuch{};
  }
  template <class Node>
  Node* add(std::unique_ptr<Node> node) {
    check_count(program_.expressions);
    Node* raw = node.get();
    program_.expressions.push_back(std::move(node));
    return raw;
  }
  /// Sets the depth of a node by those below it.
  Expr* deep(Expr* e) {
    std::uint16_t depth = 0;
    for (const Expr* child : {e->a, e->b, e->c})
      if (child != nullptr) depth = std::max(depth, child->depth);
    return deeper(e, depth);
  }
  Expr* deeper(Expr* e, std::uint16_t below) {
    if (below >= kMaxTreeDepth) {
      diagnostics_.error(codes::scad_limit, program_.sources.locate(e->at),
                         fmt::format("an expression of more than {} nested operations", kMaxTreeDepth));
      throw TooMuch{};
    }
    e->depth = std::max(e->depth, static_cast<std::uint16_t>(below + 1));
    return e;
  }
  static std::uint16_t depth_of(const std::vector<Argument>& list) {
    std::uint16_t depth = 0;
    for (const Argument& a : list)
      if (a.value != nullptr) depth = std::max(depth, a.value->depth);
    return depth;
  }
  Expr* node(ExprKind kind, Position at, Expr* a, Expr* b = nullptr, Expr* c = nullptr) {
    Expr* e = add(std::make_unique<Expr>(kind, at));
    e->a = a;
    e->b = b;
    e->c = c;
    return deep(e);
  }
  Expr* constant(Position at, Value v) { return add(std::make_unique<Constant>(at, std::move(v))); }
  Body* new_block() {
    check_count(program_.blocks);
    program_.blocks.push_back(std::make_unique<Body>());
    return program_.blocks.back().get();
  }

  // ---- statements

  void statement() {
    const Level level(*this);
    switch (token_.word) {
      case Word::key_use: use_file(); return;
      case Word::key_module: module_definition(); return;
      case Word::key_function: function_definition(); return;
      default: break;
    }
    if (take(';')) return;
    if (token_.is('{')) {  // no scope of its own
      advance();
      while (!token_.is('}') && token_.word != Word::end) recovering([&] { statement(); });
      expect('}', "at the end of the block");
      return;
    }
    assignment_or_call();
  }

  void assignment_or_call() {
    if (token_.word == Word::name) {
      const Token name = token_;
      advance();
      if (token_.is('=')) {
        assignment(name);
        return;
      }
      add_statement(call_of(name));
      return;
    }
    add_statement(module_call());
  }

  void add_statement(Statement* s) {
    if (s != nullptr) block_->statements.push_back(s);
  }

  void assignment(const Token& name) {
    advance();
    Assignment a;
    a.name = name.text;
    a.at = a.first = name.at;
    a.value = expression();
    a.special = is_special(name.text);
    if (a.special) a.slot = program_.special(a.name);
    a.after_statement = !block_->statements.empty();
    expect(';', "after the assignment");
    add_assignment(std::move(a));
  }

  void add_assignment(Assignment a) {
    const auto [it, is_new] = block_->names.try_emplace(a.name, block_->assignments.size());
    if (is_new) {
      block_->assignments.push_back(std::move(a));
      return;
    }
    Assignment& before = block_->assignments[it->second];
    // Those of an included file and of the command line are meant to be replaced or to replace.
    if (before.at.source == a.at.source)
      diagnostics_.warning(codes::scad_assigned_twice, program_.sources.locate(a.at),
                           fmt::format("{} is assigned in line {} already; this value replaces it there",
                                       a.name, before.at.line));
    a.first = before.first;
    a.after_statement = before.after_statement;
    before = std::move(a);
  }

  void module_definition() {
    advance();
    const Token name = token_;
    if (!take(Word::name)) fail("the name of the module");
    program_.modules.push_back(std::make_unique<Module>());
    Module* module = program_.modules.back().get();
    module->name = name.text;
    module->at = name.at;
    module->unit = unit_;
    expect('(', "after the name of the module");
    module->parameters = parameters();
    module->body = new_block();
    block_->modules[name.text] = module;
    Body* outer = std::exchange(block_, module->body);
    const std::size_t literals = literals_;
    statement();
    module->body->captured = literals_ != literals;
    block_ = outer;
  }

  void function_definition() {
    const Position at = token_.at;
    advance();
    const Token name = token_;
    if (!take(Word::name)) fail("the name of the function");
    program_.functions.push_back(std::make_unique<Function>());
    Function* function = program_.functions.back().get();
    function->name = name.text;
    function->at = at;
    function->unit = unit_;
    expect('(', "after the name of the function");
    function->parameters = parameters();
    expect('=', "before the value of the function");
    const std::size_t literals = literals_;
    function->body = expression();
    function->captured = literals_ != literals;
    expect(';', "after the function");
    block_->functions[name.text] = function;
  }

  std::vector<Parameter> parameters() {
    std::vector<Parameter> list;
    while (take(',')) {
    }
    while (!token_.is(')')) {
      Parameter p;
      p.name = token_.text;
      p.at = token_.at;
      if (!take(Word::name)) fail("the name of a parameter or \")\"");
      p.special = is_special(p.name);
      if (p.special) p.slot = program_.special(p.name);
      const std::size_t literals = literals_;
      if (take('=')) p.standard = expression();
      p.captured = literals_ != literals;
      list.push_back(std::move(p));
      if (!token_.is(',') && !token_.is(')')) fail("\",\" or \")\" after the parameter");
      while (take(',')) {
      }
    }
    advance();
    return list;
  }

  /// Arguments up to the closing parenthesis, the opening one has been read. Commas may be repeated and may
  /// are at the end.
  std::vector<Argument> arguments(std::string_view end = ")") {
    std::vector<Argument> list;
    while (take(',')) {
    }
    while (!token_.is(end[0])) {
      Argument a;
      a.at = token_.at;
      a.value = argument(a.name);
      a.special = is_special(a.name);
      if (a.special) a.slot = program_.special(a.name);
      list.push_back(std::move(a));
      if (!token_.is(',') && !token_.is(end[0])) fail(fmt::format("\",\" or \"{}\" after the argument", end));
      while (take(',')) {
      }
    }
    advance();
    return list;
  }

  /// An argument's value; its name, if it has one, into `name`.
  Expr* argument(std::string& name) {
    if (token_.word != Word::name) return expression();
    const Token first = token_;
    advance();
    if (take('=')) {
      name = first.text;
      return expression();
    }
    return expression_from(first);
  }

  /// A call with its children; null if it is disabled by "*".
  Statement* module_call() {
    const Level level(*this);
    for (const char modifier : {'!', '#', '%', '*'}) {
      if (!take(modifier)) continue;
      Statement* s = module_call();
      if (modifier == '*') return nullptr;
      if (s != nullptr) s->modifier = modifier == '#' && s->modifier != 0 ? s->modifier : modifier;
      return s;
    }
    const Token first = token_;
    switch (token_.word) {
      case Word::key_if: return choice();
      case Word::key_for: advance(); return call_of(first);
      case Word::key_let:
      case Word::key_assert:
      case Word::key_echo:
      case Word::key_each: advance(); return call_of(first);
      case Word::name: advance(); return call_of(first);
      default: fail("a statement");
    }
  }

  Statement* new_statement(StatementKind kind, Position at) {
    check_count(program_.statements);
    program_.statements.push_back(std::make_unique<Statement>(kind, at));
    return program_.statements.back().get();
  }

  Statement* call_of(const Token& name) {
    const StatementKind kind = name.word == Word::key_for        ? StatementKind::loop
                               : name.word == Word::key_let      ? StatementKind::let
                               : name.text == "assign"           ? StatementKind::let  // its former name
                               : name.word == Word::key_assert   ? StatementKind::check
                               : name.word == Word::key_echo     ? StatementKind::print
                               : name.text == "intersection_for" ? StatementKind::loop
                                                                 : StatementKind::call;
    Statement* s = new_statement(kind, name.at);
    s->name = name.text;
    if (name.text == "assign")
      diagnostics_.warning(codes::scad_call, program_.sources.locate(name.at),
                           "deprecated: the assign() module; use a regular assignment or let()");
    if (token_.is('.')) {
      advance();
      Token method = token_;
      if (!take(Word::name)) fail("the name of a command");
      auto variable = add(std::make_unique<Variable>(name.at, name.text));
      s->object = variable;
      s->name = method.text;
    }
    // Assignments of a block do not come here.
    if (token_.is('=') && s->object == nullptr)
      fail(fmt::format("\"(\" after \"{}\"; an assignment that belongs to a statement needs braces around it",
                       name.text));
    if (!token_.is('(')) fail(fmt::format("\"(\" or \"=\" after \"{}\"", name.text));
    advance();
    const std::size_t literals = literals_;
    s->arguments = arguments();
    s->children = children();
    s->captured = literals_ != literals;
    return s;
  }

  Statement* choice() {
    const Token start = token_;
    Statement* s = new_statement(StatementKind::choice, start.at);
    s->name = "if";
    advance();
    expect('(', "after if");
    Argument condition;
    condition.at = token_.at;
    condition.value = expression();
    s->arguments.push_back(condition);
    expect(')', "after the condition");
    s->children = children();
    if (take(Word::key_else)) s->otherwise = children();
    return s;
  }

  /// A statement in a block of children. A block in it has no scope of its own.
  void child_statement() {
    const Level level(*this);
    if (token_.word == Word::key_module || token_.word == Word::key_function)
      fail("a statement: definitions are not possible in a block of children");
    if (take(';')) return;
    if (!take('{')) return assignment_or_call();
    while (!token_.is('}') && token_.word != Word::end) recovering([&] { child_statement(); });
    expect('}', "at the end of the block");
  }

  /// ";", a block, or a statement: a block of its own.
  Body* children() {
    const Level level(*this);
    Body* block = new_block();
    Body* outer = std::exchange(block_, block);
    const std::size_t literals = literals_;
    if (token_.is('{'))
      child_statement();
    else if (!take(';'))
      add_statement(module_call());
    block->captured = literals_ != literals;
    block_ = outer;
    return block;
  }

  // ---- expressions

  Expr* expression() {
    const Level level(*this);
    return after_operand(unary());
  }
  /// An expression whose first word, a name, has been read.
  Expr* expression_from(const Token& name) {
    const Level level(*this);
    return after_operand(power(postfix(variable(name))));
  }
  Expr* after_operand(Expr* first) {
    Expr* e = binary(first, 0);
    if (!token_.is('?')) return e;
    const Position at = token_.at;
    advance();
    Expr* yes = expression();
    expect(':', "between the two values of a choice");
    Expr* no = expression();
    return node(ExprKind::choice, at, e, yes, no);
  }

  struct Operator {
    ExprKind kind;
    int precedence;
  };
  std::optional<Operator> binary_operator() const {
    switch (token_.word) {
      case Word::either: return Operator{ExprKind::either, 1};
      case Word::both: return Operator{ExprKind::both, 2};
      case Word::equal: return Operator{ExprKind::equal, 3};
      case Word::not_equal: return Operator{ExprKind::not_equal, 3};
      case Word::less_equal: return Operator{ExprKind::less_equal, 4};
      case Word::greater_equal: return Operator{ExprKind::greater_equal, 4};
      case Word::sign: break;
      default: return std::nullopt;
    }
    switch (token_.sign) {
      case '<': return Operator{ExprKind::less, 4};
      case '>': return Operator{ExprKind::greater, 4};
      case '+': return Operator{ExprKind::add, 5};
      case '-': return Operator{ExprKind::subtract, 5};
      case '*': return Operator{ExprKind::multiply, 6};
      case '/': return Operator{ExprKind::divide, 6};
      case '%': return Operator{ExprKind::modulo, 6};
      default: return std::nullopt;
    }
  }

  /// Left-associative operators of more than `precedence` after `left`.
  Expr* binary(Expr* left, int precedence) {
    for (auto op = binary_operator(); op && op->precedence > precedence; op = binary_operator()) {
      const Position at = token_.at;
      advance();
      Expr* right = unary();
      for (auto next = binary_operator(); next && next->precedence > op->precedence; next = binary_operator())
        right = binary(right, op->precedence);
      left = node(op->kind, at, left, right);
    }
    return left;
  }

  Expr* unary() {
    const Level level(*this);
    const Position at = token_.at;
    if (take('-')) return node(ExprKind::negative, at, unary());
    if (take('+')) return node(ExprKind::positive, at, unary());
    if (take('!')) return node(ExprKind::negation, at, unary());
    return power(postfix(primary()));
  }

  /// a ^ b: the exponent has its own sign and further exponents.
  Expr* power(Expr* base) {
    if (!token_.is('^')) return base;
    const Position at = token_.at;
    advance();
    return node(ExprKind::power, at, base, unary());
  }

  Expr* variable(const Token& name) {
    if (is_special(name.text)) {
      auto e = add(std::make_unique<Special>(name.at, name.text));
      e->slot = program_.special(name.text);
      return e;
    }
    return add(std::make_unique<Variable>(name.at, name.text));
  }

  Expr* postfix(Expr* e) {
    for (;;) {
      const Position at = token_.at;
      if (take('(')) {
        e = call(e, at);
      } else if (take('[')) {
        Expr* index = expression();
        expect(']', "after the index");
        e = node(ExprKind::index, at, e, index);
      } else if (take('.')) {
        const Token name = token_;
        if (!take(Word::name)) fail("a name after \".\"");
        auto member = add(std::make_unique<Member>(name.at, name.text));
        member->a = e;
        e = deep(member);
      } else {
        return e;
      }
    }
  }

  Expr* call(Expr* callee, Position at) {
    auto e = add(std::make_unique<CallExpr>(callee->kind == ExprKind::variable ? callee->at : at));
    if (callee->kind == ExprKind::variable) {
      e->variable = static_cast<Variable*>(callee);
      e->name = e->variable->name;
    } else if (callee->kind == ExprKind::member) {
      e->method = true;
      e->name = static_cast<Member*>(callee)->name;
      e->a = callee;
    } else {
      e->a = callee;
    }
    e->arguments = arguments();
    deep(e);
    return deeper(e, depth_of(e->arguments));
  }

  Expr* primary() {
    const Token first = token_;
    switch (first.word) {
      case Word::number: advance(); return constant(first.at, first.number);
      case Word::string: advance(); return constant(first.at, Value::string(first.text));
      case Word::key_true: advance(); return constant(first.at, Value::truth(true));
      case Word::key_false: advance(); return constant(first.at, Value::truth(false));
      case Word::key_undef: advance(); return constant(first.at, {});
      case Word::name: advance(); return variable(first);
      case Word::key_function: return function_literal();
      case Word::key_let:
      case Word::key_assert:
      case Word::key_echo: return binding();
      default: break;
    }
    if (take('(')) {
      Expr* e = expression();
      expect(')', "after the expression");
      return e;
    }
    if (take('[')) return vector_or_range(first.at);
    fail("an expression");
  }

  Expr* function_literal() {
    auto e = add(std::make_unique<FunctionLiteral>(token_.at));
    advance();
    expect('(', "after function");
    ++literals_;
    e->function.parameters = parameters();
    e->function.at = e->at;
    e->function.unit = unit_;
    const std::size_t literals = literals_;
    e->function.body = expression();
    e->function.captured = literals_ != literals;
    return deeper(e, e->function.body->depth);
  }

  /// let (...) e, assert (...) e, echo (...) e; the last two may have no e.
  Expr* binding() {
    const Word word = token_.word;
    auto e = add(std::make_unique<BindExpr>(word == Word::key_let      ? ExprKind::let
                                            : word == Word::key_assert ? ExprKind::check
                                                                       : ExprKind::print,
                                            token_.at));
    advance();
    expect('(', "after the keyword");
    const std::size_t literals = literals_;
    e->arguments = arguments();
    const bool has_value = word == Word::key_let || starts_expression();
    if (has_value) e->a = expression();
    e->own_frame = word == Word::key_let && literals_ != literals;
    deep(e);
    return deeper(e, depth_of(e->arguments));
  }

  bool starts_expression() const {
    switch (token_.word) {
      case Word::name:
      case Word::number:
      case Word::string:
      case Word::key_true:
      case Word::key_false:
      case Word::key_undef:
      case Word::key_function:
      case Word::key_let:
      case Word::key_assert:
      case Word::key_echo: return true;
      default: break;
    }
    return token_.is('(') || token_.is('[') || token_.is('-') || token_.is('+') || token_.is('!');
  }

  Expr* vector_or_range(Position at) {
    auto v = add(std::make_unique<VectorExpr>(at));
    while (take(',')) {
    }
    if (take(']')) return v;
    Expr* first = element();
    if (token_.is(':')) return range(at, first);
    v->items.push_back(first);
    while (!token_.is(']')) {
      if (!token_.is(',')) fail("\",\" or \"]\" in the vector");
      while (take(',')) {
      }
      if (!token_.is(']')) v->items.push_back(element());
    }
    advance();
    std::uint16_t depth = 0;
    for (const Expr* item : v->items) {
      depth = std::max(depth, item->depth);
      v->generates = v->generates || item->kind >= ExprKind::each || generates(item);
    }
    return deeper(v, depth);
  }

  /// A let around elements that only vectors have is one, too.
  static bool generates(const Expr* e) {
    while (e != nullptr && e->kind == ExprKind::let) e = e->a;
    return e != nullptr && e->kind >= ExprKind::each;
  }

  Expr* range(Position at, Expr* first) {
    advance();
    Expr* second = expression();
    Expr* third = nullptr;
    if (take(':')) third = expression();
    expect(']', "at the end of the range");
    return third == nullptr ? node(ExprKind::range, at, first, nullptr, second)
                            : node(ExprKind::range, at, first, second, third);
  }

  /// An item of a vector: an expression, or for, if, each, let with such an item.
  Expr* element() {
    const Level level(*this);
    const Position at = token_.at;
    switch (token_.word) {
      case Word::key_each: advance(); return node(ExprKind::each, at, element());
      case Word::key_if: return filter();
      case Word::key_for: return loop();
      case Word::key_let: return let_element();
      default: break;
    }
    if (token_.is('(')) return parenthesised_element();
    return expression();
  }

  /// "(for ...)" is an element, "(1 + 2) * 3" an expression.
  Expr* parenthesised_element() {
    const Level level(*this);
    advance();
    Expr* e = element();
    expect(')', "after the expression");
    if (e->kind >= ExprKind::each || generates(e)) return e;
    return after_operand(power(postfix(e)));
  }

  Expr* let_element() {
    auto e = add(std::make_unique<BindExpr>(ExprKind::let, token_.at));
    advance();
    expect('(', "after let");
    const std::size_t literals = literals_;
    e->arguments = arguments();
    e->a = element();
    e->own_frame = literals_ != literals;
    deep(e);
    deeper(e, depth_of(e->arguments));
    return e;
  }

  Expr* filter() {
    const Position at = token_.at;
    advance();
    expect('(', "after if");
    Expr* condition = expression();
    expect(')', "after the condition");
    Expr* yes = element();
    Expr* no = take(Word::key_else) ? element() : nullptr;
    return node(ExprKind::filter, at, condition, yes, no);
  }

  Expr* loop() {
    auto e = add(std::make_unique<BindExpr>(ExprKind::loop, token_.at));
    advance();
    expect('(', "after for");
    const std::size_t literals = literals_;
    loop_head(*e);
    e->a = element();
    e->own_frame = literals_ != literals;
    deep(e);
    deeper(e, std::max(depth_of(e->arguments), depth_of(e->steps)));
    return e;
  }

  /// "i = values, ..." or "i = 0; i < n; i = i + 1".
  void loop_head(BindExpr& e) {
    while (!token_.is(')') && !token_.is(';')) {
      Argument a;
      a.at = token_.at;
      a.value = argument(a.name);
      a.special = is_special(a.name);
      if (a.special) a.slot = program_.special(a.name);
      e.arguments.push_back(std::move(a));
      if (!token_.is(',') && !token_.is(')') && !token_.is(';')) fail("\",\" or \")\" after the variable");
      while (take(',')) {
      }
    }
    if (take(')')) return;
    advance();
    e.kind = ExprKind::c_loop;
    e.b = expression();
    expect(';', "after the condition of the loop");
    e.steps = arguments();
  }

  Program& program_;
  const ReadSource& read_;
  const ParseLimits& limits_;
  Diagnostics& diagnostics_;
  std::vector<std::unique_ptr<Lexer>> lexers_;  // of the file that is parsed, then of those included
  Token token_;
  Unit* unit_ = nullptr;
  Body* block_ = nullptr;
  int nesting_ = 0;
  std::size_t literals_ = 0;            // function literals seen so far
  std::vector<std::string> including_;  // identities of the included files, one for each further lexer
  std::vector<Waiting> waiting_;

 public:
  void guarded(Source main, const std::vector<std::string>& defines) {
    try {
      run(std::move(main), defines);
    } catch (const TooMuch&) {  // reported
    }
  }
};

}  // namespace

std::unique_ptr<Program> parse(Source main, const std::vector<std::string>& defines, const ReadSource& read,
                               const ParseLimits& limits, const KnownNames& known, Diagnostics& diagnostics) {
  auto program = std::make_unique<Program>();
  Parser(*program, read, limits, diagnostics).guarded(std::move(main), defines);
  if (!diagnostics.has_errors()) resolve(*program, known, diagnostics);
  return program;
}

}  // namespace kerf::scad
