// The compiler of gcmc programs.
//
// A name in a function is the function's own variable if that exists when it is used, else the global one. If
// that can be determined from the text (a parameter, after `local`, a name of no global variable) the slot is
// used directly; else it is determined at run time by the instruction.
#include "front/gcmc/code/compiler.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "front/gcmc/code/operators.h"
#include "front/gcmc/code/tree_view.h"

namespace kerf::gcmc {
namespace {

constexpr std::int32_t kMaxSlots = 65535;
constexpr std::size_t kMaxInstructions = 50'000'000;
constexpr int kMaxPresetDepth = 8;  // nesting of default values that call functions with default values

enum class Access : std::uint8_t { slot, reference, global, dynamic };
struct Variable {
  Access access = Access::slot;
  std::int32_t slot = -1;
  std::int32_t global = -1;
};

struct Loop {
  std::vector<std::size_t> breaks, continues;
};

Op op_of(Token t) {
  switch (t) {
    case Token::plus:
    case Token::plus_assign: return Op::add;
    case Token::minus:
    case Token::minus_assign: return Op::sub;
    case Token::star:
    case Token::star_assign: return Op::mul;
    case Token::slash:
    case Token::slash_assign: return Op::div;
    case Token::percent:
    case Token::percent_assign: return Op::mod;
    case Token::add_or:
    case Token::add_or_assign: return Op::add_or;
    case Token::sub_or:
    case Token::sub_or_assign: return Op::sub_or;
    case Token::amp:
    case Token::amp_assign: return Op::bit_and;
    case Token::pipe:
    case Token::pipe_assign: return Op::bit_or;
    case Token::caret:
    case Token::caret_assign: return Op::bit_xor;
    case Token::shift_left:
    case Token::shift_left_assign: return Op::shift_left;
    case Token::shift_right:
    case Token::shift_right_assign: return Op::shift_right;
    case Token::equal: return Op::equal;
    case Token::not_equal: return Op::not_equal;
    case Token::less: return Op::less;
    case Token::greater: return Op::greater;
    case Token::less_equal: return Op::less_equal;
    default: return Op::greater_equal;
  }
}

std::optional<Op> jump_of(Token t) {
  switch (t) {
    case Token::equal: return Op::jump_equal;
    case Token::not_equal: return Op::jump_not_equal;
    case Token::less: return Op::jump_less;
    case Token::greater: return Op::jump_greater;
    case Token::less_equal: return Op::jump_less_equal;
    case Token::greater_equal: return Op::jump_greater_equal;
    default: return std::nullopt;
  }
}

class Compiler {
 public:
  Compiler(const Tree& tree, BuiltinIndex builtin_index, Meter& meter)
      : tree_(tree), view_(tree, meter), builtin_index_(builtin_index), meter_(meter) {}
  Program run(const std::vector<NameId>& constants);

 private:
  const Node& node(NodeId id) const { return view_.node(id); }
  NodeId child(const Node& n, std::size_t i) const { return view_.child(n, i); }

  // names and slots
  struct Names {
    std::unordered_set<NameId> names;
    std::unordered_set<NameId> functions;  // whose default values have been examined
  };
  void collect_names(NodeId id, bool assigned_only, Names& out) const;
  void start_function(const FunctionTree* function);
  Variable find(NameId name);
  std::int32_t variable_slot(NameId name);
  std::int32_t temporary(std::int32_t count = 1);
  bool is_temporary(std::int32_t operand) const { return operand >= variables_; }
  bool may_be_constant(NameId name) const { return constant_names_.count(name) != 0; }

  // instructions
  std::size_t emit(SourceLocation at, Op op, std::int32_t x, std::int32_t a = 0, std::int32_t b = 0,
                   std::int32_t c = 0);
  std::size_t emit_operation(SourceLocation at, Op op, std::int32_t x, std::int32_t a, std::int32_t b);
  Instruction& at(std::size_t i) { return code_.instructions[i]; }
  std::uint8_t take(std::int32_t operand, std::uint8_t bit) const {
    return is_temporary(operand) ? bit : std::uint8_t{0};
  }
  std::size_t here() const { return code_.instructions.size(); }
  void patch(std::size_t jump) { at(jump).c = static_cast<std::int32_t>(here() - jump - 1); }
  void jump_back(std::size_t jump, std::size_t target);
  std::int32_t constant(Value v);
  std::int32_t number_constant(Scalar s);

  // statements
  void statements(const Node& block);
  void statement(NodeId id);
  void effect(NodeId id);
  void inner_block(NodeId id);
  void declaration(const Node& n);
  void if_else(const Node& n);
  void for_loop(const Node& n);
  void while_loop(const Node& n);
  void do_loop(const Node& n);
  void counted_loop(const Node& n, Op start_op, Op next_op);
  void leave_loop(const Node& n);
  void return_value(const Node& n);
  void close_loop();
  void close_loop(NodeId condition, std::size_t loop_start);
  void function(std::size_t index);

