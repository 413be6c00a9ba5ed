// The syntax tree of a program: nodes in one array, referenced by index. Made by the parser, used by the
// compiler.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "front/gcmc/text/lexer.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

using NodeId = std::int32_t;
using NameId = std::int32_t;
constexpr NodeId kNoNode = -1;
constexpr NameId kNoName = -1;

enum class NodeKind : std::uint8_t {
  // expressions
  number,     // number
  text,       // name: the string's index in Tree::strings
  vector,     // list of entries, kNoNode for '-'
  list,       // list of vectors
  name,       // name
  call,       // name; list of arguments
  index,      // a[b]
  unary,      // op a
  binary,     // a op b, the short-circuit ones too
  condition,  // a ? b : c
  assign,     // a op b
  step,       // ++ or -- (op) on a; `prefix`: before a
  // statements
  block,         // list of statements
  expression,    // a
  if_else,       // if a b else c
  for_loop,      // for(a; b; c) d
  while_loop,    // while a b
  do_loop,       // do b while a
  foreach_loop,  // foreach(a; name) b
  repeat_loop,   // repeat(a; name) b
  function,      // definition of Tree::functions[a]
  return_value,  // return a
  break_loop,
  continue_loop,
  local,     // name = a
  constant,  // name = a
};

struct Node {
  NodeKind kind = NodeKind::block;
  Token op = Token::end;
  bool prefix = false;         // of a step
  bool parenthesised = false;  // not an lvalue; no warning for an assignment in a condition
  SourceLocation at;
  NodeId a = kNoNode, b = kNoNode, c = kNoNode, d = kNoNode;
  NameId name = kNoName;
  std::uint32_t first = 0, count = 0;  // children in Tree::children
  std::uint32_t height = 0;            // of an expression's tree
  Scalar number;
};

struct Parameter {
  NameId name = kNoName;
  bool by_reference = false;
  NodeId preset = kNoNode;
};

struct FunctionTree {
  NameId name = kNoName;
  std::vector<Parameter> parameters;
  NodeId body = kNoNode;
};

struct Tree {
  std::vector<Node> nodes;
  std::vector<NodeId> children;
  std::vector<std::string> names;
  std::unordered_map<std::string, NameId> name_index;
  std::vector<std::u32string> strings;
  std::vector<FunctionTree> functions;
  std::unordered_map<NameId, std::int32_t> function_index;
  std::vector<NodeId> program;  // top-level statements in order

  NameId intern(std::string_view name);
  NodeId add(Node node);
  NodeId add_with_children(Node node, const std::vector<NodeId>& list);
};

}  // namespace kerf::gcmc
