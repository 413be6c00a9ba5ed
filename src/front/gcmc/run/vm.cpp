// The virtual machine: the loop, and the instructions.
#include "front/gcmc/run/vm.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <new>
#include <utility>

#include "base/codes/files.h"
#include "base/codes/gcmc.h"
#include "base/number.h"
#include "front/gcmc/code/operators.h"
#include "front/gcmc/run/builtins.h"

namespace kerf::gcmc {
namespace {

constexpr std::size_t kSlotsPerCall =
    50;  // on average, of variables and temporaries; touched as they are used
constexpr std::int32_t kStepsPerLook = 20'000;  // loop steps between checks of clock, limits and interrupts
constexpr std::size_t kMaxCallNotes = 16;

Callee callee_of(const FunctionCode& f, const Program& code) {
  Callee callee;
  callee.entry = &code.instructions[f.entry];
  callee.parameters = f.parameters;
  callee.variables = f.variables;
  callee.slots = f.frame;
  callee.cleared = f.iterates ? f.frame : f.variables;
  callee.constants = f.constants;
  return callee;
}

}  // namespace

Vm::Vm(const Tree& tree, const std::deque<Source>& sources, Program& code, const GcmcOptions& options,
       GcmcOutput& output, Diagnostics& diagnostics, Progress* progress)
    : tree_(tree),
      sources_(sources),
      code_(code),
      options_(options),
      output_(output),
      diagnostics_(diagnostics),
      slots_(static_cast<std::size_t>(code.program.frame) + options.max_calls * kSlotsPerCall),
      storage_(new std::byte[slots_ * sizeof(Value)]),
      frames_(new Frame[options.max_calls]),
      top_(frames_.get()),
      frames_end_(top_ + options.max_calls),
      builtins_(all_builtins().data()),
      fuel_(kStepsPerLook) {
  for (const FunctionCode& f : code_.functions) callees_.push_back(callee_of(f, code_));
  stack_ = reinterpret_cast<Value*>(storage_.get());
  stack_end_ = stack_ + slots_;
  reached_ = frame_ = stack_;
  at_ = code_.instructions.data();
  native = options.imperial ? Unit::inch : Unit::mm;
  decimals = options.precision;
  meter.limit = options.max_memory;
  machine_.progress = progress;
  machine_.plane = options.plane;
  machine_.fixed_offset = options.offsets;
  machine_.set_position({});
  reach(stack_ + code_.program.frame);
}

Vm::~Vm() {
  for (Value* v = stack_; v != reached_; ++v) v->~Value();
}

/// Constructs the slots before `end`; false if the stack is too small.
bool Vm::reach(Value* end) {
  if (end > stack_end_) return false;
  for (; reached_ < end; ++reached_) new (reached_) Value();
  return true;
}

void Vm::define_constant(NameId name, Value value) {
  const auto found = code_.global_slots.find(name);
  if (found == code_.global_slots.end()) return;
  Value& v = stack_[found->second];
  v = std::move(value);
  constants_.insert(&v);
}

int Vm::run() {
  try {
    loop();
  } catch (const OutOfMemory&) {
    fail(codes::gcmc_limit,
         fmt::format("The program uses more than {} MB for vectors, lists and strings", meter.limit >> 20));
  } catch (const std::bad_alloc&) {
    fail(codes::gcmc_limit, "Out of memory");
  }
  return status_;
}

// ---- messages

TextLocation Vm::location(std::size_t instruction) const {
  const SourceLocation at = code_.locations[instruction];
  return {sources_[at.file].name, at.line, at.column};
}

void Vm::report(Severity severity, Code code, std::string text, std::string hint, At at) {
  if (severity != Severity::error || code == codes::gcmc_script) {
    reset_quiet_steps();
    count_output(text.size());
  }
  Diagnostic d;
  d.severity = severity;
  d.code = code;
  d.where = location(current_instruction());
  d.message = std::move(text);
  d.hint = std::move(hint);
  for (std::size_t i = depth(); i-- > 0 && d.notes.size() < kMaxCallNotes;) {
    const std::string name = name_text(code_of(*frames_[i].callee).name);
    TextLocation site = location(call_site(i));
    if (at == At::program && std::get<TextLocation>(d.where).file.rfind(kGcmcLibraryPrefix, 0) == 0)
      d.where = std::move(site);
    else
      d.notes.push_back({std::move(site), fmt::format("in the call of {}()", name)});
  }
  output_.message(d);
  if (severity != Severity::note) diagnostics_.add(std::move(d));  // message() is not a diagnostic
}

void Vm::report_warning(Code code, std::string text, std::string hint) {
  ++warnings_;
  report(Severity::warning, code, std::move(text), std::move(hint));
}

TextLocation location_in_program(const Vm& vm) {
  TextLocation where = vm.location(vm.current_instruction());
  for (std::size_t i = vm.depth(); i-- > 0 && where.file.rfind(kGcmcLibraryPrefix, 0) == 0;)
    where = vm.location(vm.call_site(i));
  return where;
}

void Vm::report_error(Code code, std::string text, std::string hint) {
  report(Severity::error, code, std::move(text), std::move(hint));
}

void Vm::program_message(Severity severity, Code code, std::string text, std::string hint, At at) {
  if (severity == Severity::error) ++script_errors_;
  if (severity == Severity::warning) ++warnings_;
  report(severity, code, std::move(text), std::move(hint), at);
}

void Vm::fail_unknown(std::string_view kind, NameId name, const std::vector<std::string>& known) {
  const auto similar = did_you_mean(name_text(name), known);
  const std::string hint = similar ? fmt::format("did you mean '{}'?", *similar) : std::string();
  const char* what = kind == "Function" ? "not found" : "undefined";
  fail(codes::gcmc_unknown_name, fmt::format("{} '{}' {}", kind, name_text(name), what), hint);
}

const FunctionCode& Vm::running() const { return depth() == 0 ? code_.program : code_of(*top_[-1].callee); }

void Vm::fail_absent(std::int32_t slot) {
  const FunctionCode& f = running();
  if (slot < 0 || slot >= f.variables) fail(codes::gcmc_unknown_name, "A value is missing");
  std::vector<std::string> known;
  for (std::int32_t i = 0; i < f.variables; ++i)
    if (!frame_[i].is_absent()) known.push_back(name_text(f.slot_names[static_cast<std::size_t>(i)]));
  fail_unknown("Variable", f.slot_names[static_cast<std::size_t>(slot)], known);
}

const Value* Vm::variable(std::string_view name) const {
  const auto known = tree_.name_index.find(std::string(name));
  if (known == tree_.name_index.end()) return nullptr;
  const FunctionCode& f = running();
  if (depth() > 0) {
    for (std::size_t i = 0; i < f.slot_names.size(); ++i) {
      if (f.slot_names[i] != known->second || frame_[i].is_absent()) continue;
      return frame_[i].type() == Type::reference ? frame_[i].target() : &frame_[i];
    }
  }
  const auto global = code_.global_slots.find(known->second);
  if (global == code_.global_slots.end() || stack_[global->second].is_absent()) return nullptr;
  return &stack_[global->second];
}

void Vm::refuel() {
  fuel_ = kStepsPerLook;
  quiet_steps_ += kStepsPerLook;
  steps_ += kStepsPerLook;
  if (stop_requested(machine_.progress)) {
    stopped_ = true;
    fail(codes::stopped, "Interrupted");
  }
  if (quiet_steps_ > options_.max_quiet_steps)
    fail(codes::gcmc_limit,
         fmt::format("No output or message in {} million loop steps: an endless loop?",
                     options_.max_quiet_steps / 1'000'000),
         "--max-steps raises the limit");
  if (steps_ > options_.max_steps)
    fail(codes::gcmc_limit, fmt::format("The program runs more than {} loop steps", options_.max_steps));
}

void Vm::fail_output() {
  fail(codes::gcmc_limit,
       fmt::format("More than {} MB of output and messages: an endless loop?", options_.max_output >> 20),
       "--max-output raises the limit");
}

// ---- moving values

void Vm::do_move(const Instruction& in) {
  const Value& v = present(in.a);
  if (in.flags & kTakeA)
    frame_[in.x] = std::move(frame_[in.a]);
  else
    frame_[in.x] = v;
}

void Vm::do_get_global(const Instruction& in) {
  const Value& v = stack_[in.a];
  if (v.is_absent()) fail_unknown("Variable", code_.program.slot_names[static_cast<std::size_t>(in.a)], {});
  frame_[in.x] = v;
}

void Vm::do_get_dynamic(const Instruction& in) {
  const Value& own = frame_[in.a];
  const Value& v = own.is_absent() ? stack_[in.b] : own;
  if (v.is_absent()) fail_absent(in.a);
  frame_[in.x] = v;
}

void Vm::do_dereference(const Instruction& in) {
  const Value& v = *frame_[in.a].target();
  if (v.is_absent()) fail_unknown("Variable", frame_[in.a].reference_name(), {});
  frame_[in.x] = v;
}

void Vm::do_refer(const Instruction& in) {
  const NameId name =
      in.a < running().variables ? running().slot_names[static_cast<std::size_t>(in.a)] : kNoName;
  frame_[in.x] = Value::reference(&frame_[in.a], name);
}

void Vm::do_refer_dynamic(const Instruction& in) {
  Value* own = in.a == kNoOperand ? nullptr : &frame_[in.a];
  Value* global = &stack_[in.b];
  Value* target = own != nullptr && (!own->is_absent() || global->is_absent()) ? own : global;
  frame_[in.x] = Value::reference(target, in.c);
}

void Vm::do_need_target(const Instruction& in) {
  const Value& reference = frame_[in.a];
  if (reference.target()->is_absent()) fail_unknown("Variable", reference.reference_name(), {});
}

/// The target of the reference in a slot. If the slot has a name it is a parameter, which errors also name.
Value& Vm::writable_target(std::int32_t reference) {
  Value& target = *frame_[reference].target();
  if (!is_constant(target)) return target;
  const std::string name = name_text(frame_[reference].reference_name());
  if (reference >= running().variables)
    fail(codes::gcmc_constant, fmt::format("Attempt to assign to const variable '{}'", name));
  fail(codes::gcmc_constant,
       fmt::format("Attempt to assign to const variable '{}' (from '{}')",
                   name_text(running().slot_names[static_cast<std::size_t>(reference)]), name));
}

void Vm::do_store(const Instruction& in) {
  const Value& v = present(in.a);
  Value& target = writable_target(in.x);
  if (in.flags & kTakeA)
    target = std::move(frame_[in.a]);
  else
    target = v;
}

// ---- operators

/// x <- a op `b`; `b` must not be the temporary of a.
void Vm::operate_with(const Instruction& in, Op op, const Value& b) {
  const Value& a = present(in.a);
  if (vectors_plain(op, a, b, frame_[in.x])) return;
  Value left;
  if (&a != &b && in.a >= 0 && ((in.flags & kTakeA) || in.a == in.x))
    left = std::move(frame_[in.a]);
  else
    left = a;
  operate(*this, op, left, b);
  frame_[in.x] = std::move(left);
}

void Vm::do_operate(const Instruction& in) {
  present(in.a);
  const Value& b = present(in.b);
  operate_with(in, in.op, b);
  if ((in.flags & kTakeB) && in.b != in.x && b.is_block()) frame_[in.b].clear();
}

/// The vector to be appended to a list.
Value Vm::appended(std::int32_t o, bool take) {
  const Value& v = present(o);
  if (!v.is_vector()) fail(codes::gcmc_type, "Vectorlist entries must be vectors");
  return take ? std::move(frame_[o]) : Value(v);
}

/// x <- a + {b}, without the temporary list.
void Vm::do_append(const Instruction& in) {
  Value item = appended(in.b, (in.flags & kTakeB) != 0);
  const Value& a = present(in.a);
  Value list;
  if (in.a >= 0 && ((in.flags & kTakeA) || in.a == in.x))
    list = std::move(frame_[in.a]);
  else
    list = a;
  append_vector(*this, list, std::move(item));
  frame_[in.x] = std::move(list);
}

void Vm::do_apply(const Instruction& in) {
  Value& target = writable_target(in.x);
  if (target.is_absent()) fail_unknown("Variable", frame_[in.x].reference_name(), {});
  if (static_cast<Op>(in.b) == Op::append)
    return append_vector(*this, target, appended(in.a, (in.flags & kTakeA) != 0));
  const Value& b = present(in.a);
  if (&target == &b) {
    const Value copy = b;
    operate(*this, static_cast<Op>(in.b), target, copy);
  } else {
    operate(*this, static_cast<Op>(in.b), target, b);
  }
  if ((in.flags & kTakeA) && b.is_block()) frame_[in.a].clear();
}

bool Vm::slow_holds(const Instruction& in, Op op) {
  const Value& a = present(in.a);
  const Value& b = present(in.b);
  const bool result = compare(*this, op, a, b);
  if ((in.flags & kTakeA) && a.is_block()) frame_[in.a].clear();
  if ((in.flags & kTakeB) && b.is_block()) frame_[in.b].clear();
  return result;
}

bool Vm::slow_holds_integer(const Instruction& in, Op op) {
  const Value& a = present(in.a);
  const bool result = compare(*this, op, a, Value::integer(in.b));
  if ((in.flags & kTakeA) && a.is_block()) frame_[in.a].clear();
  return result;
}

void Vm::do_compare(const Instruction& in) { frame_[in.x] = Value::boolean(slow_holds(in, in.op)); }

bool Vm::slow_truth(const Instruction& in) {
  const Value& a = present(in.a);
  const bool result = truth(a);
  if ((in.flags & kTakeA) && a.is_block()) frame_[in.a].clear();
  return result;
}

void Vm::do_logic_not(const Instruction& in) { frame_[in.x] = Value::boolean(!slow_truth(in)); }

void Vm::do_bit_not(const Instruction& in) { frame_[in.x] = bit_not(*this, present(in.a)); }

void Vm::step_in(const Instruction& in, Value& v) {
  const bool used = (in.flags & kValueUsed) != 0;
  if (used && !(in.flags & kPrefix)) frame_[in.x] = v;
  step_value(*this, v, (in.flags & kMinus) != 0);
  if (used && (in.flags & kPrefix)) frame_[in.x] = v;
}

void Vm::do_step(const Instruction& in) {
  present(in.a);
  step_in(in, frame_[in.a]);
}

void Vm::do_step_target(const Instruction& in) {
  do_need_target(in);
  step_in(in, writable_target(in.a));
}

// ---- elements

void Vm::do_index(const Instruction& in) {
  const Value& v = present(in.a);
  const Value& i = present(in.b);
  Value result = element(*this, v, i);
  if ((in.flags & kTakeA) && v.is_block()) frame_[in.a].clear();
  frame_[in.x] = std::move(result);
}

void Vm::do_element(const Instruction& in) {
  do_need_target(in);
  Value v;
  bool found = find_element(*this, *frame_[in.a].target(), present(in.b), v);
  if (found && in.c != kNoOperand) {
    const Value vector = std::move(v);
    found = find_element(*this, vector, present(in.c), v);
  }
  if (!found) fail(codes::gcmc_range, "Lvalue expected");
  frame_[in.x] = std::move(v);
}

void Vm::do_set_element(const Instruction& in) {
  const Value& item = present(in.c);
  const Value& first = present(in.a);
  const Value* second = in.b == kNoOperand ? nullptr : &present(in.b);
  Value& target = writable_target(in.x);
  if (target.is_absent()) fail_unknown("Variable", frame_[in.x].reference_name(), {});
  const Value copy = item;  // item may be the target itself
  set_element(*this, target, first, second, copy);
}

void Vm::do_step_element(const Instruction& in) {
  do_need_target(in);
  Value& target = writable_target(in.a);
  const Value& first = present(in.b);
  const Value* second = in.c == kNoOperand ? nullptr : &present(in.c);
  Value v;
  bool found = find_element(*this, target, first, v);
  if (found && second != nullptr) {
    const Value vector = std::move(v);
    found = find_element(*this, vector, *second, v);
  }
  if (!found) v = Value::undef();
  step_in(in, v);
  if (found && v.is_scalar()) set_element(*this, target, first, second, v);
}

// ---- literals

Scalar Vm::entry(std::int32_t o) {
  const Value& v = operand(o, frame_, code_.constants.data());
  if (v.is_scalar() && !v.is_undef()) return v.scalar();
  if (v.type() == Type::reference) return {};  // marks an omitted coordinate
  present(o);
  fail(codes::gcmc_type, "Vector entries must be scalar");
}

void Vm::do_small_vector(const Instruction& in, std::size_t count) {
  const Scalar a = entry(in.a), b = entry(in.b), c = count == 3 ? entry(in.c) : Scalar{};
  Value& v = frame_[in.x];
  v.make_vector(count);
  v.put(0, a);
  v.put(1, b);
  if (count == 3) v.put(2, c);
}

void Vm::do_vector(const Instruction& in) {
  std::vector<Scalar> all(static_cast<std::size_t>(in.b));
  for (std::int32_t i = 0; i < in.b; ++i) {
    const Value& entry = frame_[in.a + i];
    if (entry.type() == Type::reference) continue;
    if (!entry.is_scalar() || entry.is_undef()) fail(codes::gcmc_type, "Vector entries must be scalar");
    all[static_cast<std::size_t>(i)] = entry.scalar();
  }
  frame_[in.x] = Value::vector(all.data(), all.size(), meter);
}

void Vm::do_list(const Instruction& in) {
  std::vector<Value> all;
  all.reserve(static_cast<std::size_t>(in.b));
  for (std::int32_t i = 0; i < in.b; ++i) {
    if (!frame_[in.a + i].is_vector()) fail(codes::gcmc_type, "Vectorlist entries must be vectors");
    all.push_back(std::move(frame_[in.a + i]));
  }
  frame_[in.x] = Value::list(std::move(all), meter);
}

// ---- calls

void Vm::do_call_builtin(const Instruction& in) {
  const Builtin& f = builtins_[in.a];
  static constexpr std::string_view kCounts[] = {"no arguments", "one argument", "two arguments",
                                                 "three arguments"};
  if (in.c < f.min_arguments ||
      (f.max_arguments != kAnyCount && in.c > f.max_arguments && f.max_arguments != 0)) {
    const int wanted = in.c < f.min_arguments ? f.min_arguments : f.max_arguments;
    fail(codes::gcmc_arguments, wanted <= 3 ? fmt::format("{}() requires {}", f.name, kCounts[wanted])
                                            : fmt::format("{}() requires {} arguments", f.name, wanted));
  }
  if (f.max_arguments == 0 && in.c > 0)
    warn(codes::gcmc_arguments, fmt::format("{}() takes no arguments, ignored", f.name));
  const Call call{*this, f.name, frame_ + in.b, in.c, (in.flags & kValueUsed) != 0};
  Value result = f.function(call);
  for (std::int32_t i = 0; i < in.c; ++i)
    if (frame_[in.b + i].is_block()) frame_[in.b + i].clear();
  frame_[in.x] = std::move(result);
}

void Vm::do_define(const Instruction& in) {
  const auto i = static_cast<std::size_t>(in.a);
  if (callees_[i].defined)
    fail(codes::gcmc_defined_twice,
         fmt::format("Function '{}' already defined", name_text(code_.functions[i].name)));
  callees_[i].defined = true;
}

void Vm::fail_undefined_function(std::int32_t index, std::string hint) {
  const NameId name = code_.functions[static_cast<std::size_t>(index)].name;
  fail(codes::gcmc_unknown_name, fmt::format("Function '{}' not found", name_text(name)), std::move(hint));
}

/// Enters a function of the program: its arguments are the first slots of its frame.
inline Vm::Pc Vm::enter(const Instruction& in, Pc pc) {
  const Callee& f = callees_[static_cast<std::size_t>(in.a)];
  if (!f.defined)
    fail_undefined_function(
        in.a, "it is defined further down; a function exists only after its definition has been executed");
  if (--fuel_ <= 0) refuel();
  Value* base = frame_ + in.b;
  Value* end = base + f.slots;
  if (top_ == frames_end_ || (end > reached_ && !reach(end)))
    fail(codes::gcmc_limit, fmt::format("Calls are nested too deeply ({}): an endless recursion?", depth()));
  for (Value* v = base + f.parameters; v < base + f.variables; ++v) v->clear();
  *top_++ = {pc, frame_, &f, in.x, (in.flags & kValueUsed) != 0};
  frame_ = base;
  return f.entry;
}

/// Leaves the running function and releases the blocks of its variables. Scalars stay, because the slots are
/// not read again; temporaries have been moved from.
inline Vm::Pc Vm::leave() {
  const Frame& f = *--top_;
  const Callee& callee = *f.callee;
  if (callee.constants) forget_constants(callee);
  for (Value *v = frame_, *end = frame_ + callee.cleared; v != end; ++v)
    if (v->is_block()) v->clear();
  frame_ = f.base;
  return f.after;
}

/// The value of a return instruction.
Value Vm::result_of(const Instruction& in) {
  const Value& v = present(in.a);
  if (v.type() == Type::reference) return Value(*v.target());
  return in.flags & kTakeA ? std::move(frame_[in.a]) : Value(v);
}

void Vm::do_end_program(const Instruction& in) {
  const Value result = result_of(in);
  status_ = result.is_scalar() ? to_integer(result.scalar()) : 0;
}

/// Leaves the running function with a value.
inline Vm::Pc Vm::return_value(const Instruction& in) {
  const Value& v = operand(in.a, frame_, code_.constants.data());
  Value& to = top_[-1].base[top_[-1].x];
  if (v.is_scalar())
    to.store(v.scalar());
  else
    to = result_of(in);
  return leave();
}

Vm::Pc Vm::return_nothing() {
  const Frame f = top_[-1];
  const Pc after = leave();
  if (f.value_used) {
    at_ = after - 1;
    const NameId name = code_of(*f.callee).name;
    fail(codes::gcmc_control,
         fmt::format("Function call '{}()' did not return a value, but is used in assignment or calculation",
                     name_text(name)));
  }
  return after;
}

/// Removes the constants of a function that ends.
void Vm::forget_constants(const Callee& callee) {
  for (Value* v = frame_; v < frame_ + callee.variables; ++v) constants_.erase(v);
}

void Vm::do_unknown_function(const Instruction& in) {
  std::vector<std::string> known = builtin_names();
  for (const FunctionCode& f : code_.functions) known.push_back(name_text(f.name));
  fail_unknown("Function", in.a, known);
}

void Vm::do_by_reference(const Instruction& in) {
  fail(codes::gcmc_arguments,
       fmt::format("{} argument {}: Cannot pass expression by reference", name_text(in.a), in.b));
}

void Vm::do_wrong_count(const Instruction& in) {
  if (!callees_[static_cast<std::size_t>(in.b)].defined) fail_undefined_function(in.b, {});
  fail(codes::gcmc_arguments, fmt::format("Incorrect number of arguments in call to '{}'", name_text(in.a)));
}

// ---- declarations

void Vm::do_declare_local(const Instruction& in) {
  const Value& value = present(in.a);
  Value& v = frame_[in.x];
  if (!v.is_absent()) {
    warn(codes::gcmc_suspicious, fmt::format("Local scope variable '{}' already available in local scope",
                                             name_text(running().slot_names[in.x])));
    return;
  }
  if (in.flags & kTakeA)
    v = std::move(frame_[in.a]);
  else
    v = value;
}

void Vm::do_declare_constant(const Instruction& in) {
  const Value& value = present(in.a);
  Value& v = frame_[in.x];
  const Value* known = !v.is_absent() ? &v : in.b >= 0 && !stack_[in.b].is_absent() ? &stack_[in.b] : nullptr;
  if (known != nullptr) {
    fail(codes::gcmc_defined_twice,
         fmt::format("Constant '{}' already defined{}", name_text(running().slot_names[in.x]),
                     is_constant(*known) ? "" : " as variable"));
  }
  v = value;
  constants_.insert(&v);
}

void Vm::do_warn_global(const Instruction& in) {
  warn(codes::gcmc_suspicious,
       fmt::format("Locally scoped variable '{}' setting without local scope, adding to global scope",
                   name_text(in.a)));
}

// ---- loops

void Vm::do_repeat_start(const Instruction& in) {
  const Value& n = present(in.a);
  if (!n.is_scalar() || n.is_undef()) fail(codes::gcmc_type, "Repeat's source must be scalar");
  const Scalar s = n.scalar();
  if (s.unit() != Unit::none) warn(codes::gcmc_unit, "Repeat's source has units associated, ignored");
  if (s.kind() == Kind::real && std::fabs(s.p.d - std::nearbyint(s.p.d)) >= kEpsilon) {
    warn(codes::gcmc_type,
         "Repeat's source is floating point and has a non-integer fraction, truncated to integer");
  }
  frame_[in.x] = Value::integer(to_integer(s));
  frame_[in.x + 1] = Value::integer(0);
}

bool Vm::do_repeat_next(const Instruction& in) {
  const std::int32_t limit = frame_[in.x].scalar().whole();
  const std::int32_t last = frame_[in.x + 1].scalar().whole();
  if (last == limit) return false;
  const std::int32_t next = limit > 0 ? last + 1 : last - 1;
  frame_[in.x + 1].store(Scalar::integer(next));
  frame_[in.a].store(Scalar::integer(next));
  return true;
}

void Vm::do_foreach_start(const Instruction& in) {
  const Value& source = present(in.a);
  if (!source.is_vector() && !source.is_list())
    fail(codes::gcmc_type, "Foreach's source must be vector or vectorlist");
  if (in.flags & kTakeA)
    frame_[in.x] = std::move(frame_[in.a]);
  else
    frame_[in.x] = source;
  frame_[in.x + 1] = Value::integer(0);
}

bool Vm::do_foreach_next(const Instruction& in) {
  const Value& source = frame_[in.x];
  const auto i = static_cast<std::size_t>(frame_[in.x + 1].scalar().whole());
  if (source.is_list()) {
    if (i >= source.vectors().size()) return false;
    frame_[in.a] = source.vectors()[i];
  } else {
    if (i >= source.vector_size()) return false;
    frame_[in.a] = Value(source.coordinate(i));
  }
  frame_[in.x + 1].store(Scalar::integer(static_cast<std::int32_t>(i + 1)));
  return true;
}

void Vm::do_clear(const Instruction& in) {
  for (std::int32_t i = in.a; i < in.b; ++i) frame_[i].clear();
}

void Vm::do_stray_break(const Instruction& in) {
  if (in.a == 0) fail(codes::gcmc_control, "Unexpected break or continue");
  fail(codes::gcmc_type, "Lvalue expected",
       "a vector list has two levels only: vectors and their coordinates");
}

// ---- the loop

namespace {

constexpr std::int32_t whole_quotient(std::int32_t a, std::int32_t b) { return a / b; }
constexpr std::int32_t whole_remainder(std::int32_t a, std::int32_t b) { return a % b; }

/// Compares numbers of one unit; false for all others.
inline bool compare_plain(Op op, Scalar a, Scalar b, bool& yes) {
  const Pairing m = pairing(a, b);
  if (!(m & kComparable)) return false;
  yes = (m & kBothIntegers) == kBothIntegers ? holds(op, a.whole(), b.whole())
                                             : holds(op, left_number(a, m) - right_number(b, m));
  return true;
}

/// ++ or -- on a number, if the value is not used.
inline bool quick_step(const Instruction& in, Value& v) {
  if (in.flags & kValueUsed) return false;
  if (v.is_whole()) {
    v.store_whole(wrap_add(v.whole(), in.flags & kMinus ? -1 : 1));
    return true;
  }
  Scalar stepped;
  if (!v.is_scalar() || !step_plain(v.scalar(), (in.flags & kMinus) != 0, stepped)) return false;
  v.store(stepped);
  return true;
}

}  // namespace

// Operations and comparisons of plain scalars are computed here, all others by the members above. Each has a
// second form with an immediate integer as its right operand.
#define KERF_ARITHMETIC(op, plain, of_integers)                            \
  case Op::op: {                                                           \
    const Value& a = operand(in.a, frame, constants);                      \
    const Value& b = operand(in.b, frame, constants);                      \
    Scalar result;                                                         \
    if (Value::are_scalars(a, b) && plain(a.scalar(), b.scalar(), result)) \
      frame[in.x].store(result);                                           \
    else                                                                   \
      do_operate(in);                                                      \
    break;                                                                 \
  }                                                                        \
  case Op::op##_integer: {                                                 \
    const Value& a = frame[in.a];                                          \
    if (a.is_whole())                                                      \
      frame[in.x].store_whole(of_integers(a.whole(), in.b));               \
    else                                                                   \
      operate_with(in, Op::op, Value::integer(in.b));                      \
    break;                                                                 \
  }