  // expressions
  std::int32_t operand(NodeId id);
  std::int32_t stable_operand(NodeId id, NodeId later1, NodeId later2 = kNoNode);
  void into(NodeId id, std::int32_t x);
  bool is_internal(NameId name) const;
  void read_variable(const Node& n, std::int32_t x);
  void binary(const Node& n, std::int32_t x);
  void unary(const Node& n, std::int32_t x);
  void logic(NodeId id, std::int32_t x);
  void condition(const Node& n, std::int32_t x);
  void vector(const Node& n, std::int32_t x);
  void list(const Node& n, std::int32_t x);
  void call(const Node& n, std::int32_t x, bool used);
  void arguments(const Node& n, const FunctionTree& f, std::int32_t base);
  void argument_by_reference(const Node& n, NodeId argument, std::size_t index, std::int32_t x);
  enum class Used : std::uint8_t { no, yes };
  std::int32_t assign(const Node& n, Used used);
  std::int32_t assign_name(const Node& n, const Node& target, Used used);
  NodeId appended(Op op, NodeId right) const;
  const Node& compound_of(const Node& n, Node& space) const;
  std::int32_t assign_element(const Node& n);
  std::int32_t step(const Node& n, bool used);
  std::int32_t reference_to(const Node& name);
  void jump_on(NodeId id, bool sense, std::vector<std::size_t>& jumps);

  const Tree& tree_;
  TreeView view_;
  BuiltinIndex builtin_index_;
  Meter& meter_;
  Program code_;
  std::unordered_map<std::uint64_t, std::int32_t> number_index_[16];
  std::unordered_set<NameId> constant_names_;
  std::vector<NameId> language_names_;
  std::int32_t undefined_mark_ = kNoOperand;
  int preset_depth_ = 0;

