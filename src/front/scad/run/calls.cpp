// Calls of functions, function literals, built-in functions and commands.
//
// A call in tail position reuses the frame of its caller: functions that end with a call of a function run in
// constant space.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "base/number.h"
#include "front/scad/run/enter.h"
#include "front/scad/run/interpreter.h"
#include "front/scad/run/site.h"
#include "front/scad/text/argument_order.h"

namespace kerf::scad {
namespace {

/// Takes values from the stack again, also after an error.
class StackMark {
 public:
  explicit StackMark(ValueStack& s) : stack_(s), base(s.top()) {}
  ~StackMark() { stack_.shrink(base); }
  StackMark(const StackMark&) = delete;

 private:
  ValueStack& stack_;

 public:
  Value* const base;
};

}  // namespace

void Interpreter::reserve(std::size_t slots, Position at) {
  if (!stack_.has_room(slots))
    fail(codes::scad_limit, at, "calls are nested too deep: no room for their variables");
}

bool Interpreter::find_target(const CallExpr& e, Frame& f, Target& target) {
  if (e.a != nullptr && e.a->kind == ExprKind::special) return false;
  if (e.variable != nullptr || (e.a != nullptr && !e.method)) {
    Value v;
    if (e.variable != nullptr) {
      // A variable that is not assigned yet, or is no function, hides no function of the same name.
      Frame* frame = &f;
      for (std::uint32_t i = 0; i < e.variable->hops; ++i) frame = frame->parent;
      v = frame->slots[e.variable->slot];
      if (v.is(Type::unset) && !e.variable->others.empty()) v = variable(*e.variable, f);
    } else {
      v = eval(*e.a, f);
    }
    if (v.is(Type::function)) {
      const auto* closure = static_cast<const Closure*>(v.block());
      target.function = closure->function;
      target.frame = closure->frame();
      target.mapped = false;
      target.of_other_file = false;
      target.literal = std::move(v);
      return true;
    }
  }
  if (e.function == nullptr) return false;
  target.function = e.function;
  target.mapped = true;
  target.literal = {};
  target.of_other_file = e.function_hops == kOfUnit;
  if (target.of_other_file) return true;
  target.frame = &f;
  for (std::uint32_t i = 0; i < e.function_hops; ++i) target.frame = target.frame->parent;
  return true;
}

Value Interpreter::call(const CallExpr& e, Frame& f) {
  Target target;
  if (e.method || !find_target(e, f, target)) {
    if (e.method) return call_method(e, f);
    if (e.builtin >= 0) return call_builtin(e, f);
    if (e.command >= 0)
      return call_command(e.command, e.arguments, f, e.at, nullptr, nullptr, {&f, activation_}, nullptr);
    return call_unknown(e);
  }
  const Enter entered(*this, e.at, target.function->name.empty() ? &e.name : &target.function->name);
  const StackMark mark(stack_);
  FrameRef unit;
  if (target.of_other_file) {
    unit = enter_unit(*target.function->unit);
    target.frame = unit.get();
  }
  CallFrame frame;
  make_frame(frame, target, e.at);
  take(e, target, f, frame.frame->slots);
  return run_body(target, frame, mark.base, e.name);
}

Value Interpreter::call_unknown(const CallExpr& e) {
  if (e.name.empty()) {
    warn(codes::scad_unknown, e.at,
         e.a->kind == ExprKind::special
             ? "a dynamically scoped variable cannot be called as a function; the result is undef"
             : "a value that is no function is called; the result is undef");
    return {};
  }
  error(codes::scad_unknown, e.at, fmt::format("unknown function {}(); its value is undef", e.name)).hint =
      e.variable != nullptr ? fmt::format("the variable {} is no function", e.name)
                            : unknown_name_hint(e.name);
  return {};
}

Value Interpreter::call_value(const Value& function, std::span<const Value> arguments, Position at) {
  if (!function.is(Type::function)) fail(codes::scad_call, at, "the value to be called is no function");
  static const std::string kName = "function";
  const auto* closure = static_cast<const Closure*>(function.block());
  Target target;
  target.function = closure->function;
  target.frame = closure->frame();
  target.literal = function;
  const Enter entered(*this, at, &kName);
  const StackMark mark(stack_);
  CallFrame frame;
  make_frame(frame, target, at);
  take_values(arguments, target, frame.frame->slots);
  return run_body(target, frame, mark.base, {});
}

void Interpreter::make_frame(CallFrame& into, const Target& target, Position at) {
  const std::uint32_t slots = target.function->slots;
  if (target.function->captured) {
    into.heap = FrameRef(new_heap_frame(target.frame, slots));
    into.frame = into.heap.get();
  } else {
    reserve(slots, at);
    into.stack = {target.frame, stack_.grow(slots), slots, false};
    into.frame = &into.stack;
  }
}

/// A call in tail position: the new variables replace those of the caller. `is_same`: a function calls
/// itself.
void Interpreter::enter_again(CallFrame& into, const Target& target, const CallExpr& e, Frame& caller,
                              Value* base, bool is_same) {
  CallFrame next;
  Value* fresh = stack_.top();
  make_frame(next, target, e.at);
  if (is_same)
    take_again(e, target, caller, into, next.frame->slots);
  else
    take(e, target, caller, next.frame->slots);
  const std::uint32_t slots = target.function->slots;
  if (!is_same) into.let_specials.clear();
  if (target.function->captured) {
    if (is_same)  // as in OpenSCAD 2021.01, literals made before see the new values
      std::move(next.frame->slots, next.frame->slots + slots, into.frame->slots);
    else
      into.heap = std::move(next.heap);
    into.frame = into.heap.get();
    stack_.shrink(base);
    return;
  }
  if (fresh != base)
    for (std::uint32_t i = 0; i < slots; ++i) base[i] = std::move(fresh[i]);
  stack_.shrink(base + slots);
  into.heap = FrameRef();
  into.stack = {target.frame, base, slots, false};
  into.frame = &into.stack;
}

/// `name`: by which the function is called.
Value Interpreter::run_body(Target& target, CallFrame& frame, Value* base, std::string_view name) {
  for (std::uint32_t turn = 0;; ++turn) {
    if (turn > limits::kMaxScadTurns)
      fail(codes::scad_limit, target.function->at, "recursion detected: too many calls in tail position");
    Value result;
    FrameRef held;
    Frame* inner = frame.frame;
    const CallExpr* tail = tail_call(target.function->body, frame, inner, held, result);
    if (tail == nullptr) return result;
    tick(tail->at);
    Target next;
    if (!find_target(*tail, *inner, next) || next.of_other_file) return call(*tail, *inner);
    const bool is_same = next.function == target.function && !name.empty() && tail->name == name;
    enter_again(frame, next, *tail, *inner, base, is_same);
    target = std::move(next);
    name = tail->name;
  }
}

/// Follows an expression to the call that gives its value; null, with the value, if there is none.
const CallExpr* Interpreter::tail_call(const Expr* e, CallFrame& call_frame, Frame*& f, FrameRef& held,
                                       Value& result) {
  for (;;) {
    switch (e->kind) {
      case ExprKind::choice: e = condition(*e->a, *f) ? e->b : e->c; continue;
      case ExprKind::let: {
        const auto& let = static_cast<const BindExpr&>(*e);
        if (let.own_frame) {
          held = FrameRef(new_heap_frame(f, let.slots));
          f = held.get();
        }
        bind(let.arguments, *f);
        for (const Argument& a : let.arguments)
          if (a.special) call_frame.let_specials.push_back(a.slot);
        e = let.a;
        continue;
      }
      case ExprKind::check:
      case ExprKind::print: {
        const auto& bound = static_cast<const BindExpr&>(*e);
        if (e->kind == ExprKind::check)
          check(bound.arguments, *f, e->at);
        else
          print_arguments(bound.arguments, *f, e->at);
        if (bound.a == nullptr) return nullptr;
        e = bound.a;
        continue;
      }
      case ExprKind::call: return static_cast<const CallExpr*>(e);
      default: result = eval(*e, *f); return nullptr;
    }
  }
}

// ------------------------------------------------------------------------------------------ arguments

void Interpreter::set_parameter(const Parameter& p, Value v, Value* slots) {
  if (p.special)
    bind_special(p.slot, std::move(v));
  else
    slots[p.slot] = std::move(v);
}

/// A default is evaluated where the function is defined.
Value Interpreter::standard_value(const Parameter& p, Frame* around) {
  if (p.undeclared) return Value::unset();
  if (p.standard == nullptr) return {};
  if (p.standard->kind == ExprKind::constant) return static_cast<const Constant&>(*p.standard).value;
  if (p.captured) {
    const FrameRef held(new_heap_frame(around, p.standard_slots));
    return eval(*p.standard, *held.get());
  }
  const StackMark mark(stack_);
  reserve(p.standard_slots, p.at);
  Frame frame{around, stack_.grow(p.standard_slots), p.standard_slots, false};
  return eval(*p.standard, frame);
}

namespace {

bool is_given(const std::vector<Taken>& taken, std::size_t parameter) {
  return std::any_of(taken.begin(), taken.end(),
                     [&](const Taken& t) { return t.parameter == static_cast<std::int32_t>(parameter); });
}

/// The arguments of a call of a literal that have no parameter.
void report_unused(Interpreter& run, const CallExpr& e, const std::vector<Parameter>& parameters) {
  std::size_t position = 0;
  for (const Argument& a : e.arguments) {
    const auto same = [&](const Parameter& p) { return p.name == a.name; };
    if (a.name.empty() && position++ >= parameters.size())
      run.warn(codes::scad_call, a.at,
               fmt::format("the function takes {} arguments at most", parameters.size()));
    else if (!a.name.empty() && !a.special && std::none_of(parameters.begin(), parameters.end(), same))
      run.warn(codes::scad_call, a.at, fmt::format("the function has no parameter {}", a.name));
  }
}

}  // namespace

/// As OpenSCAD does, before the arguments; those that an argument replaces only if that can be seen.
void Interpreter::set_standard_values(const std::vector<Parameter>& parameters,
                                      const std::vector<Taken>& taken, Frame* around, Value* slots) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    if (is_given(taken, i) && (p.undeclared || (!p.special && !p.visible))) continue;
    set_parameter(p, standard_value(p, around), slots);
  }
}

