// Vectors and what generates their values: for, each, if, let.
#include <cmath>
#include <fmt/format.h>

#include "front/scad/run/values.h"

namespace kerf::scad {

Value Interpreter::eval_vector(const VectorExpr& e, Frame& f) {
  ItemList items;
  if (e.generates) {
    for (const Expr* item : e.items) generate(*item, f, items);
  } else {
    items.reserve(e.items.size());
    for (const Expr* item : e.items) append(*item, f, items);
  }
  return list(std::move(items), e.at);
}

void Interpreter::append(const Expr& e, Frame& f, ItemList& out) {
  double x = 0.0;
  Value other;
  if (number(e, f, x, other))
    out.push_back(x);
  else
    out.push_back(std::move(other));
}

void Interpreter::generate(const Expr& e, Frame& f, ItemList& out) {
  switch (e.kind) {
    case ExprKind::each: generate_each(e, f, out); return;
    case ExprKind::loop: {
      const auto& loop = static_cast<const BindExpr&>(e);
      const std::size_t mark = special_mark();
      FrameRef held;
      if (loop.own_frame) held = FrameRef(new_heap_frame(&f, loop.slots));
      generate_loop(loop, 0, loop.own_frame ? *held.get() : f, out);
      unwind(mark);
      return;
    }
    case ExprKind::c_loop: generate_c_loop(static_cast<const BindExpr&>(e), f, out); return;
    case ExprKind::filter:
      if (condition(*e.a, f))
        generate(*e.b, f, out);
      else if (e.c != nullptr)
        generate(*e.c, f, out);
      return;
    case ExprKind::let: {
      const auto& let = static_cast<const BindExpr&>(e);
      if (let.a->kind >= ExprKind::each || let.a->kind == ExprKind::let) {
        generate_let(let, f, out);
        return;
      }
      break;
    }
    default: break;
  }
  check_items(out.size() + 1, e.at);
  append(e, f, out);
}

void Interpreter::generate_let(const BindExpr& e, Frame& f, ItemList& out) {
  const std::size_t mark = special_mark();
  FrameRef held;
  if (e.own_frame) held = FrameRef(new_heap_frame(&f, e.slots));
  Frame& frame = e.own_frame ? *held.get() : f;
  bind(e.arguments, frame);
  generate(*e.a, frame, out);
  unwind(mark);
}

void Interpreter::generate_each(const Expr& e, Frame& f, ItemList& out) {
  // The operand is an element: a value, or values of a for.
  ItemList operands;
  generate(*e.a, f, operands);
  for (const Value& v : operands.items()) {
    if (v.is_undef()) continue;
    for_each_value(*this, v, e.at, [&](Value item) {
      check_items(out.size() + 1, e.at);
      out.push_back(std::move(item));
    });
  }
}

void Interpreter::generate_loop(const BindExpr& e, std::size_t argument, Frame& f, ItemList& out) {
  if (argument == e.arguments.size()) {
    generate(*e.a, f, out);
    return;
  }
  const Argument& a = e.arguments[argument];
  const Value values = eval(*a.value, f);
  if (argument + 1 == e.arguments.size() && values.is(Type::range) && e.a->kind < ExprKind::each) {
    const double count = values.range().count();
    if (count <= static_cast<double>(limits_.max_range))
      out.reserve(out.size() + static_cast<std::size_t>(count));
  }
  const std::size_t mark = special_mark();
  for_each_value(*this, values, e.at, [&](Value item) {
    tick(e.at);
    if (a.special) {
      unwind(mark);
      bind_special(a.slot, std::move(item));
    } else if (!a.name.empty()) {
      f.slots[a.slot] = std::move(item);
    }
    generate_loop(e, argument + 1, f, out);
  });
  unwind(mark);
}

void Interpreter::generate_c_loop(const BindExpr& e, Frame& f, ItemList& out) {
  const std::size_t mark = special_mark();
  FrameRef held;
  if (e.own_frame) held = FrameRef(new_heap_frame(&f, e.slots));
  Frame& frame = e.own_frame ? *held.get() : f;
  bind(e.arguments, frame);
  std::uint32_t turn = 0;
  while (condition(*e.b, frame)) {
    if (turn++ > limits::kMaxScadTurns)
      fail(codes::scad_limit, e.at,
           fmt::format("for loop counter exceeded limit: {} passes", limits::kMaxScadTurns));
    tick(e.at);
    generate(*e.a, frame, out);
    bind(e.steps, frame);
  }
  unwind(mark);
}

}  // namespace kerf::scad
