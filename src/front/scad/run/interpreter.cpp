// The interpreter's state and its expressions.
#include "front/scad/run/interpreter.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/scad.h"
#include "base/file_names.h"
#include "base/names.h"
#include "front/scad/text/resolve.h"

namespace kerf::scad {
namespace {

constexpr std::size_t kStackValues = std::size_t{1} << 20;  // 16 MB, of which used pages count

}  // namespace

void FrameRef::count_down() {
  auto* heap = static_cast<HeapFrame*>(frame_);
  if (--heap->references > 0) return;
  heap->before->after = heap->after;
  if (heap->after != nullptr) heap->after->before = heap->before;
  delete heap;
}

Interpreter::Interpreter(const Program& program, const RunLimits& limits, CommandSet commands, PrintTo output,
                         Diagnostics& diagnostics, Progress* progress)
    : program_(program),
      limits_(limits),
      commands_(commands),
      output_(output),
      diagnostics_(diagnostics),
      progress_(progress),
      stack_(kStackValues),
      heap_frames_(meter_),
      root_values_{Value(std::numbers::pi)},
      unit_values_(program.units.size()),
      unit_frames_(program.units.size()),
      unit_ready_(program.units.size(), 0),
      specials_(program.specials.size(), Value::unset()),
      files_{program.sources, program.fonts, commands.imports} {
  root_.slots = root_values_.data();
  root_.count = 1;
  const Value zero = Value::vector({0.0, 0.0, 0.0});
  const std::pair<const char*, Value> standard[]{
      {"$fn", 0.0},   {"$fa", 12.0},  {"$fs", 2.0},    {"$t", 0.0},   {"$preview", Value::truth(true)},
      {"$vpr", zero}, {"$vpt", zero}, {"$vpd", 500.0}, {"$vpf", 22.5}};
  for (const auto& [name, value] : standard)
    if (const auto it = program.special_numbers.find(name); it != program.special_numbers.end())
      specials_[it->second] = value;
}

Interpreter::~Interpreter() {
  // Rings of literals and frames: the frames give up what they refer to before any of them is deleted.
  undo_.clear();
  standard_values_.clear();
  for (HeapFrame* f = heap_frames_.after; f != nullptr; f = f->after) ++f->references;
  for (HeapFrame* f = heap_frames_.after; f != nullptr; f = f->after) {
    f->values.assign(f->values.size(), {});
    f->outer = FrameRef();
  }
  specials_.clear();
  unit_values_.clear();
  while (heap_frames_.after != nullptr) {
    HeapFrame* next = heap_frames_.after->after;
    delete heap_frames_.after;
    heap_frames_.after = next;
  }
}

// ------------------------------------------------------------------------------------------- messages

std::vector<DiagnosticNote> Interpreter::callers() const {
  constexpr std::size_t kShown = 8;
  std::vector<DiagnosticNote> notes;
  for (const Trace* t = trace_; t->outer != nullptr && notes.size() < kShown; t = t->outer)
    notes.push_back({locate(t->at), fmt::format("in {}(), called here", *t->name)});
  return notes;
}

Diagnostic& Interpreter::warn(Code code, Position at, std::string message) {
  Diagnostic& d = diagnostics_.warning(code, locate(at), std::move(message));
  d.notes = callers();
  return d;
}
Diagnostic& Interpreter::error(Code code, Position at, std::string message) {
  Diagnostic& d = diagnostics_.error(code, locate(at), std::move(message));
  d.notes = callers();
  return d;
}
void Interpreter::fail(Code code, Position at, std::string message, std::string hint) {
  error(code, at, std::move(message)).hint = std::move(hint);
  throw Stop{};
}

std::string ImportedFiles::path_beside(const std::string& name, Position at) const {
  const std::string& from = sources[at.source].name;
  return name.starts_with('\\') ? name : kerf::path_beside(from, name);
}

Value Interpreter::top_variable(std::string_view name) {
  const Unit& unit = *program_.units.front();
  const auto found = unit.block->names.find(std::string(name));
  if (found == unit.block->names.end() || unit.block->assignments[found->second].special) return {};
  const Value v = unit_frame(unit).slots[unit.block->assignments[found->second].slot];
  return v.is(Type::unset) ? Value() : v;
}

OriginId Interpreter::origin(Position at, OriginTable& origins) const {
  const auto add = [&](Position p) {
    return origins.text(origins.file(program_.sources[p.source].name), p.line, p.column);
  };
  // From the outermost call inwards, each once.
  std::vector<const Trace*> chain;
  for (const Trace* t = trace_; t->outer != nullptr && t->origin == OriginId::none; t = t->outer)
    chain.push_back(t);
  for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
    (*it)->origin = add((*it)->at);
    if ((*it)->outer->origin != OriginId::none) origins.set_caller((*it)->origin, (*it)->outer->origin);
  }
  const std::uint64_t key = std::uint64_t{at.source} << 52 ^ std::uint64_t{at.line} << 20 ^ at.column;
  OriginId& known = trace_->origins[key];
  if (known != OriginId::none) return known;
  known = add(at);
  if (trace_->origin != OriginId::none) origins.set_caller(known, trace_->origin);
  return known;
}

