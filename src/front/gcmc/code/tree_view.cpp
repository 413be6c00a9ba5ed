// What the syntax tree says before it is compiled.
#include "front/gcmc/code/tree_view.h"

#include <utility>
#include <vector>

#include "front/gcmc/code/operators.h"

namespace kerf::gcmc {

bool TreeView::has_effects(NodeId id) const {
  if (id == kNoNode) return false;
  const Node& n = node(id);
  if (n.kind == NodeKind::assign || n.kind == NodeKind::step) return true;
  if (n.kind == NodeKind::call && tree_.function_index.count(n.name) != 0) return true;
  if (has_effects(n.a) || has_effects(n.b) || has_effects(n.c)) return true;
  for (std::size_t i = 0; i < n.count; ++i)
    if (has_effects(child(n, i))) return true;
  return false;
}

std::optional<Value> TreeView::constant_value(NodeId id) const {
  if (id == kNoNode) return std::nullopt;
  const Node& n = node(id);
  if (n.kind == NodeKind::number) return Value(n.number);
  if (n.kind == NodeKind::vector) return constant_vector(n);
  if (n.kind == NodeKind::unary && n.op == Token::minus) {
    const auto a = constant_value(n.a);
    Scalar out;
    if (a && a->is_scalar() && multiply_plain(a->scalar(), Scalar::integer(-1), out)) return Value(out);
  }
  if (n.kind != NodeKind::binary) return std::nullopt;
  if (n.op != Token::plus && n.op != Token::minus && n.op != Token::star) return std::nullopt;
  const auto a = constant_value(n.a);
  if (!a || !a->is_scalar()) return std::nullopt;
  const auto b = constant_value(n.b);
  if (!b || !b->is_scalar()) return std::nullopt;
  Scalar out;
  const bool good = n.op == Token::plus    ? add_plain(a->scalar(), b->scalar(), out)
                    : n.op == Token::minus ? subtract_plain(a->scalar(), b->scalar(), out)
                                           : multiply_plain(a->scalar(), b->scalar(), out);
  return good ? std::optional<Value>(Value(out)) : std::nullopt;
}

std::optional<Value> TreeView::constant_vector(const Node& n) const {
  std::vector<Scalar> all(n.count);
  for (std::size_t i = 0; i < n.count; ++i) {
    if (child(n, i) == kNoNode) continue;
    const auto v = constant_value(child(n, i));
    if (!v || !v->is_scalar()) return std::nullopt;
    all[i] = v->scalar();
  }
  return Value::vector(all.data(), all.size(), meter_);
}

std::optional<Value> TreeView::constant_list(const Node& n) const {
  std::vector<Value> all;
  for (std::size_t i = 0; i < n.count; ++i) {
    auto v = node(child(n, i)).kind == NodeKind::vector ? constant_value(child(n, i)) : std::nullopt;
    if (!v) return std::nullopt;
    all.push_back(std::move(*v));
  }
  return Value::list(std::move(all), meter_);
}

/// Splits v[i] and v[i][j]; false for longer chains, which are not lvalues.
bool TreeView::element_of(NodeId id, NodeId& base, NodeId& first, NodeId& second) const {
  first = node(id).b;
  second = kNoNode;
  base = node(id).a;
  if (node(base).kind == NodeKind::index) {
    second = first;
    first = node(base).b;
    base = node(base).a;
  }
  return node(base).kind == NodeKind::name;
}

}  // namespace kerf::gcmc