  // of the function being compiled; function_ is null for the program itself
  const FunctionTree* function_ = nullptr;
  FunctionCode* frame_ = nullptr;
  std::unordered_map<NameId, std::int32_t> slots_;
  std::unordered_set<NameId> assigned_, own_, references_;
  std::int32_t variables_ = 0, next_ = 0;
  std::vector<Loop> loops_;
};

// ---- names and slots

std::vector<NameId> ordered(const std::unordered_set<NameId>& names) {
  std::vector<NameId> out(names.begin(), names.end());
  std::sort(out.begin(), out.end());
  return out;
}

/// Names below node `id`: all, or those that are assigned to. Without the bodies of functions.
void Compiler::collect_names(NodeId id, bool assigned_only, Names& out) const {
  for (; id != kNoNode && node(id).kind == NodeKind::if_else; id = node(id).c) {  // with all its elifs
    collect_names(node(id).a, assigned_only, out);
    collect_names(node(id).b, assigned_only, out);
  }
  if (id == kNoNode) return;
  const Node& n = node(id);
  auto& names = out.names;
  const auto below = [&](NodeId other) { collect_names(other, assigned_only, out); };
  switch (n.kind) {
    case NodeKind::function:
    case NodeKind::number:
    case NodeKind::text: return;
    case NodeKind::name:
      if (!assigned_only) names.insert(n.name);
      return;
    case NodeKind::assign: {
      NodeId target = n.a;
      while (node(target).kind == NodeKind::index) target = node(target).a;
      if (node(target).kind == NodeKind::name) names.insert(node(target).name);
      break;
    }
    case NodeKind::local:
    case NodeKind::constant:
    case NodeKind::foreach_loop:
    case NodeKind::repeat_loop:
      if (n.name != kNoName) names.insert(n.name);
      break;
    default: break;
  }
  for (NodeId other : {n.a, n.b, n.c, n.d}) below(other);
  for (std::size_t i = 0; i < n.count; ++i) below(child(n, i));
  if (n.kind != NodeKind::call) return;
  // Default values of parameters are evaluated at the call.
  const auto called = tree_.function_index.find(n.name);
  if (called == tree_.function_index.end() || !out.functions.insert(n.name).second) return;
  for (const Parameter& p : tree_.functions[static_cast<std::size_t>(called->second)].parameters)
    below(p.preset);
}

void Compiler::start_function(const FunctionTree* function) {
  function_ = function;
  slots_.clear();
  assigned_.clear();
  own_.clear();
  references_.clear();
  frame_->slot_names.clear();
  variables_ = 0;
  if (function == nullptr) {
    Names all;
    all.names.insert(language_names_.begin(), language_names_.end());
    for (NodeId id : tree_.program) collect_names(id, false, all);
    for (NameId name : ordered(all.names)) variable_slot(name);
  } else {
    for (const Parameter& p : function->parameters) {
      variable_slot(p.name);
      (p.by_reference ? references_ : own_).insert(p.name);
      frame_->by_reference.push_back(p.by_reference);
    }
    frame_->parameters = static_cast<std::int32_t>(function->parameters.size());
    Names assigned, all;
    collect_names(function->body, true, assigned);
    collect_names(function->body, false, all);
    assigned_ = std::move(assigned.names);
    for (NameId name : ordered(all.names)) {
      const bool global = code_.global_slots.count(name) != 0;
      if (!global || assigned_.count(name) != 0) variable_slot(name);
      if (!global && references_.count(name) == 0) own_.insert(name);
    }
  }
  next_ = variables_;
  frame_->frame = variables_;
  frame_->variables = variables_;
}

std::int32_t Compiler::variable_slot(NameId name) {
  auto& index = function_ == nullptr ? code_.global_slots : slots_;
  const auto [it, is_new] = index.try_emplace(name, variables_);
  if (!is_new) return it->second;
  if (variables_ >= kMaxSlots) throw TooManySlots{};
  frame_->slot_names.push_back(name);
  return variables_++;
}

Variable Compiler::find(NameId name) {
  const auto global = code_.global_slots.find(name);
  if (function_ == nullptr) return {Access::slot, global->second, -1};
  if (references_.count(name) != 0) return {Access::reference, slots_[name], -1};
  if (own_.count(name) != 0) return {Access::slot, slots_[name], -1};
  const auto local = slots_.find(name);
  if (local == slots_.end()) return {Access::global, -1, global->second};
  return {Access::dynamic, local->second, global->second};
}

std::int32_t Compiler::temporary(std::int32_t count) {
  const std::int32_t slot = next_;
  next_ += count;
  if (next_ >= kMaxSlots) throw TooManySlots{};
  frame_->frame = std::max(frame_->frame, next_);
  return slot;
}

// ---- instructions

std::size_t Compiler::emit(SourceLocation location, Op op, std::int32_t x, std::int32_t a, std::int32_t b,
                           std::int32_t c) {
  if (code_.instructions.size() >= kMaxInstructions) throw TooManySlots{};
  code_.instructions.push_back({op, 0, static_cast<std::uint16_t>(x), a, b, c});
  code_.locations.push_back(location);
  return here() - 1;
}

/// An operation or a comparing jump, with an immediate right operand if that is a small integer.
std::size_t Compiler::emit_operation(SourceLocation location, Op op, std::int32_t x, std::int32_t a,
                                     std::int32_t b) {
  const Value* right = b < 0 ? &code_.constants[static_cast<std::size_t>(~b)] : nullptr;
  const bool divides = op == Op::div || op == Op::mod;
  const bool known = (op >= Op::add && op <= Op::mod) || (op >= Op::jump_less && op <= Op::jump_not_equal);
  if (known && a >= 0 && right != nullptr && right->is_whole() &&
      !(divides && (right->whole() == 0 || right->whole() == -1)))
    return emit(location, with_integer(op), x, a, right->whole());
  return emit(location, op, x, a, b);
}

void Compiler::jump_back(std::size_t jump, std::size_t target) {
  at(jump).c = static_cast<std::int32_t>(target) - static_cast<std::int32_t>(jump) - 1;
  at(jump).flags = static_cast<std::uint8_t>(at(jump).flags | kBackward);
}

std::int32_t Compiler::constant(Value v) {
  code_.constants.push_back(std::move(v));
  return ~static_cast<std::int32_t>(code_.constants.size() - 1);
}

std::int32_t Compiler::number_constant(Scalar s) {
  std::uint64_t bits = 0;
  if (s.kind() == Kind::real)
    std::memcpy(&bits, &s.p.d, sizeof bits);
  else
    bits = static_cast<std::uint32_t>(s.kind() == Kind::integer ? s.whole() : 0);
  bits = bits * 31 + s.tag;  // equal bits with different tags are different constants
  auto& index = number_index_[s.tag & 15];
  const auto found = index.find(bits);
  if (found != index.end() && code_.constants[static_cast<std::size_t>(~found->second)].tag() == s.tag) {
    const Scalar known = code_.constants[static_cast<std::size_t>(~found->second)].scalar();
    if (s.kind() != Kind::real || std::memcmp(&known.p.d, &s.p.d, sizeof s.p.d) == 0) return found->second;
  }
  return index[bits] = constant(Value(s));
}

// ---- program

Program Compiler::run(const std::vector<NameId>& constants) {
  constant_names_.insert(constants.begin(), constants.end());
  for (const Node& n : tree_.nodes)
    if (n.kind == NodeKind::constant) constant_names_.insert(n.name);
  undefined_mark_ = constant(Value::reference(nullptr, kNoName));
  frame_ = &code_.program;
  language_names_ = constants;
  start_function(nullptr);
  code_.functions.resize(tree_.functions.size());
  for (NodeId id : tree_.program) statement(id);
  emit({}, Op::stop, 0);
  for (std::size_t i = 0; i < tree_.functions.size(); ++i) function(i);
  return std::move(code_);
}

void Compiler::function(std::size_t index) {
  const FunctionTree& f = tree_.functions[index];
  frame_ = &code_.functions[index];
  frame_->name = f.name;
  frame_->entry = here();
  start_function(&f);
  statements(node(f.body));
  emit(node(f.body).at, Op::return_nothing, 0);
}

// ---- statements

void Compiler::statements(const Node& block) {
  for (std::size_t i = 0; i < block.count; ++i) statement(child(block, i));
}

/// A block that may not be executed: variables that it creates are not certain to exist afterwards.
void Compiler::inner_block(NodeId id) {
  const auto own = own_;
  statements(node(id));
  own_ = own;
}

void Compiler::statement(NodeId id) {
  const Node& n = node(id);
  const std::int32_t temporaries = next_;
  switch (n.kind) {
    case NodeKind::expression: effect(n.a); break;
    case NodeKind::block: statements(n); break;
    case NodeKind::local:
    case NodeKind::constant: declaration(n); break;
    case NodeKind::if_else: if_else(n); break;
    case NodeKind::for_loop: for_loop(n); break;
    case NodeKind::while_loop: while_loop(n); break;
    case NodeKind::do_loop: do_loop(n); break;
    case NodeKind::foreach_loop: counted_loop(n, Op::foreach_start, Op::foreach_next); break;
    case NodeKind::repeat_loop: counted_loop(n, Op::repeat_start, Op::repeat_next); break;
    case NodeKind::function: emit(n.at, Op::define, 0, n.a); break;
    case NodeKind::return_value: return_value(n); break;
    case NodeKind::break_loop:
    case NodeKind::continue_loop: leave_loop(n); break;
    default: operand(id); break;
  }
  next_ = temporaries;
}

/// An expression whose value is not used.
void Compiler::effect(NodeId id) {
  const std::int32_t temporaries = next_;
  const Node& n = node(id);
  if (n.kind == NodeKind::call)
    call(n, temporary(), false);
  else if (n.kind == NodeKind::step)
    step(n, false);
  else if (n.kind == NodeKind::assign)
    assign(n, Used::no);
  else
    operand(id);
  next_ = temporaries;
}

void Compiler::declaration(const Node& n) {
  const std::int32_t value = n.a == kNoNode ? number_constant(Scalar{}) : operand(n.a);
  const auto global = code_.global_slots.find(n.name);
  const std::int32_t global_slot = global == code_.global_slots.end() ? -1 : global->second;
  if (n.kind == NodeKind::constant) {
    const bool inside = function_ != nullptr;
    const std::int32_t slot = inside ? slots_[n.name] : global_slot;
    frame_->constants = true;
    const std::size_t i = emit(n.at, Op::declare_constant, slot, value, inside ? global_slot : -1);
    at(i).flags = take(value, kTakeA);
    if (references_.count(n.name) == 0) own_.insert(n.name);
    return;
  }
  if (function_ == nullptr) emit(n.at, Op::warn_global, 0, n.name);
  const std::int32_t slot = function_ == nullptr ? global_slot : slots_[n.name];
  at(emit(n.at, Op::declare_local, slot, value)).flags = take(value, kTakeA);
  if (references_.count(n.name) == 0) own_.insert(n.name);
}

/// An if with its elifs, by a loop.
void Compiler::if_else(const Node& first) {
  std::vector<std::size_t> ends;
  std::optional<decltype(own_)> own;  // after the first condition, the only one that is always evaluated
  for (const Node* n = &first;; n = &node(n->c)) {
    if (n->kind != NodeKind::if_else) {
      statement(static_cast<NodeId>(n - tree_.nodes.data()));
      break;
    }
    std::vector<std::size_t> otherwise;
    jump_on(n->a, false, otherwise);
    inner_block(n->b);
    if (n->c != kNoNode) ends.push_back(emit(n->at, Op::jump, 0));
    for (std::size_t j : otherwise) patch(j);
    if (n->c == kNoNode) break;
    if (!own) own = own_;
  }
  if (own) own_ = *own;
  for (std::size_t j : ends) patch(j);
}

/// The end of a loop that continues at `loop_start` while the condition is true.
void Compiler::close_loop(NodeId condition, std::size_t loop_start) {
  std::vector<std::size_t> again;
  jump_on(condition, true, again);
  for (std::size_t j : again) jump_back(j, loop_start);
  close_loop();
}

void Compiler::close_loop() {
  for (std::size_t j : loops_.back().breaks) patch(j);
  loops_.pop_back();
}

void Compiler::for_loop(const Node& n) {
  if (n.a != kNoNode) effect(n.a);
  loops_.emplace_back();
  const std::size_t to_test = emit(n.at, Op::jump, 0);
  const std::size_t loop_start = here();
  inner_block(n.d);
  for (std::size_t j : loops_.back().continues) patch(j);
  if (n.c != kNoNode) effect(n.c);
  patch(to_test);
  close_loop(n.b, loop_start);
}

void Compiler::while_loop(const Node& n) {
  loops_.emplace_back();
  const std::size_t to_test = emit(n.at, Op::jump, 0);
  const std::size_t loop_start = here();
  inner_block(n.b);
  for (std::size_t j : loops_.back().continues) patch(j);
  patch(to_test);
  close_loop(n.a, loop_start);
}

void Compiler::do_loop(const Node& n) {
  loops_.emplace_back();
  const std::size_t loop_start = here();
  inner_block(n.b);
  for (std::size_t j : loops_.back().continues) patch(j);
  close_loop(n.a, loop_start);
}

/// foreach and repeat: two hidden slots hold the source and the position in it.
void Compiler::counted_loop(const Node& n, Op start_op, Op next_op) {
  const std::int32_t hidden = temporary(2);
  const std::int32_t source = operand(n.a);
  if (start_op == Op::foreach_start) frame_->iterates = true;
  at(emit(n.at, start_op, hidden, source)).flags = take(source, kTakeA);
  next_ = hidden + 2;
  const Variable v = n.name == kNoName ? Variable{} : find(n.name);
  const bool direct = n.name != kNoName && v.access == Access::slot && !may_be_constant(n.name);
  const std::int32_t item = direct ? v.slot : temporary();
  loops_.emplace_back();
  const std::size_t to_next = emit(n.at, Op::jump, 0);
  const std::size_t loop_start = here();
  if (!direct && n.name != kNoName) {
    Node name;
    name.at = n.at;
    name.name = n.name;
    const std::int32_t reference = reference_to(name);
    at(emit(n.at, Op::store, reference, item)).flags = kTakeA;
  }
  inner_block(n.b);
  for (std::size_t j : loops_.back().continues) patch(j);
  patch(to_next);
  jump_back(emit(n.at, next_op, hidden, item), loop_start);
  close_loop();
  emit(n.at, Op::clear, 0, hidden, hidden + 2);
}

void Compiler::leave_loop(const Node& n) {
  if (loops_.empty()) {
    emit(n.at, Op::stray_break, 0);
    return;
  }
  auto& jumps = n.kind == NodeKind::break_loop ? loops_.back().breaks : loops_.back().continues;
  jumps.push_back(emit(n.at, Op::jump, 0));
}

void Compiler::return_value(const Node& n) {
  const std::int32_t value = n.a == kNoNode ? number_constant(Scalar{}) : operand(n.a);
  const Op op = function_ == nullptr ? Op::end_program : Op::return_value;
  at(emit(n.at, op, 0, value)).flags = take(value, kTakeA);
}

// ---- expressions

/// The operand with the value of an expression: a constant, the slot of a variable, or a new temporary.
std::int32_t Compiler::operand(NodeId id) {
  const Node& n = node(id);
  if (auto v = view_.constant_value(id)) {
    return v->is_scalar() ? number_constant(v->scalar()) : constant(std::move(*v));
  }
  switch (n.kind) {
    case NodeKind::text:
      return constant(Value::string(tree_.strings[static_cast<std::size_t>(n.name)], meter_));
    case NodeKind::list:
      if (auto v = view_.constant_list(n)) return constant(std::move(*v));
      break;
    case NodeKind::name: {
      const Variable v = find(n.name);
      if (v.access == Access::slot && !is_internal(n.name)) return v.slot;
      break;
    }
    case NodeKind::assign: return assign(n, Used::yes);
    case NodeKind::step: return step(n, true);
    default: break;
  }
  const std::int32_t x = temporary();
  into(id, x);
  return x;
}

/// An operand that keeps its value while `later` is evaluated.
std::int32_t Compiler::stable_operand(NodeId id, NodeId later1, NodeId later2) {
  const std::int32_t o = operand(id);
  if (o < 0 || is_temporary(o) || (!view_.has_effects(later1) && !view_.has_effects(later2))) return o;
  const std::int32_t copy = temporary();
  emit(node(id).at, Op::move, copy, o);
  return copy;
}

/// Evaluates an expression into slot `x`. Only the last instruction writes to it, because the others may read
/// it.
void Compiler::into(NodeId id, std::int32_t x) {
  const Node& n = node(id);
  switch (n.kind) {
    case NodeKind::name: return read_variable(n, x);
    case NodeKind::call: return call(n, x, true);
    case NodeKind::unary:
      if (!view_.constant_value(id)) return unary(n, x);
      break;
    case NodeKind::binary:
      if (view_.constant_value(id)) break;
      if (n.op == Token::and_and || n.op == Token::or_or) return logic(id, x);
      return binary(n, x);
    case NodeKind::condition: return condition(n, x);
    case NodeKind::vector:
      if (!view_.constant_value(id)) return vector(n, x);
      break;
    case NodeKind::list:
      if (!view_.constant_list(n)) return list(n, x);
      break;
    case NodeKind::index: {
      const std::int32_t base = stable_operand(n.a, n.b);
      const std::int32_t i = operand(n.b);
      at(emit(n.at, Op::index, x, base, i)).flags =
          static_cast<std::uint8_t>(take(base, kTakeA) | take(i, kTakeB));
      return;
    }
    default: break;
  }
  const std::int32_t value = operand(id);
  if (value != x) at(emit(n.at, Op::move, x, value)).flags = take(value, kTakeA);
}

/// Internal variables are read by built-in functions of the same name.
bool Compiler::is_internal(NameId name) const {
  const std::string& text = tree_.names[static_cast<std::size_t>(name)];
  return text == "__global_position" || text == "__global_offset";
}

void Compiler::read_variable(const Node& n, std::int32_t x) {
  if (is_internal(n.name)) {
    emit(n.at, Op::call_builtin, x, builtin_index_(tree_.names[static_cast<std::size_t>(n.name)]), x, 0);
    return;
  }
  const Variable v = find(n.name);
  switch (v.access) {
    case Access::slot: emit(n.at, Op::move, x, v.slot); break;
    case Access::reference: emit(n.at, Op::dereference, x, v.slot); break;
    case Access::global: emit(n.at, Op::get_global, x, v.global); break;
    case Access::dynamic: emit(n.at, Op::get_dynamic, x, v.slot, v.global); break;
  }
}

void Compiler::binary(const Node& n, std::int32_t x) {
  const Op op = op_of(n.op);
  const NodeId item = appended(op, n.b);
  const std::int32_t a = stable_operand(n.a, n.b);
  const std::int32_t b = operand(item == kNoNode ? n.b : item);
  at(emit_operation(n.at, item == kNoNode ? op : Op::append, x, a, b)).flags =
      static_cast<std::uint8_t>(take(a, kTakeA) | take(b, kTakeB));
}

void Compiler::unary(const Node& n, std::int32_t x) {
  const std::int32_t a = operand(n.a);
  if (n.op == Token::minus) {
    const std::int32_t minus_one = number_constant(Scalar::integer(-1));
    at(emit_operation(n.at, Op::mul, x, a, minus_one)).flags = take(a, kTakeA);
    return;
  }
  at(emit(n.at, n.op == Token::bang ? Op::logic_not : Op::bit_not, x, a)).flags = take(a, kTakeA);
}

void Compiler::logic(NodeId id, std::int32_t x) {
  std::vector<std::size_t> when_false;
  const SourceLocation location = node(id).at;
  jump_on(id, false, when_false);
  emit(location, Op::move, x, number_constant(Scalar::integer(1)));
  const std::size_t end = emit(location, Op::jump, 0);
  for (std::size_t j : when_false) patch(j);
  emit(location, Op::move, x, number_constant(Scalar::integer(0)));
  patch(end);
}

void Compiler::condition(const Node& n, std::int32_t x) {
  std::vector<std::size_t> otherwise;
  jump_on(n.a, false, otherwise);
  into(n.b, x);
  const std::size_t end = emit(n.at, Op::jump, 0);
  for (std::size_t j : otherwise) patch(j);
  into(n.c, x);
  patch(end);
}

/// Jumps if the truth of an expression is `sense`, else falls through. The jumps must be patched.
void Compiler::jump_on(NodeId id, bool sense, std::vector<std::size_t>& jumps) {
  const Node& n = node(id);
  const std::int32_t temporaries = next_;
  if (n.kind == NodeKind::binary && (n.op == Token::and_and || n.op == Token::or_or)) {
    const bool decides = n.op == Token::or_or;  // the truth of the left side that decides the result
    if (decides == sense) {
      jump_on(n.a, sense, jumps);
      jump_on(n.b, sense, jumps);
    } else {
      std::vector<std::size_t> settled;
      jump_on(n.a, decides, settled);
      jump_on(n.b, sense, jumps);
      for (std::size_t j : settled) patch(j);
    }
    return;
  }
  if (n.kind == NodeKind::unary && n.op == Token::bang) return jump_on(n.a, !sense, jumps);
  if (const auto op = n.kind == NodeKind::binary ? jump_of(n.op) : std::nullopt) {
    const std::int32_t a = stable_operand(n.a, n.b);
    const std::int32_t b = operand(n.b);
    jumps.push_back(emit_operation(n.at, *op, 0, a, b));
    at(jumps.back()).flags =
        static_cast<std::uint8_t>(take(a, kTakeA) | take(b, kTakeB) | (sense ? 0 : +kNegated));
  } else {
    const std::int32_t a = operand(id);
    jumps.push_back(emit(n.at, sense ? Op::jump_if : Op::jump_unless, 0, a));
    at(jumps.back()).flags = take(a, kTakeA);
  }
  next_ = temporaries;
}

void Compiler::vector(const Node& n, std::int32_t x) {
  const auto entry = [&](std::size_t i) { return child(n, i); };
  const auto simple = [&](std::size_t i, NodeId later1, NodeId later2) {
    return entry(i) == kNoNode ? undefined_mark_ : stable_operand(entry(i), later1, later2);
  };
  if (n.count == 2 || n.count == 3) {
    const NodeId last = n.count == 3 ? entry(2) : kNoNode;
    const std::int32_t a = simple(0, entry(1), last);
    const std::int32_t b = simple(1, last, kNoNode);
    const std::int32_t c = n.count == 3 ? simple(2, kNoNode, kNoNode) : 0;
    emit(n.at, n.count == 2 ? Op::vector2 : Op::vector3, x, a, b, c);
    return;
  }
  const auto count = static_cast<std::int32_t>(n.count);
  const std::int32_t base = temporary(count);
  for (std::int32_t i = 0; i < count; ++i) {
    const NodeId e = entry(static_cast<std::size_t>(i));
    const std::int32_t temporaries = next_;
    if (e == kNoNode)
      emit(n.at, Op::move, base + i, undefined_mark_);
    else
      into(e, base + i);
    next_ = temporaries;
  }
  emit(n.at, Op::vector, x, base, count);
}

void Compiler::list(const Node& n, std::int32_t x) {
  const auto count = static_cast<std::int32_t>(n.count);
  const std::int32_t base = temporary(count);
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t temporaries = next_;
    into(child(n, static_cast<std::size_t>(i)), base + i);
    next_ = temporaries;
  }
  emit(n.at, Op::list, x, base, count);
}

// ---- calls

void Compiler::call(const Node& n, std::int32_t x, bool used) {
  const std::string& name = tree_.names[static_cast<std::size_t>(n.name)];
  const auto count = static_cast<std::int32_t>(n.count);
  const std::int32_t temporaries = next_;
  const int builtin = builtin_index_(name);
  const auto called = tree_.function_index.find(n.name);
  if (builtin < 0 && called == tree_.function_index.end()) {
    emit(n.at, Op::unknown_function, 0, n.name);
    return;
  }
  std::int32_t passed = count;
  std::int32_t base = 0;
  if (builtin >= 0) {
    base = temporary(std::max(count, 1));
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t mark = next_;
      into(child(n, static_cast<std::size_t>(i)), base + i);
      next_ = mark;
    }
  } else {
    const FunctionTree& f = tree_.functions[static_cast<std::size_t>(called->second)];
    passed = static_cast<std::int32_t>(f.parameters.size());
    const auto without_preset = std::count_if(f.parameters.begin(), f.parameters.end(),
                                              [](const Parameter& p) { return p.preset == kNoNode; });
    if (count > passed || count < without_preset) {
      emit(n.at, Op::wrong_count, 0, n.name, called->second);
      return;
    }
    base = temporary(std::max(passed, 1));
    arguments(n, f, base);
  }
  const std::size_t i = emit(n.at, builtin >= 0 ? Op::call_builtin : Op::call, x,
                             builtin >= 0 ? builtin : called->second, base, passed);
  at(i).flags = used ? std::uint8_t{kValueUsed} : std::uint8_t{0};
  next_ = temporaries;
}