void Interpreter::print(std::string_view line, Position at) {
  printed_ += line.size() + 1;
  if (printed_ > limits_.max_output)
    fail(codes::scad_limit, trace_->at,
         fmt::format("the program prints more than {} bytes", limits_.max_output));
  output_.text += line;
  output_.text += '\n';
  if (output_.line) output_.line(locate(at), line);
}

// --------------------------------------------------------------------------------------------- limits

void Interpreter::check_limits(Position at) {
  if (stop_requested(progress_)) {
    stopped_ = true;
    throw Stop{};
  }
  if (steps_ > limits_.max_steps)
    fail(codes::scad_limit, at,
         fmt::format("the program makes more than {} calls and passes of loops", limits_.max_steps));
  if (meter_.bytes > limits_.max_memory)
    fail(codes::scad_limit, at,
         fmt::format("the values of the program take more than {} MB", limits_.max_memory >> 20));
}

void Interpreter::too_many_items(Position at) {
  fail(codes::scad_limit, at, fmt::format("a vector of more than {} values", limits_.max_items));
}

Value Interpreter::string(std::string text, Position at) {
  if (text.size() > limits_.max_string)
    fail(codes::scad_limit, at, fmt::format("a string of more than {} bytes", limits_.max_string));
  Value v = Value::string(std::move(text), &meter_);
  if (meter_.bytes > limits_.max_memory) check_limits(at);
  return v;
}

Value Interpreter::vector(Value* first, std::size_t count, Position at) {
  return checked(Value::vector(first, count, &meter_), at);
}

Value Interpreter::checked(Value v, Position at) {
  if (v.nesting() > limits_.max_nesting)
    fail(codes::scad_limit, at, fmt::format("vectors are nested more than {} times", limits_.max_nesting));
  if (meter_.bytes > limits_.max_memory) check_limits(at);
  return v;
}

// ------------------------------------------------------------------------------------------ variables

Value Interpreter::special(std::string_view name) const {
  const auto it = program_.special_numbers.find(std::string(name));
  if (it != program_.special_numbers.end()) {
    const Value& v = specials_[it->second];
    return v.is(Type::unset) ? Value() : v;
  }
  if (name == "$fa") return 12.0;
  if (name == "$fs") return 2.0;
  return name == "$fn" ? Value(0.0) : Value();
}
double Interpreter::special_number(std::string_view name) const {
  const Value v = special(name);
  return v.is_number() && std::isfinite(v.number()) ? v.number() : 0.0;
}

void Interpreter::bind_special(std::uint32_t number, Value value) {
  undo_.emplace_back(number, std::move(specials_[number]));
  specials_[number] = std::move(value);
}
void Interpreter::unwind(std::size_t mark) {
  while (undo_.size() > mark) {
    specials_[undo_.back().first] = std::move(undo_.back().second);
    undo_.pop_back();
  }
}

Value Interpreter::variable(const Variable& v, Frame& f) {
  Value x = quiet_variable(v, f);
  return x.is(Type::unset) ? unknown_variable(v) : x;
}

Value Interpreter::quiet_variable(const Variable& v, Frame& f) {
  if (!v.found) return Value::unset();
  const auto at = [&](SlotPath path) -> const Value& {
    const Frame* frame = &f;
    for (std::uint32_t i = 0; i < path.hops; ++i) frame = frame->parent;
    return frame->slots[path.slot];
  };
  if (const Value& x = at({v.hops, v.slot}); !x.is(Type::unset)) return x;
  for (const SlotPath& path : v.others)
    if (const Value& x = at(path); !x.is(Type::unset)) return x;
  return Value::unset();
}

Value Interpreter::unknown_variable(const Variable& v) {
  Diagnostic& d =
      warn(codes::scad_unknown, v.at, fmt::format("unknown variable {}; its value is undef", v.name));
  if (v.found) d.hint = "it is assigned further down: assignments run in order";
  return {};
}