/// In OpenSCAD's order: default values, then the arguments; special variables among them hold at once.
void Interpreter::take(const CallExpr& e, const Target& target, Frame& caller, Value* slots) {
  const std::vector<Parameter>& parameters = target.function->parameters;
  if (target.mapped && !e.ordered) {  // nothing shows the order
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const std::int32_t a = e.map[i];
      Value v = a >= 0 ? eval(*e.arguments[static_cast<std::size_t>(a)].value, caller)
                       : standard_value(parameters[i], target.frame);
      set_parameter(parameters[i], std::move(v), slots);
    }
    return;
  }
  std::vector<Taken> of_literal;
  if (!target.mapped) {
    of_literal = taken_of(parameters, e.arguments);
    report_unused(*this, e, parameters);
  }
  const std::vector<Taken>& taken = target.mapped ? e.taken : of_literal;
  set_standard_values(parameters, taken, target.frame, slots);
  for (const Taken& t : taken) {
    const Argument& a = e.arguments[t.argument];
    Value v = eval(*a.value, caller);
    if (t.parameter >= 0)
      set_parameter(parameters[static_cast<std::size_t>(t.parameter)], std::move(v), slots);
    else if (a.special)
      bind_special(a.slot, std::move(v));
  }
}

/// For a function that calls itself in tail position OpenSCAD 2021.01 evaluates all arguments before it sets
/// any, and default values once in a run. Special variables of let() before the call hide those of the call.
void Interpreter::take_again(const CallExpr& e, const Target& target, Frame& caller, CallFrame& frame,
                             Value* slots) {
  const auto& hidden = frame.let_specials;
  const auto is_hidden = [&](std::uint32_t slot) {
    return std::find(hidden.begin(), hidden.end(), slot) != hidden.end();
  };
  const auto set = [&](const Parameter& p, Value v) {
    if (!p.special || !is_hidden(p.slot)) set_parameter(p, std::move(v), slots);
  };
  const std::vector<Parameter>& parameters = target.function->parameters;
  const std::vector<Taken> taken = target.mapped ? e.taken : taken_of(parameters, e.arguments);
  std::vector<Value> values;
  values.reserve(taken.size());
  for (const Taken& t : taken) values.push_back(eval(*e.arguments[t.argument].value, caller));
  std::vector<Value>* standard = nullptr;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    if (is_given(taken, i)) continue;
    if (p.standard == nullptr || p.standard->kind == ExprKind::constant) {
      set(p, standard_value(p, target.frame));
      continue;
    }
    if (standard == nullptr) standard = &standard_values_[&e];
    if (standard->empty()) standard->assign(parameters.size(), Value::unset());
    if ((*standard)[i].is(Type::unset)) (*standard)[i] = standard_value(p, target.frame);
    set(p, (*standard)[i]);
  }
  for (std::size_t k = 0; k < taken.size(); ++k) {
    const Argument& a = e.arguments[taken[k].argument];
    if (taken[k].parameter >= 0)
      set(parameters[static_cast<std::size_t>(taken[k].parameter)], std::move(values[k]));
    else if (a.special && !is_hidden(a.slot))
      bind_special(a.slot, std::move(values[k]));
  }
}

