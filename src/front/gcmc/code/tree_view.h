// What the syntax tree says before it is compiled: constants, effects, elements.
#pragma once

#include <cstddef>
#include <optional>

#include "front/gcmc/text/ast.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

class TreeView {
 public:
  TreeView(const Tree& tree, Meter& meter) : tree_(tree), meter_(meter) {}

  const Node& node(NodeId id) const { return tree_.nodes[static_cast<std::size_t>(id)]; }
  NodeId child(const Node& n, std::size_t i) const { return tree_.children[n.first + i]; }

  /// Whether an expression assigns to variables or calls a function of the program.
  bool has_effects(NodeId id) const;
  /// The value of an expression without variables; nothing for others, and for text.
  std::optional<Value> constant_value(NodeId id) const;
  /// The value of a list of constant vectors.
  std::optional<Value> constant_list(const Node& n) const;
  /// Takes v[first] or v[first][second] apart; false if `base` is no variable.
  bool element_of(NodeId id, NodeId& base, NodeId& first, NodeId& second) const;

 private:
  std::optional<Value> constant_vector(const Node& n) const;

  const Tree& tree_;
  Meter& meter_;
};

}  // namespace kerf::gcmc