Value Interpreter::eval_special(const Special& s) {
  const Value& v = specials_[s.slot];
  if (!v.is(Type::unset)) return v;
  warn(codes::scad_unknown, s.at, fmt::format("unknown variable {}; its value is undef", s.name));
  return {};
}

// ---------------------------------------------------------------------------------------- expressions

namespace {

/// The value of a variable or constant where it is stored; null for other expressions and unknown variables.
const Value* stored(const Expr& e, const Frame& f) {
  switch (e.kind) {
    case ExprKind::constant: return &static_cast<const Constant&>(e).value;
    case ExprKind::local: return &f.slots[e.slot];
    case ExprKind::variable: {
      if (!static_cast<const Variable&>(e).found) return nullptr;
      const Frame* frame = &f;
      for (std::uint32_t i = 0; i < e.hops; ++i) frame = frame->parent;
      const Value* v = &frame->slots[e.slot];
      return v->is(Type::unset) ? nullptr : v;
    }
    default: return nullptr;
  }
}

}  // namespace

/// True for a number, which is in `x` then; other values are in `other`.
bool Interpreter::eval_number(const Expr& e, Frame& f, double& x, Value& other) {
  const auto took = [&](const Value& v) {
    if (!v.is_number()) {
      other = v;
      return false;
    }
    x = v.number();
    return true;
  };
  switch (e.kind) {
    case ExprKind::constant:
    case ExprKind::local:
    case ExprKind::variable:
      if (const Value* v = stored(e, f)) return took(*v);
      break;
    case ExprKind::negative: {
      if (number(*e.a, f, x, other)) {
        x = -x;
        return true;
      }
      other = negative(*this, other, e.at);
      return false;
    }
    case ExprKind::multiply:
    case ExprKind::divide:
    case ExprKind::modulo:
    case ExprKind::power:
    case ExprKind::add:
    case ExprKind::subtract: return arithmetic(e, f, x, other);
    case ExprKind::choice: return number(condition(*e.a, f) ? *e.b : *e.c, f, x, other);
    case ExprKind::call: {
      const auto& call_expr = static_cast<const CallExpr&>(e);
      if (call_expr.of_number == nullptr) break;
      if (number(*call_expr.arguments[0].value, f, x, other)) {
        x = call_expr.of_number(x);
        return true;
      }
      BuiltinCall wrong{*this, call_expr.name, {&other, 1}, e.at, call_expr.arguments};
      other = builtin_functions()[static_cast<std::size_t>(call_expr.builtin)].run(wrong);
      return false;
    }
    case ExprKind::index:
      if (const Value* list = stored(*e.a, f); list != nullptr && list->is(Type::vector)) {
        const Value held = *list;  // the index may be a call
        double i = 0.0;
        if (!number(*e.b, f, i, other)) {
          other = {};
          return false;
        }
        if (i >= 0.0 && i < static_cast<double>(held.items().size()))
          return took(held.items()[static_cast<std::size_t>(i)]);
        other = {};
        return false;
      }
      break;
    default: break;
  }
  Value v = eval_other(e, f);
  if (v.is_number()) {
    x = v.number();
    return true;
  }
  other = std::move(v);
  return false;
}

/// The right operand is evaluated before the left one, as in OpenSCAD: echo() shows it.
bool Interpreter::arithmetic(const Expr& e, Frame& f, double& x, Value& other) {
  double y = 0.0;
  if (!number(*e.b, f, y, other)) {
    const Value right = std::move(other);
    other = {};
    return operate_number(e, eval(*e.a, f), right, x, other);
  }
  if (!number(*e.a, f, x, other)) {
    const Value left = std::move(other);
    return operate_number(e, left, y, x, other);
  }
  switch (e.kind) {
    case ExprKind::add: x += y; break;
    case ExprKind::subtract: x -= y; break;
    case ExprKind::multiply: x *= y; break;
    case ExprKind::divide: x /= y; break;
    case ExprKind::modulo: x = remainder_of(x, y); break;
    default: x = std::pow(x, y); break;
  }
  return true;
}

/// For operands that are not both numbers.
bool Interpreter::operate_number(const Expr& e, const Value& left, const Value& right, double& x,
                                 Value& other) {
  other = operate(*this, e.kind, left, right, e.at);
  if (!other.is_number()) return false;
  x = other.number();
  return true;
}