void Interpreter::take_values(std::span<const Value> values, const Target& target, Value* slots) {
  const std::vector<Parameter>& parameters = target.function->parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    set_parameter(parameters[i], i < values.size() ? values[i] : standard_value(parameters[i], target.frame),
                  slots);
}

// ------------------------------------------------------------------------- built-in functions, commands

Value Interpreter::call_builtin(const CallExpr& e, Frame& f) {
  const BuiltinFunction& builtin = builtin_functions()[static_cast<std::size_t>(e.builtin)];
  const std::size_t mark = special_mark();
  const StackMark stack_mark(stack_);
  const std::size_t given = e.arguments.size();
  const std::size_t count = given < builtin.least || given > builtin.max ? 0 : given;
  reserve(count, e.at);
  Value* values = stack_.grow(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Expr& a = *e.arguments[i].value;
    // is_undef(x) asks whether there is a variable.
    if (e.name == "is_undef" && (a.kind == ExprKind::variable || a.kind == ExprKind::special)) {
      values[i] = a.kind == ExprKind::special ? special(static_cast<const Special&>(a).name)
                                              : quiet_variable(static_cast<const Variable&>(a), f);
      continue;
    }
    values[i] = eval(a, f);
    if (e.arguments[i].special) bind_special(e.arguments[i].slot, values[i]);
    if (builtin.evaluated == BuiltinArguments::all || given == 1 || values[i].is_number()) continue;
    if (builtin.evaluated == BuiltinArguments::key_first && i == 0) eval(a, f);
    break;
  }
  BuiltinCall call{*this, e.name, {values, count}, e.at, e.arguments};
  const bool is_number = builtin.of_number != nullptr && count == 1 && values[0].is_number();
  Value v = is_number ? Value(builtin.of_number(values[0].number())) : builtin.run(call);
  unwind(mark);
  return v;
}