void Compiler::arguments(const Node& n, const FunctionTree& f, std::int32_t base) {
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const std::int32_t mark = next_;
    const std::int32_t x = base + static_cast<std::int32_t>(i);
    const Parameter& p = f.parameters[i];
    if (i >= n.count) {
      if (++preset_depth_ > kMaxPresetDepth) throw TooManySlots{};
      into(p.preset, x);
      --preset_depth_;
    } else if (p.by_reference)
      argument_by_reference(n, child(n, i), i, x);
    else {
      into(child(n, i), x);
    }
    next_ = mark;
  }
}

void Compiler::argument_by_reference(const Node& n, NodeId argument, std::size_t index, std::int32_t x) {
  const Node& a = node(argument);
  if (a.kind != NodeKind::name) {
    emit(n.at, Op::by_reference, 0, n.name, static_cast<std::int32_t>(index + 1));
    return;
  }
  const Variable v = find(a.name);
  switch (v.access) {
    case Access::reference: emit(a.at, Op::move, x, v.slot); return;
    case Access::slot: emit(a.at, Op::refer, x, v.slot); break;
    case Access::global: emit(a.at, Op::refer_dynamic, x, kNoOperand, v.global, a.name); break;
    case Access::dynamic: emit(a.at, Op::refer_dynamic, x, v.slot, v.global, a.name); break;
  }
  emit(a.at, Op::need_target, 0, x);
}