/// For comparisons: whether it holds. Values that have no order are reported, and it does not hold.
bool Interpreter::comparison(const Expr& e, Frame& f) {
  double x = 0.0, y = 0.0;
  Value other;
  if (!number(*e.b, f, y, other)) {
    const Value left = eval(*e.a, f);
    return operate(*this, e.kind, left, other, e.at).is_true();
  }
  if (!number(*e.a, f, x, other)) return operate(*this, e.kind, other, y, e.at).is_true();
  switch (e.kind) {
    case ExprKind::less: return x < y;
    case ExprKind::less_equal: return x <= y;
    case ExprKind::greater: return x > y;
    case ExprKind::greater_equal: return x >= y;
    case ExprKind::equal: return x == y;
    default: return x != y;
  }
}

bool Interpreter::condition(const Expr& e, Frame& f) {
  switch (e.kind) {
    case ExprKind::negation: return !condition(*e.a, f);
    case ExprKind::both: return condition(*e.a, f) && condition(*e.b, f);
    case ExprKind::either: return condition(*e.a, f) || condition(*e.b, f);
    case ExprKind::less:
    case ExprKind::less_equal:
    case ExprKind::greater:
    case ExprKind::greater_equal:
    case ExprKind::equal:
    case ExprKind::not_equal: return comparison(e, f);
    default: break;
  }
  if (const Value* v = stored(e, f)) return v->is_true();
  return eval(e, f).is_true();
}

Value Interpreter::eval(const Expr& e, Frame& f) {
  switch (e.kind) {
    case ExprKind::constant:
    case ExprKind::local:
    case ExprKind::variable:
      if (const Value* v = stored(e, f)) return *v;
      return eval_other(e, f);
    case ExprKind::negative:
    case ExprKind::multiply:
    case ExprKind::divide:
    case ExprKind::modulo:
    case ExprKind::power:
    case ExprKind::add:
    case ExprKind::subtract:
    case ExprKind::index: break;
    case ExprKind::call:
      if (static_cast<const CallExpr&>(e).of_number != nullptr) break;
      return call(static_cast<const CallExpr&>(e), f);
    default: return eval_other(e, f);
  }
  double x = 0.0;
  Value other;
  if (eval_number(e, f, x, other)) return x;
  return other;
}

Value Interpreter::compare(const Expr& e, Frame& f) {
  double x = 0.0, y = 0.0;
  Value left, right;
  const bool second = eval_number(*e.b, f, y, right);
  const bool first = eval_number(*e.a, f, x, left);
  return operate(*this, e.kind, first ? Value(x) : left, second ? Value(y) : right, e.at);
}

/// What has no number as its usual value.
Value Interpreter::eval_other(const Expr& e, Frame& f) {
  switch (e.kind) {
    case ExprKind::variable: return variable(static_cast<const Variable&>(e), f);
    case ExprKind::special: return eval_special(static_cast<const Special&>(e));
    case ExprKind::positive: return eval(*e.a, f);
    case ExprKind::negation:
    case ExprKind::both:
    case ExprKind::either: return Value::truth(condition(e, f));
    case ExprKind::less:
    case ExprKind::less_equal:
    case ExprKind::greater:
    case ExprKind::greater_equal:
    case ExprKind::equal:
    case ExprKind::not_equal: return compare(e, f);
    case ExprKind::choice: return eval(condition(*e.a, f) ? *e.b : *e.c, f);
    case ExprKind::index: {
      const Value b = eval(*e.b, f);  // before the vector, as in OpenSCAD
      return index_value(eval(*e.a, f), b);
    }
    case ExprKind::member: {
      const auto& name = static_cast<const Member&>(e).name;
      if (const Value* v = stored(*e.a, f)) return member_value(*v, name);
      return member_value(eval(*e.a, f), name);
    }
    case ExprKind::call: return call(static_cast<const CallExpr&>(e), f);
    case ExprKind::vector: return eval_vector(static_cast<const VectorExpr&>(e), f);
    case ExprKind::range: return eval_range(e, f);
    case ExprKind::let: return eval_let(static_cast<const BindExpr&>(e), f);
    case ExprKind::check:
      check(static_cast<const BindExpr&>(e).arguments, f, e.at);
      return e.a == nullptr ? Value() : eval(*e.a, f);
    case ExprKind::print:
      print_arguments(static_cast<const BindExpr&>(e).arguments, f, e.at);
      return e.a == nullptr ? Value() : eval(*e.a, f);
    case ExprKind::literal:
      return Value::of(Type::function, new Closure(&static_cast<const FunctionLiteral&>(e).function, &f));
    default: break;  // those of vectors, which the parser has in vectors only
  }
  fail(codes::scad_syntax, e.at, "for, each and if are possible in vectors only");
}