Value Interpreter::call_method(const CallExpr& e, Frame& f) {
  const auto& member = static_cast<const Member&>(*e.a);
  const Value object = eval(*member.a, f);
  if (!object.is(Type::object)) {
    if (const Value v = member_value(object, e.name); v.is(Type::function)) {
      std::vector<Value> arguments;
      for (const Argument& a : e.arguments) arguments.push_back(eval(*a.value, f));
      return call_value(v, arguments, e.at);
    }
    error(codes::scad_unknown, e.at,
          fmt::format("{}() is called on {} value; expected an object, as of gcodepreview()", e.name,
                      object.is_undef() ? "an undefined" : fmt::format("a {}", name_of(object.type()))));
    return {};
  }
  if (e.command < 0) {
    error(codes::scad_unknown, e.at, fmt::format("unknown command {}()", e.name)).hint =
        unknown_name_hint(e.name);
    return {};
  }
  return call_command(e.command, e.arguments, f, e.at, static_cast<const Object*>(object.block()), nullptr,
                      {&f, activation_}, nullptr);
}

std::string Interpreter::unknown_name_hint(const std::string& name) const {
  std::vector<std::string> known;
  for (const BuiltinFunction& b : builtin_functions()) known.emplace_back(b.name);
  for (const BuiltinModule& b : builtin_modules()) known.emplace_back(b.name);
  if (commands_.commands != nullptr)
    for (const Command& c : *commands_.commands) known.emplace_back(c.name);
  for (const auto& unit : program_.units) {
    for (const auto& [defined, f] : unit->block->functions) known.push_back(defined);
    for (const auto& [defined, m] : unit->block->modules) known.push_back(defined);
  }
  std::sort(known.begin(), known.end());
  const auto meant = did_you_mean(name, known);
  return meant ? fmt::format("did you mean {}()?", *meant) : std::string();
}

