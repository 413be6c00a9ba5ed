// The syntax tree of an OpenSCAD program. Nodes are owned by their Program and refer to each other by
// pointers; names of variables are resolved to frames and slots by resolve.h.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "front/scad/text/source.h"
#include "front/scad/value/value.h"

namespace kerf::scad {

enum class ExprKind : std::uint8_t {
  constant,
  local,     // a variable of the current frame that is always set
  variable,  // a variable of this or an outer frame
  special,   // $fn
  negative,
  positive,
  negation,
  multiply,
  divide,
  modulo,
  power,
  add,
  subtract,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  both,
  either,
  choice,  // a ? b : c
  index,   // a[b]
  member,  // a.name
  call,
  vector,
  range,
  let,
  check,  // assert(...) a
  print,  // echo(...) a
  literal,
  // only inside of vectors
  each,
  loop,    // for (name = values) a
  c_loop,  // for (start; condition; step) a
  filter,  // if (a) b else c
};

/// Instead of a number of frames: the frame of the used file in which a function or module is defined.
inline constexpr std::uint32_t kOfUnit = 0xffffffffu;

struct Expr {
  Expr(ExprKind k, Position p) : kind(k), at(p) {}
  virtual ~Expr() = default;
  ExprKind kind;
  std::uint16_t depth = 1;  // of the tree below it
  std::uint32_t hops = 0;   // variables: frames outwards
  std::uint32_t slot = 0;   // variables: of that frame; specials: number
  Position at;
  Expr *a = nullptr, *b = nullptr, *c = nullptr;
};

struct Constant final : Expr {
  Constant(Position p, Value v) : Expr(ExprKind::constant, p), value(std::move(v)) {}
  Value value;
};

/// Where a variable is found: so many frames outwards, in this slot.
struct SlotPath {
  std::uint32_t hops = 0, slot = 0;
};

struct Variable final : Expr {
  Variable(Position p, std::string n) : Expr(ExprKind::variable, p), name(std::move(n)) {}
  std::string name;
  bool found = false;            // there is one: `hops` and `slot`
  std::vector<SlotPath> others;  // further outwards, for as long as the one before is not assigned yet
};

struct Special final : Expr {
  Special(Position p, std::string n) : Expr(ExprKind::special, p), name(std::move(n)) {}
  std::string name;
};

struct Member final : Expr {
  Member(Position p, std::string n) : Expr(ExprKind::member, p), name(std::move(n)) {}
  std::string name;
};

/// An argument of a call, or a variable of let and for.
struct Argument {
  std::string name;  // may be empty
  Expr* value = nullptr;
  Position at;
  bool special = false;    // `slot` is the number of a special variable
  std::uint32_t slot = 0;  // of let and for
  bool ignored = false;    // of let: assigned before
};

/// An argument that a call evaluates, and the parameter that has its value.
struct Taken {
  std::uint32_t argument = 0;
  std::int32_t parameter = -1;  // -1: none; the argument may be a special variable
};

struct Parameter {
  std::string name;
  Expr* standard = nullptr;
  Position at;
  bool special = false;
  std::uint32_t slot = 0;            // or the number of a special variable
  std::uint32_t standard_slots = 0;  // of the frame in which `standard` is evaluated
  bool captured = false;             // a function literal refers to that frame
  bool undeclared = false;           // only calls name it: without an argument it does not exist
  bool visible = false;              // `standard` may print
};

struct Function {
  std::string name;  // empty: a literal
  std::vector<Parameter> parameters;
  Expr* body = nullptr;
  Position at;
  std::uint32_t slots = 0;            // of its frame
  bool captured = false;              // its frame may outlive the call: a literal refers to it
  const struct Unit* unit = nullptr;  // the file that it is in
};

struct FunctionLiteral final : Expr {
  explicit FunctionLiteral(Position p) : Expr(ExprKind::literal, p) {}
  Function function;
};

struct CallExpr final : Expr {
  explicit CallExpr(Position p) : Expr(ExprKind::call, p) {}
  std::string name;  // of a function; empty: the value of `a` is called
  std::vector<Argument> arguments;
  Variable* variable = nullptr;  // of this name, if there is one: a function literal
  // A method: `a` is the object, `name` the command.
  bool method = false;
  const Function* function = nullptr;
  std::uint32_t function_hops = 0;        // to the frame in which it is defined, see kOfUnit
  std::vector<std::int32_t> map;          // of each parameter of `function`: its argument, or -1
  std::vector<Taken> taken;               // the arguments in the order of evaluation
  bool ordered = false;                   // that order can be seen
  int builtin = -1, command = -1;         // in the tables of the interpreter
  double (*of_number)(double) = nullptr;  // a built-in function of one number, called with one argument
};

struct VectorExpr final : Expr {
  explicit VectorExpr(Position p) : Expr(ExprKind::vector, p) {}
  std::vector<Expr*> items;
  bool generates = false;  // has an item of the kinds that only vectors have
};

/// let, assert, echo, and the loops of vectors.
struct BindExpr final : Expr {
  BindExpr(ExprKind k, Position p) : Expr(k, p) {}
  std::vector<Argument> arguments;
  std::vector<Argument> steps;  // of for (start; condition; step)
  bool own_frame = false;       // a literal refers to its variables
  std::uint32_t slots = 0;      // of that frame
};

// ------------------------------------------------------------------------------------------- statements

struct Body;
struct Module;

enum class StatementKind : std::uint8_t { call, choice, loop, let, check, print };

struct Statement {
  Statement(StatementKind k, Position p) : kind(k), at(p) {}
  StatementKind kind;
  char modifier = 0;  // ! # % of the statement; those with * are left out
  Position at;
  std::string name;        // of the called module
  Expr* object = nullptr;  // of a call of a method
  std::vector<Argument> arguments;
  Body* children = nullptr;   // never null
  Body* otherwise = nullptr;  // of choice
  std::uint32_t slots = 0;    // of the frame of for and let
  bool captured = false;      // a function literal refers to that frame
  // the called module: of the program, or in the tables of the interpreter
  const Module* module = nullptr;
  std::uint32_t module_hops = 0;  // to the frame in which it is defined, see kOfUnit
  std::vector<Taken> taken;       // the arguments in the order of evaluation
  int builtin = -1, command = -1;
};

struct Assignment {
  std::string name;
  Expr* value = nullptr;
  Position at, first;  // of the assignment that counts, and of the first one of this name
  bool special = false;
  std::uint32_t slot = 0;
  bool after_statement = false;  // a statement of the block precedes it
};

/// Statements with variables, functions and modules of their own.
struct Body {
  std::vector<Assignment> assignments;  // in the order of first assignment, the last value of each
  std::unordered_map<std::string, std::size_t> names;  // of assignments
  std::unordered_map<std::string, Function*> functions;
  std::unordered_map<std::string, Module*> modules;
  std::vector<Statement*> statements;
  bool own_frame = false;  // has variables, functions or modules
  bool captured = false;   // a function literal refers to its frame
  std::uint32_t slots = 0;
};

struct Module {
  std::string name;
  std::vector<Parameter> parameters;
  Body* body = nullptr;             // its frame has the parameters first
  std::uint32_t children_slot = 0;  // of $children
  Position at;
  const struct Unit* unit = nullptr;
};

/// A parameter for the user, from an assignment of the main file and the comments around it.
struct CustomParameter {
  std::string name, group, description, choices;  // `choices`: the text of the comment after it
  std::string value;                              // the text of the assigned expression
  Position at;
};

/// A file with what it includes. Those that it uses are other units.
struct Unit {
  std::string path;
  Body* block = nullptr;
  std::vector<Unit*> used;  // the last one first: it is searched first
  std::size_t index = 0;    // in the program
  bool varies = false;      // its variables depend on special ones of the caller, or print
};

struct Program {
  Sources sources;
  std::vector<std::unique_ptr<Expr>> expressions;
  std::vector<std::unique_ptr<Statement>> statements;
  std::vector<std::unique_ptr<Body>> blocks;
  std::vector<std::unique_ptr<Function>> functions;
  std::vector<std::unique_ptr<Module>> modules;
  std::vector<std::unique_ptr<Unit>> units;  // the first one is the program's
  std::vector<std::string> specials;         // names of special variables by number
  std::unordered_map<std::string, std::uint32_t> special_numbers;
  std::vector<CustomParameter> parameters;
  std::vector<std::string> files;  // all files read, the program's own first
  std::vector<std::string> fonts;  // font files that it uses

  std::uint32_t special(const std::string& name) {
    const auto [it, is_new] = special_numbers.try_emplace(name, static_cast<std::uint32_t>(specials.size()));
    if (is_new) specials.push_back(name);
    return it->second;
  }
};

/// An expression as echo prints it.
/// The sign of an operator with two operands; empty for other expressions.
std::string_view sign_of(ExprKind kind);
std::string text_of(const Expr& expr);
std::string text_of(const Function& literal);

}  // namespace kerf::scad
