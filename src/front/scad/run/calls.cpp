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
      target.literal = std::move(v);
      return true;
    }
  }
  if (e.function == nullptr) return false;
  target.function = e.function;
  target.mapped = true;
  target.literal = {};
  if (e.function_hops == kOfUnit) {
    target.frame = &unit_frame(*e.function->unit);
    return true;
  }
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
  enter_unit(target.function->unit);
  CallFrame frame;
  enter(frame, target, e, f);
  return run_body(target, frame, mark.base);
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
  if (target.function->captured) {
    frame.heap = FrameRef(new_heap_frame(target.frame, target.function->slots));
    frame.frame = frame.heap.get();
  } else {
    reserve(target.function->slots, at);
    frame.stack = {target.frame, stack_.grow(target.function->slots), target.function->slots, false};
    frame.frame = &frame.stack;
  }
  take_values(arguments, target, frame.frame->slots);
  return run_body(target, frame, mark.base);
}

/// Makes the frame of the called function and evaluates the arguments into it.
void Interpreter::enter(CallFrame& into, const Target& target, const CallExpr& e, Frame& caller) {
  const std::uint32_t slots = target.function->slots;
  if (target.function->captured) {
    into.heap = FrameRef(new_heap_frame(target.frame, slots));
    into.frame = into.heap.get();
  } else {
    reserve(slots, e.at);
    into.stack = {target.frame, stack_.grow(slots), slots, false};
    into.frame = &into.stack;
  }
  if (target.mapped)
    take_mapped(e, target, caller, into.frame->slots);
  else
    take_by_name(e, target, caller, into.frame->slots);
}

/// The same for a call in tail position: the new variables replace those of the caller.
void Interpreter::enter_again(CallFrame& into, const Target& target, const CallExpr& e, Value* base) {
  CallFrame next;
  Value* fresh = stack_.top();
  enter(next, target, e, *into.frame);
  if (target.function->captured) {
    into.heap = std::move(next.heap);
    into.frame = into.heap.get();
    stack_.shrink(base);
    return;
  }
  const std::uint32_t slots = target.function->slots;
  if (fresh != base)
    for (std::uint32_t i = 0; i < slots; ++i) base[i] = std::move(fresh[i]);
  stack_.shrink(base + slots);
  into.heap = FrameRef();
  into.stack = {target.frame, base, slots, false};
  into.frame = &into.stack;
}

Value Interpreter::run_body(Target& target, CallFrame& frame, Value* base) {
  for (std::uint32_t turn = 0;; ++turn) {
    if (turn == limits::kMaxScadTurns)
      fail(codes::scad_limit, target.function->at, "recursion detected: too many calls in tail position");
    Value result;
    FrameRef held;
    Frame* inner = frame.frame;
    const CallExpr* tail = tail_call(target.function->body, inner, held, result);
    if (tail == nullptr) return result;
    tick(tail->at);
    Target next;
    if (!find_target(*tail, *inner, next)) return call(*tail, *inner);
    if (inner != frame.frame || next.function->unit != target.function->unit) return call(*tail, *inner);
    enter_again(frame, next, *tail, base);
    target = std::move(next);
  }
}

/// Follows an expression to the call that gives its value; null, with the value, if there is none.
const CallExpr* Interpreter::tail_call(const Expr* e, Frame*& f, FrameRef& held, Value& result) {
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
        e = let.a;
        continue;
      }
      case ExprKind::check:
      case ExprKind::print: {
        const auto& bound = static_cast<const BindExpr&>(*e);
        if (e->kind == ExprKind::check)
          check(bound.arguments, *f, e->at);
        else
          print_arguments(bound.arguments, *f);
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

void Interpreter::take_mapped(const CallExpr& e, const Target& target, Frame& caller, Value* slots) {
  const std::vector<Parameter>& parameters = target.function->parameters;
  if (e.binds_specials) {
    std::vector<Value> values = evaluate(e.arguments, caller);
    for (std::size_t i = 0; i < parameters.size(); ++i)
      set_parameter(parameters[i],
                    e.map[i] >= 0 ? std::move(values[static_cast<std::size_t>(e.map[i])])
                                  : standard_value(parameters[i], target.frame),
                    slots);
    return;
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::int32_t a = e.map[i];
    Value v = a >= 0 ? eval(*e.arguments[static_cast<std::size_t>(a)].value, caller)
                     : standard_value(parameters[i], target.frame);
    set_parameter(parameters[i], std::move(v), slots);
  }
}

/// As in OpenSCAD, the special variables among the arguments of a call hold for the arguments before them.
std::vector<Value> Interpreter::evaluate(const std::vector<Argument>& arguments, Frame& f) {
  std::vector<Value> values(arguments.size());
  const bool has_special =
      std::any_of(arguments.begin(), arguments.end(), [](const Argument& a) { return a.special; });
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::size_t i = has_special ? arguments.size() - 1 - k : k;
    values[i] = eval(*arguments[i].value, f);
    if (arguments[i].special) bind_special(arguments[i].slot, values[i]);
  }
  return values;
}

void Interpreter::take_by_name(const CallExpr& e, const Target& target, Frame& caller, Value* slots) {
  const std::vector<Parameter>& parameters = target.function->parameters;
  constexpr std::size_t kFew = 64;
  std::uint64_t given = 0;
  std::size_t position = 0;
  std::vector<Value> values = evaluate(e.arguments, caller);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Argument& a = e.arguments[k];
    std::size_t i = position;
    if (a.name.empty()) {
      ++position;
    } else {
      i = static_cast<std::size_t>(std::find_if(parameters.begin(), parameters.end(),
                                                [&](const Parameter& p) { return p.name == a.name; }) -
                                   parameters.begin());
    }
    if (i >= parameters.size() || i >= kFew) {
      if (!a.special)
        warn(codes::scad_call, a.at,
             a.name.empty() ? fmt::format("the function takes {} arguments at most", parameters.size())
                            : fmt::format("the function has no parameter {}", a.name));
      continue;
    }
    given |= std::uint64_t{1} << i;
    set_parameter(parameters[i], std::move(values[k]), slots);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (i >= kFew || (given >> i & 1u) == 0)
      set_parameter(parameters[i], standard_value(parameters[i], target.frame), slots);
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
  reserve(e.arguments.size(), e.at);
  Value* values = stack_.grow(e.arguments.size());
  for (std::size_t i = 0; i < e.arguments.size(); ++i) {
    const Expr& a = *e.arguments[i].value;
    // is_undef(x) asks whether there is a variable.
    if (e.name == "is_undef" && (a.kind == ExprKind::variable || a.kind == ExprKind::special)) {
      values[i] = a.kind == ExprKind::special ? special(static_cast<const Special&>(a).name)
                                              : quiet_variable(static_cast<const Variable&>(a), f);
      continue;
    }
    values[i] = eval(a, f);
    if (e.arguments[i].special) bind_special(e.arguments[i].slot, values[i]);
  }
  BuiltinCall call{*this, e.name, {values, e.arguments.size()}, e.at, e.arguments};
  const bool is_number = builtin.of_number != nullptr && e.arguments.size() == 1 && values[0].is_number();
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