namespace {

/// The argument of each parameter of a command, evaluated; nothing after an error.
struct CommandArguments {
  std::vector<Value> values;
  bool failed = false;
};

}  // namespace

namespace {

std::string parameter_names(const Command& command) {
  std::string names;
  for (const CommandParameter& p : command.parameters) {
    if (!names.empty()) names += ", ";
    names += p.name;
  }
  return names.empty() ? "none" : names;
}
std::string parameters_hint(const Command& command) {
  return command.forms.empty() ? "parameters: " + parameter_names(command) : "the forms are " + command.forms;
}

/// The parameter of the first positional argument.
std::size_t first_position(const Command& command, const std::vector<Argument>& arguments,
                           const std::vector<Value>& values) {
  if (command.first_parameter == nullptr) return 0;
  std::size_t numbers = 0;
  bool only_numbers = true;
  std::vector<std::string_view> names;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k].special) continue;
    if (!arguments[k].name.empty()) {
      names.emplace_back(arguments[k].name);
      continue;
    }
    only_numbers = only_numbers && values[k].is_number();
    if (only_numbers) ++numbers;
  }
  return command.first_parameter(command, numbers, names);
}

}  // namespace

Value Interpreter::call_command(int number, const std::vector<Argument>& arguments, Frame& f, Position at,
                                const Object* object, const Body* children, const Context& context,
                                Shapes* out) {
  const Command& command = (*commands_.commands)[static_cast<std::size_t>(number)];
  tick(at);
  const std::size_t mark = special_mark();
  CommandArguments given;
  given.values.assign(command.parameters.size(), Value::unset());
  std::vector<Value> evaluated;
  evaluated.reserve(arguments.size());
  for (const Argument& a : arguments) {
    evaluated.push_back(eval(*a.value, f));
    if (a.special) bind_special(a.slot, std::move(evaluated.back()));
  }
  std::size_t position = first_position(command, arguments, evaluated);
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const Argument& a = arguments[k];
    if (a.special) continue;
    Value& v = evaluated[k];
    std::size_t i = position;
    if (a.name.empty()) {
      ++position;
    } else {
      const auto& all = command.parameters;
      const auto p = std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.name == a.name; });
      i = static_cast<std::size_t>(p - all.begin());
    }
    if (i < command.parameters.size()) {
      given.values[i] = std::move(v);
    } else if (a.name.empty() && command.further == FurtherArguments::taken) {
      given.values.push_back(std::move(v));
    } else {
      given.failed = true;
      error(codes::scad_argument, a.at,
            a.name.empty() ? fmt::format("{}() takes {} argument{} at most", command.name,
                                         command.parameters.size(), command.parameters.size() == 1 ? "" : "s")
                           : fmt::format("{}() has no parameter {}", command.name, a.name))
          .hint = parameters_hint(command);
    }
  }
  for (std::size_t i = 0; i < command.parameters.size(); ++i) {
    if (!command.parameters[i].required || !given.values[i].is(Type::unset)) continue;
    given.failed = true;
    error(codes::scad_argument, at,
          fmt::format("{}(): {} is missing", command.name, command.parameters[i].name))
        .hint = parameters_hint(command);
  }
  Value result;
  if (!given.failed) {
    Site site(*this, at, children, context);
    Call call(command, commands_.state, site, diagnostics_, std::move(given.values), object);
    result = command.run(call);
    if (out != nullptr && call.shape().kind != Shape::Kind::nothing) out->push_back(std::move(call.shape()));
    if (children != nullptr && !children->statements.empty() && !site.ran_children())
      diagnostics_
          .warning(codes::scad_children, locate(children->statements.front()->at),
                   fmt::format("this statement is a child of {}() and does not run", command.name))
          .hint = "is a semicolon missing before it?";
  }
  unwind(mark);
  return result;
}

}  // namespace kerf::scad