// ---- assignment

std::int32_t Compiler::reference_to(const Node& name) {
  const Variable v = find(name.name);
  if (v.access == Access::reference) return v.slot;
  const std::int32_t x = temporary();
  if (v.access == Access::slot)
    emit(name.at, Op::refer, x, v.slot);
  else
    emit(name.at, Op::refer_dynamic, x, v.access == Access::dynamic ? v.slot : kNoOperand, v.global,
         name.name);
  return x;
}

/// The vector of a right side {vector}, which can be appended without a temporary list; else kNoNode.
NodeId Compiler::appended(Op op, NodeId right) const {
  const Node& n = node(right);
  const bool one = n.kind == NodeKind::list && n.count == 1 && op == Op::add;
  return one && !view_.constant_list(n) ? child(n, 0) : kNoNode;
}

/// v = v + e as v += e, which changes v in place.
const Node& Compiler::compound_of(const Node& n, Node& space) const {
  const Node& right = node(n.b);
  const bool adds = right.kind == NodeKind::binary && (right.op == Token::plus || right.op == Token::add_or);
  if (n.op != Token::assign || !adds || view_.has_effects(right.b)) return n;
  const Node& left = node(right.a);
  if (left.kind != NodeKind::name || left.name != node(n.a).name) return n;
  space = n;
  space.op = right.op;
  space.b = right.b;
  return space;
}