namespace {

bool is_literal(const Expr& e) {
  const bool is_sign = e.kind == ExprKind::negative || e.kind == ExprKind::positive;
  return e.kind == ExprKind::constant || (is_sign && is_literal(*e.a));
}

}  // namespace

Value Interpreter::eval_range(const Expr& e, Frame& f) {
  const Value begin = eval(*e.a, f);
  const Value end = eval(*e.c, f);
  const Value step = e.b == nullptr ? Value(1.0) : eval(*e.b, f);
  if (!begin.is_number() || !step.is_number() || !end.is_number()) return {};
  const bool descends = end.number() < begin.number();
  if (e.b == nullptr && descends) {
    warn(codes::scad_operation, e.at,
         fmt::format("deprecated: the range [{0}:{1}] starts above its end; it is read as "
                     "[{1}:{0}]",
                     to_string(begin), to_string(end)))
        .hint = "write the step -1 for a range that descends";
    return Value::range(end.number(), 1.0, begin.number());
  }
  // As OpenSCAD, for ranges of literals alone: a computed range may be empty on purpose.
  if (is_literal(*e.a) && is_literal(*e.c) && (e.b == nullptr || is_literal(*e.b))) {
    if (descends && step.number() > 0.0)
      warn(codes::scad_operation, e.at, "the range starts above its end, but its step is positive");
    else if (begin.number() < end.number() && step.number() < 0.0)
      warn(codes::scad_operation, e.at, "the range starts below its end, but its step is negative");
  }
  return Value::range(begin.number(), step.number(), end.number());
}

void Interpreter::bind(const std::vector<Argument>& list, Frame& f) {
  for (const Argument& a : list) {
    Value v;
    if (double x = 0.0; number(*a.value, f, x, v)) v = x;
    if (a.ignored) continue;
    if (a.special)
      bind_special(a.slot, std::move(v));
    else if (!a.name.empty())
      f.slots[a.slot] = std::move(v);
  }
}

Value Interpreter::eval_let(const BindExpr& e, Frame& f) {
  const std::size_t mark = special_mark();
  FrameRef held;
  Frame* frame = &f;
  if (e.own_frame) {
    held = FrameRef(new_heap_frame(&f, e.slots));
    frame = held.get();
  }
  bind(e.arguments, *frame);
  Value v = eval(*e.a, *frame);
  unwind(mark);
  return v;
}

void Interpreter::check(const std::vector<Argument>& list, Frame& f, Position at) {
  const Argument *condition = nullptr, *message = nullptr;
  for (const Argument& a : list) {
    const bool is_condition = a.name == "condition" || (a.name.empty() && condition == nullptr);
    (is_condition ? condition : message) = &a;
  }
  if (condition == nullptr) fail(codes::scad_call, at, "assert() without a condition");
  if (eval(*condition->value, f).is_true()) return;
  constexpr std::size_t kShown = 200;
  std::string text = text_of(*condition->value);
  if (text.size() > kShown) text = text.substr(0, kShown) + "...";
  std::string what = fmt::format("the assertion {} is false", text);
  if (message != nullptr) what += ": " + as_text(eval(*message->value, f)).substr(0, kShown);
  fail(codes::scad_assert, at, std::move(what));
}

std::string Interpreter::echo_text(const std::vector<Argument>& list, Frame& f) {
  std::string text;
  for (const Argument& a : list) {
    if (!text.empty()) text += ", ";
    if (!a.name.empty()) text += a.name + " = ";
    text += to_string(eval(*a.value, f));
    if (text.size() > limits_.max_string)
      fail(codes::scad_limit, a.at, fmt::format("echo() prints more than {} bytes", limits_.max_string));
  }
  return text;
}

void Interpreter::print_arguments(const std::vector<Argument>& list, Frame& f, Position at) {
  const std::string text = echo_text(list, f);
  print("ECHO: " + text, at);
}

// ---------------------------------------------------------------------------------------------- frames

HeapFrame* Interpreter::new_heap_frame(Frame* parent, std::uint32_t slots) {
  auto* heap = new HeapFrame(meter_);
  heap->on_heap = true;
  heap->parent = parent;
  heap->outer = FrameRef(parent);
  heap->values.assign(slots, Value::unset());
  heap->slots = heap->values.data();
  heap->count = slots;
  heap->before = &heap_frames_;
  heap->after = heap_frames_.after;
  if (heap->after != nullptr) heap->after->before = heap;
  heap_frames_.after = heap;
  meter_.bytes += heap->bytes();
  return heap;
}

}  // namespace kerf::scad