#define KERF_COMPARING_JUMP(comparison)                                                                 \
  case Op::jump_##comparison: {                                                                         \
    const Value& a = operand(in.a, frame, constants);                                                   \
    const Value& b = operand(in.b, frame, constants);                                                   \
    bool yes;                                                                                           \
    if (!Value::are_scalars(a, b) || !compare_plain(Op::comparison, a.scalar(), b.scalar(), yes))       \
      yes = slow_holds(in, Op::comparison);                                                             \
    if (yes != ((in.flags & kNegated) != 0)) KERF_JUMP();                                               \
    break;                                                                                              \
  }                                                                                                     \
  case Op::jump_##comparison##_integer: {                                                               \
    const Value& a = frame[in.a];                                                                       \
    const bool yes =                                                                                    \
        a.is_whole() ? holds(Op::comparison, a.whole(), in.b) : slow_holds_integer(in, Op::comparison); \
    if (yes != ((in.flags & kNegated) != 0)) KERF_JUMP();                                               \
    break;                                                                                              \
  }
#define KERF_JUMP()                                       \
  do {                                                    \
    if ((in.flags & kBackward) && --fuel_ <= 0) refuel(); \
    pc += in.c;                                           \
  } while (false)
// The instructions that only call the member function of their name.
// clang-format off
#define KERF_MEMBERS(X) \
  X(move) X(get_global) X(get_dynamic) X(dereference) X(refer) X(refer_dynamic) \
  X(need_target) X(store) X(apply) X(append) X(step_target) X(step_element) X(logic_not) X(bit_not) \
  X(index) X(element) X(set_element) X(vector) X(list) X(call_builtin) X(define) \
  X(declare_local) X(declare_constant) X(warn_global) X(repeat_start) X(foreach_start) \
  X(clear) X(stray_break) X(unknown_function) X(by_reference) X(wrong_count)