std::int32_t Compiler::assign(const Node& n, Used used) {
  const Node& target = node(n.a);
  if (target.kind != NodeKind::name) return assign_element(n);
  Node space;
  return assign_name(compound_of(n, space), target, used);
}

std::int32_t Compiler::assign_name(const Node& n, const Node& target, Used used) {
  const Variable v = find(target.name);
  const bool direct = v.access == Access::slot && !may_be_constant(target.name);
  const bool plain = n.op == Token::assign;
  if (direct && plain) {
    into(n.b, v.slot);
    return v.slot;
  }
  Op op = plain ? Op::store : op_of(n.op);
  const NodeId item = plain ? kNoNode : appended(op, n.b);
  if (item != kNoNode) op = Op::append;
  const std::int32_t value = operand(item == kNoNode ? n.b : item);
  if (direct) {
    at(emit_operation(n.at, op, v.slot, v.slot, value)).flags = take(value, kTakeB);
    return v.slot;
  }
  const std::int32_t reference = reference_to(target);
  const std::size_t i = plain ? emit(n.at, Op::store, reference, value)
                              : emit(n.at, Op::apply, reference, value, static_cast<std::int32_t>(op));
  at(i).flags = take(value, kTakeA);
  if (used == Used::no) return reference;
  const std::int32_t x = temporary();
  emit(n.at, Op::dereference, x, reference);
  return x;
}

