// Statements: blocks with their assignments, calls of modules, children, loops.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/enter.h"
#include "front/scad/run/site.h"
#include "front/scad/run/values.h"

namespace kerf::scad {

BlockFrame::BlockFrame(Interpreter& run, Frame* parent, std::uint32_t slots, bool captured, Position at)
    : stack_(run.stack_), base_(run.stack_.top()) {
  if (captured) {
    heap_ = FrameRef(run.new_heap_frame(parent, slots));
    frame_ = heap_.get();
    return;
  }
  run.reserve(slots, at);
  plain_ = {parent, stack_.grow(slots), slots, false};
  frame_ = &plain_;
}

// --------------------------------------------------------------------------------------------- program

Frame& Interpreter::make_unit_frame(const Unit& unit) {
  Frame& frame = unit_frames_[unit.index];
  unit_ready_[unit.index] = 1;
  unit_values_[unit.index].assign(unit.block->slots, Value::unset());
  frame = {&root_, unit_values_[unit.index].data(), unit.block->slots, false};
  for (const Assignment& a : unit.block->assignments)
    if (!a.special) frame.slots[a.slot] = eval(*a.value, frame);
  return frame;
}

/// The frame of a used file while one of its functions or modules runs. As in OpenSCAD each such call assigns
/// the variables of the file; those that are the same in each call are assigned once.
FrameRef Interpreter::enter_unit(const Unit& unit) {
  if (unit.index != 0 && unit.varies) {
    FrameRef own(new_heap_frame(&root_, unit.block->slots));
    assign(*unit.block, *own.get());
    return own;
  }
  Frame& frame = unit_frame(unit);
  if (unit.index != 0)
    for (const Assignment& a : unit.block->assignments)
      if (a.special) bind_special(a.slot, eval(*a.value, frame));
  return FrameRef(&frame);
}

Shapes Interpreter::run() {
  stack_start_ = static_cast<const char*>(__builtin_frame_address(0));
  Shapes shapes;
  try {
    const Unit& unit = *program_.units[0];
    unit_ready_[0] = 1;
    unit_values_[0].assign(unit.block->slots, Value::unset());
    unit_frames_[0] = {&root_, unit_values_[0].data(), unit.block->slots, false};
    assign(*unit.block, unit_frames_[0]);
    run_statements(*unit.block, {&unit_frames_[0], nullptr}, shapes);
  } catch (const Stop&) {  // reported
  }
  return has_root_ ? std::move(root_shapes_) : std::move(shapes);
}

/// `specials`: a mark; special variables that were bound since keep their value.
void Interpreter::assign(const Body& b, Frame& f, std::size_t specials) {
  const auto hidden = [&](std::uint32_t number) {
    return std::any_of(undo_.begin() + static_cast<std::ptrdiff_t>(std::min(specials, undo_.size())),
                       undo_.end(), [&](const auto& entry) { return entry.first == number; });
  };
  for (const Assignment& a : b.assignments)
    if (!a.special) f.slots[a.slot] = Value::unset();
  for (const Assignment& a : b.assignments) {
    Value v = eval(*a.value, f);
    if (!a.special)
      f.slots[a.slot] = std::move(v);
    else if (!hidden(a.slot))
      bind_special(a.slot, std::move(v));
  }
}

// ---------------------------------------------------------------------------------------------- blocks

void Interpreter::run_block(const Body& b, const Context& outer, Shapes& out) {
  const std::size_t mark = special_mark();
  if (!b.own_frame) {
    assign(b, *outer.frame, outer.specials);
    run_statements(b, {outer.frame, outer.activation}, out);
  } else {
    const BlockFrame frame(*this, outer.frame, b.slots, b.captured, trace_->at);
    assign(b, *frame.get(), outer.specials);
    run_statements(b, {frame.get(), outer.activation}, out);
  }
  unwind(mark);
}

Shapes Interpreter::run_separately(const Body& b, const Context& outer) {
  const std::size_t mark = special_mark();
  const BlockFrame own(*this, outer.frame, b.own_frame ? b.slots : 0, b.captured, trace_->at);
  const Context context{b.own_frame ? own.get() : outer.frame, outer.activation};
  assign(b, *context.frame, outer.specials);
  Shapes all;
  for (const Statement* s : b.statements) {
    Shapes shapes;
    run_statement(*s, context, shapes);
    Shape sum = united(*this, std::move(shapes), s->at);
    if (sum.kind != Shape::Kind::nothing) all.push_back(std::move(sum));
  }
  unwind(mark);
  return all;
}

void Interpreter::run_children_of(const Activation& a, const std::vector<std::size_t>* which, Position at,
                                  Shapes& out) {
  static const std::string kName = "children";
  const Enter entered(*this, at, &kName);
  const Body& b = *a.children;
  const Context context{a.frame, a.around};
  if (which == nullptr) {
    run_statements(b, context, out);
    return;
  }
  for (const std::size_t i : *which)
    if (i < b.statements.size()) run_statement(*b.statements[i], context, out);
}

void Interpreter::run_statements(const Body& b, const Context& context, Shapes& out) {
  for (const Statement* s : b.statements) run_statement(*s, context, out);
}

void Interpreter::run_statement(const Statement& s, const Context& context, Shapes& out) {
  if (s.modifier == '!') {
    has_root_ = true;
    run_kind(s, context, root_shapes_);
  } else if (s.modifier == '%') {
    Shapes background;
    run_kind(s, context, background);
  } else {
    run_kind(s, context, out);
  }
}

void Interpreter::run_kind(const Statement& s, const Context& context, Shapes& out) {
  switch (s.kind) {
    case StatementKind::call: run_call(s, context, out); return;
    case StatementKind::choice:
      if (condition(*s.arguments[0].value, *context.frame))
        run_block(*s.children, context, out);
      else if (s.otherwise != nullptr)
        run_block(*s.otherwise, context, out);
      return;
    case StatementKind::check:
      check(s.arguments, *context.frame, s.at);
      run_block(*s.children, context, out);
      return;
    case StatementKind::print:
      print_arguments(s.arguments, *context.frame, s.at);
      run_block(*s.children, context, out);
      return;
    case StatementKind::let:
    case StatementKind::loop: {
      const std::size_t mark = special_mark();
      const BlockFrame frame(*this, context.frame, s.slots, s.captured, s.at);
      const Context inner{frame.get(), context.activation};
      if (s.kind == StatementKind::let) {
        bind(s.arguments, *inner.frame);
        run_block(*s.children, inner, out);
      } else {
        Shapes passes;
        run_loop(s, 0, inner, s.name == "for" ? out : passes);
        if (s.name != "for") intersect_passes(*this, s.at, passes, out);
      }
      unwind(mark);
      return;
    }
  }
}

void Interpreter::run_loop(const Statement& s, std::size_t argument, const Context& inner, Shapes& out) {
  if (argument == s.arguments.size()) {
    if (s.name == "for") {
      run_block(*s.children, inner, out);
      return;
    }
    Shapes pass;
    run_block(*s.children, inner, pass);
    out.push_back(united(*this, std::move(pass), s.at));
    return;
  }
  const Argument& a = s.arguments[argument];
  const Value values = eval(*a.value, *inner.frame);
  const std::size_t mark = special_mark();
  for_each_value(*this, values, a.at, [&](Value item) {
    tick(a.at);
    if (a.special) {
      unwind(mark);
      bind_special(a.slot, std::move(item));
    } else if (!a.name.empty()) {
      inner.frame->slots[a.slot] = std::move(item);
    }
    run_loop(s, argument + 1, inner, out);
  });
  unwind(mark);
}

// ----------------------------------------------------------------------------------------------- calls

void Interpreter::run_call(const Statement& s, const Context& context, Shapes& out) {
  if (s.object != nullptr) {
    run_method(s, context, out);
  } else if (s.module != nullptr) {
    run_module(s, context, out);
  } else if (s.builtin >= 0) {
    run_builtin(s, context, out);
  } else if (s.command >= 0) {
    call_command(s.command, s.arguments, *context.frame, s.at, nullptr, s.children, context, &out);
  } else {
    error(codes::scad_unknown, s.at, fmt::format("unknown module {}()", s.name)).hint =
        unknown_name_hint(s.name);
  }
}

void Interpreter::run_builtin(const Statement& s, const Context& context, Shapes& out) {
  const BuiltinModule& module = builtin_modules()[static_cast<std::size_t>(s.builtin)];
  const std::size_t mark = special_mark();
  const Context of_children{context.frame, context.activation, mark};
  ModuleCall call{*this, s, module, of_children, {}, out};
  call.values.resize(module.positional.size() + module.named.size());
  if (module.evaluated == ModuleArguments::none) {
    if (!s.arguments.empty())
      warn(codes::scad_call, s.arguments[0].at,
           fmt::format("{}() takes no arguments; they are not evaluated", s.name));
  } else {
    for (const Taken& t : s.taken) {
      const Argument& a = s.arguments[t.argument];
      Value v = eval(*a.value, *context.frame);
      if (t.parameter >= 0)
        call.values[static_cast<std::size_t>(t.parameter)] = std::move(v);
      else if (a.special)
        bind_special(a.slot, std::move(v));
    }
  }
  tick(s.at);
  module.run(call);
  unwind(mark);
}

void Interpreter::run_method(const Statement& s, const Context& context, Shapes& out) {
  const Value object = eval(*s.object, *context.frame);
  if (!object.is(Type::object)) {
    error(codes::scad_unknown, s.at,
          fmt::format("{}() is called on {} value; expected an object, as of gcodepreview()", s.name,
                      object.is_undef() ? "an undefined" : fmt::format("a {}", name_of(object.type()))));
  } else if (s.command < 0) {
    error(codes::scad_unknown, s.at, fmt::format("unknown command {}()", s.name)).hint =
        unknown_name_hint(s.name);
  } else {
    call_command(s.command, s.arguments, *context.frame, s.at, static_cast<const Object*>(object.block()),
                 s.children, context, &out);
  }
}

void Interpreter::run_module(const Statement& s, const Context& context, Shapes& out) {
  const Module& m = *s.module;
  const Enter entered(*this, s.at, &m.name);
  const std::size_t mark = special_mark();
  FrameRef unit;
  Frame* around = context.frame;
  if (s.module_hops == kOfUnit) {
    unit = enter_unit(*m.unit);
    around = unit.get();
  } else {
    for (std::uint32_t i = 0; i < s.module_hops; ++i) around = around->parent;
  }
  // The variables of the children first, once: the arguments and the module see them.
  const Body& children = *s.children;
  const BlockFrame own(*this, context.frame, children.own_frame ? children.slots : 0, children.captured,
                       s.at);
  Frame* of_children = children.own_frame ? own.get() : context.frame;
  assign(children, *of_children, mark);
  const BlockFrame frame(*this, around, m.body->slots, m.body->captured, s.at);
  Value* slots = frame.get()->slots;
  slots[m.children_slot] = static_cast<double>(children.statements.size());
  set_standard_values(m.parameters, s.taken, around, slots);
  if (slots[m.children_slot].is(Type::unset))  // an argument of other calls
    slots[m.children_slot] = static_cast<double>(children.statements.size());
  for (const Taken& t : s.taken) {
    const Argument& a = s.arguments[t.argument];
    Value v = eval(*a.value, *of_children);
    if (t.parameter >= 0)
      set_parameter(m.parameters[static_cast<std::size_t>(t.parameter)], std::move(v), slots);
    else if (a.special)
      bind_special(a.slot, std::move(v));
  }
  const Activation activation{activation_, &m, s.children, of_children, context.activation};
  activation_ = &activation;
  std::size_t depth = 0;
  if (const auto it = program_.special_numbers.find("$parent_modules");
      it != program_.special_numbers.end()) {
    for (const Activation* a = activation_; a != nullptr; a = a->outer) ++depth;
    bind_special(it->second, static_cast<double>(depth));
  }
  assign(*m.body, *frame.get());
  run_statements(*m.body, {frame.get(), &activation}, out);
  activation_ = activation.outer;
}

Shape Site::children() {
  ran_children_ = true;
  Shapes shapes;
  if (children_ != nullptr) run_.run_block(*children_, context_, shapes);
  return united(run_, std::move(shapes), at_);
}

}  // namespace kerf::scad