// clang-format on
#define KERF_CALL_MEMBER(op) \
  case Op::op: do_##op(in); break;

void Vm::loop() {
  Pc pc = code_.instructions.data();
  const Value* const constants = code_.constants.data();
  Value* frame = frame_;
  for (;;) {
    const Instruction& in = *pc++;
    at_ = &in;
    switch (in.op) {
      KERF_ARITHMETIC(add, add_plain, wrap_add)
      KERF_ARITHMETIC(sub, subtract_plain, wrap_sub)
      KERF_ARITHMETIC(mul, multiply_plain, wrap_mul)
      KERF_ARITHMETIC(div, divide_plain, whole_quotient)
      KERF_ARITHMETIC(mod, modulo_plain, whole_remainder)
      KERF_COMPARING_JUMP(less)
      KERF_COMPARING_JUMP(greater)
      KERF_COMPARING_JUMP(less_equal)
      KERF_COMPARING_JUMP(greater_equal)
      KERF_COMPARING_JUMP(equal)
      KERF_COMPARING_JUMP(not_equal)
      case Op::step:
        if (!quick_step(in, frame[in.a])) do_step(in);
        break;
      case Op::add_or:
      case Op::sub_or:
      case Op::bit_and:
      case Op::bit_or:
      case Op::bit_xor:
      case Op::shift_left:
      case Op::shift_right: do_operate(in); break;
      case Op::equal:
      case Op::not_equal:
      case Op::less:
      case Op::greater:
      case Op::less_equal:
      case Op::greater_equal: do_compare(in); break;
      case Op::vector2: do_small_vector(in, 2); break;
      case Op::vector3: do_small_vector(in, 3); break;
      case Op::jump: KERF_JUMP(); break;
      case Op::jump_if:
        if (slow_truth(in)) KERF_JUMP();
        break;
      case Op::jump_unless:
        if (!slow_truth(in)) KERF_JUMP();
        break;
      case Op::repeat_next:
        if (do_repeat_next(in)) KERF_JUMP();
        break;
      case Op::foreach_next:
        if (do_foreach_next(in)) KERF_JUMP();
        break;
      case Op::call:
        pc = enter(in, pc);
        frame = frame_;
        break;
      case Op::return_value:
        pc = return_value(in);
        frame = frame_;
        break;
      case Op::return_nothing:
        pc = return_nothing();
        frame = frame_;
        break;
      case Op::end_program: do_end_program(in); return;
      case Op::stop: return; KERF_MEMBERS(KERF_CALL_MEMBER)
      default: __builtin_unreachable();
    }
  }
}

}  // namespace kerf::gcmc