std::int32_t Compiler::assign_element(const Node& n) {
  NodeId base = kNoNode, first = kNoNode, second = kNoNode;
  if (!view_.element_of(n.a, base, first, second)) {
    emit(n.at, Op::stray_break, 0, 1);
    return number_constant(Scalar{});
  }
  const std::int32_t value = stable_operand(n.b, first, second);
  const std::int32_t i = stable_operand(first, second);
  const std::int32_t j = second == kNoNode ? kNoOperand : operand(second);
  const std::int32_t reference = reference_to(node(base));
  if (n.op == Token::assign) {
    emit(n.at, Op::set_element, reference, i, j, value);
    return value;
  }
  const std::int32_t result = temporary();
  emit(n.at, Op::element, result, reference, i, j);
  at(emit_operation(n.at, op_of(n.op), result, result, value)).flags = take(value, kTakeB);
  emit(n.at, Op::set_element, reference, i, j, result);
  return result;
}

std::int32_t Compiler::step(const Node& n, bool used) {
  const Node& target = node(n.a);
  const auto flags = static_cast<std::uint8_t>((n.op == Token::minus_minus ? +kMinus : 0) |
                                               (n.prefix ? +kPrefix : 0) | (used ? +kValueUsed : 0));
  const std::int32_t x = temporary();
  if (target.kind == NodeKind::name) {
    const Variable v = find(target.name);
    if (v.access == Access::slot && !may_be_constant(target.name)) {
      at(emit(n.at, Op::step, x, v.slot)).flags = flags;
      return x;
    }
    at(emit(n.at, Op::step_target, x, reference_to(target))).flags = flags;
    return x;
  }
  NodeId base = kNoNode, first = kNoNode, second = kNoNode;
  if (target.kind != NodeKind::index || !view_.element_of(n.a, base, first, second)) {
    emit(n.at, Op::stray_break, 0, 1);
    return x;
  }
  const std::int32_t i = stable_operand(first, second);
  const std::int32_t j = second == kNoNode ? kNoOperand : operand(second);
  const std::int32_t reference = reference_to(node(base));
  at(emit(n.at, Op::step_element, x, reference, i, j)).flags = flags;
  return x;
}

}  // namespace

Program compile(const Tree& tree, const std::vector<NameId>& constants, BuiltinIndex builtin_index,
                Meter& meter) {
  return Compiler(tree, builtin_index, meter).run(constants);
}

}  // namespace kerf::gcmc
