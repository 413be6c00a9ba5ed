// Runs a parsed OpenSCAD program: expressions, statements, modules and commands.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "front/scad/run/frames.h"
#include "front/scad/text/syntax.h"
#include "front/scad/value/command.h"
#include "front/scad/value/scad_limits.h"

#include "kerf/base/limits.h"
#include "kerf/base/progress.h"

namespace kerf::scad {

/// Ends the run after a reported error; thrown inside of this room only.
struct Stop {};

struct RunLimits {
  std::size_t max_memory = limits::kMaxScriptMemory;    // bytes of strings, vectors and frames
  std::uint64_t max_steps = limits::kMaxScadSteps;      // calls and passes of loops
  std::size_t max_range = limits::kMaxScadRange;        // values of a range in a loop
  std::size_t max_items = limits::kMaxScadItems;        // of one vector
  std::size_t max_string = limits::kMaxScadString;      // bytes of one string
  std::uint32_t max_nesting = limits::kMaxScadNesting;  // of vectors
  std::size_t max_stack = limits::kMaxScadStack;        // bytes of the processor's stack, for recursion
  std::uint64_t max_output = limits::kMaxScadOutput;    // bytes of echo()
};

/// Where the lines of echo() go.
struct PrintTo {
  std::string& text;
  const std::function<void(const TextLocation&, std::string_view)>& line;  // may be empty
};

/// A call that is running: of a module, function or command, for messages and origins.
struct Trace {
  const Trace* outer = nullptr;
  Position at;                        // of the call
  const std::string* name = nullptr;  // of what is called
  mutable OriginId origin = OriginId::none;
  mutable std::unordered_map<std::uint64_t, OriginId> origins = {};  // of positions inside of it
};

/// A running module, for children().
struct Activation {
  const Activation* outer = nullptr;  // the module whose call contains this one, in time
  const Module* module = nullptr;
  const Body* children = nullptr;
  Frame* frame = nullptr;              // of the children, with their variables
  const Activation* around = nullptr;  // the module in whose text the children are
};

/// The surroundings of a statement.
struct Context {
  Frame* frame = nullptr;
  const Activation* activation = nullptr;
  std::size_t specials = kNoMark;  // those bound since then hold in the block, whatever it assigns
  static constexpr std::size_t kNoMark = static_cast<std::size_t>(-1);
};

using Shapes = std::vector<Shape>;

/// A frame for as long as a block runs: on the stack, or on the heap if a literal may keep it.
class BlockFrame {
 public:
  BlockFrame(class Interpreter& run, Frame* parent, std::uint32_t slots, bool captured, Position at);
  ~BlockFrame() { stack_.shrink(base_); }
  BlockFrame(const BlockFrame&) = delete;
  BlockFrame& operator=(const BlockFrame&) = delete;
  Frame* get() const { return frame_; }

 private:
  ValueStack& stack_;
  Value* base_;
  Frame plain_;
  FrameRef heap_;
  Frame* frame_ = nullptr;
};

/// Arguments of a built-in function; all but those that measure in drawings ignore names, as OpenSCAD does.
struct BuiltinCall {
  class Interpreter& run;
  const std::string& name;
  std::span<Value> arguments;
  Position at;
  const std::vector<Argument>& names;
};

/// The files that a program imports, and what reads them.
struct ImportedFiles {
  /// The path of a file that is named at a position: beside the program file there, unless it is absolute.
  std::string path_beside(const std::string& name, Position at) const;

  const Sources& sources;
  const std::vector<std::string>& fonts;  // font files that the program uses
  const Imports* imports = nullptr;       // may be null: nothing is imported
  std::vector<std::string> paths = {};
};

class Interpreter {
 public:
  Interpreter(const Program& program, const RunLimits& limits, CommandSet commands, PrintTo output,
              Diagnostics& diagnostics, Progress* progress);
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Runs the program; the shapes of its top level. After an error that ends it, those until there.
  Shapes run();
  bool stopped() const { return stopped_; }

  // ---- for built-in functions and modules
  Value eval(const Expr& e, Frame& f);
  Value call_value(const Value& function, std::span<const Value> arguments, Position at);
  void run_block(const Body& b, const Context& outer, Shapes& out);
  /// The union of the shapes of each child that makes any.
  Shapes run_separately(const Body& children, const Context& context);
  /// The children numbered `which` of the running module, or all of them.
  void run_children_of(const Activation& a, const std::vector<std::size_t>* which, Position at, Shapes& out);
  Value special(std::string_view name) const;
  /// A variable of the program's top level; undef if there is none.
  Value top_variable(std::string_view name);
  double special_number(std::string_view name) const;
  void bind_special(std::uint32_t number, Value value);
  std::size_t special_mark() const { return undo_.size(); }
  void unwind(std::size_t mark);
  void print(std::string_view line, Position at);
  const Activation* activation() const { return activation_; }

  Diagnostic& warn(Code code, Position at, std::string message);
  Diagnostic& error(Code code, Position at, std::string message);
  [[noreturn]] void fail(Code code, Position at, std::string message, std::string hint = {});
  std::vector<DiagnosticNote> callers() const;
  OriginId origin(Position at, OriginTable& origins) const;
  TextLocation locate(Position at) const { return program_.sources.locate(at); }

  Value string(std::string text, Position at);
  Value vector(std::vector<Value> items, Position at) { return vector(items.data(), items.size(), at); }
  Value list(ItemList items, Position at) { return checked(items.finish(&meter_), at); }
  /// Of values that are moved.
  Value vector(Value* first, std::size_t count, Position at);
  void tick(Position at) {
    if ((++steps_ & 0xfffu) == 0) check_limits(at);
  }
  void check_items(std::size_t count, Position at) {
    if (count > limits_.max_items) too_many_items(at);
  }
  const RunLimits& limits() const { return limits_; }
  std::uint32_t next_seed() { return ++seed_; }
  Diagnostics& diagnostics() { return diagnostics_; }
  ImportedFiles& files() { return files_; }

 private:
  friend class BlockFrame;
  friend class Enter;
  friend class Site;

  // expressions
  Value variable(const Variable& v, Frame& f);
  Value unknown_variable(const Variable& v);
  /// The value without a warning: undef if there is none.
  Value quiet_variable(const Variable& v, Frame& f);
  Value eval_special(const Special& s);
  bool eval_number(const Expr& e, Frame& f, double& x, Value& other);
  bool number(const Expr& e, Frame& f, double& x, Value& other);
  bool operate_number(const Expr& e, const Value& left, const Value& right, double& x, Value& other);
  bool comparison(const Expr& e, Frame& f);
  bool arithmetic(const Expr& e, Frame& f, double& x, Value& other);
  bool condition(const Expr& e, Frame& f);
  Value compare(const Expr& e, Frame& f);
  Value eval_other(const Expr& e, Frame& f);
  Value eval_range(const Expr& e, Frame& f);
  void append(const Expr& e, Frame& f, ItemList& out);
  Value eval_vector(const VectorExpr& e, Frame& f);
  void generate(const Expr& e, Frame& f, ItemList& out);
  void generate_each(const Expr& e, Frame& f, ItemList& out);
  void generate_loop(const BindExpr& e, std::size_t argument, Frame& f, ItemList& out);
  void generate_c_loop(const BindExpr& e, Frame& f, ItemList& out);
  void generate_let(const BindExpr& e, Frame& f, ItemList& out);
  void bind(const std::vector<Argument>& list, Frame& f);
  Value eval_let(const BindExpr& e, Frame& f);
  void check(const std::vector<Argument>& list, Frame& f, Position at);
  std::string echo_text(const std::vector<Argument>& list, Frame& f);
  void print_arguments(const std::vector<Argument>& list, Frame& f, Position at);
  void too_many_items(Position at);
  Value checked(Value vector, Position at);
  void check_limits(Position at);

  // calls
  Value call(const CallExpr& e, Frame& f);
  Value call_builtin(const CallExpr& e, Frame& f);
  Value call_method(const CallExpr& e, Frame& f);
  Value call_unknown(const CallExpr& e);
  /// What a call leads to, if it is a function of the program.
  struct Target {
    const Function* function = nullptr;
    Frame* frame = nullptr;      // in which it is defined
    bool of_other_file = false;  // of a used file: the frame is made with the call
    bool mapped = false;         // CallExpr::map applies
    Value literal;               // keeps a function literal
  };
  bool find_target(const CallExpr& e, Frame& f, Target& target);
  /// The frame of a call: on the stack from `base` on, or on the heap.
  struct CallFrame {
    Frame stack;
    FrameRef heap;
    Frame* frame = nullptr;
    std::vector<std::uint32_t> let_specials =
        {};  // special variables of let() before a call in tail position
  };
  void make_frame(CallFrame& into, const Target& target, Position at);
  void enter_again(CallFrame& into, const Target& target, const CallExpr& e, Frame& caller, Value* base,
                   bool is_same);
  Value run_body(Target& target, CallFrame& frame, Value* base, std::string_view name);
  const CallExpr* tail_call(const Expr* e, CallFrame& call_frame, Frame*& f, FrameRef& held, Value& result);
  std::string unknown_name_hint(const std::string& name) const;
  void reserve(std::size_t slots, Position at);
  void take(const CallExpr& e, const Target& target, Frame& caller, Value* slots);
  void take_again(const CallExpr& e, const Target& target, Frame& caller, CallFrame& frame, Value* slots);
  void take_values(std::span<const Value> values, const Target& target, Value* slots);
  void set_parameter(const Parameter& p, Value v, Value* slots);
  void set_standard_values(const std::vector<Parameter>& parameters, const std::vector<Taken>& taken,
                           Frame* around, Value* slots);
  Value standard_value(const Parameter& p, Frame* around);
  Value call_command(int command, const std::vector<Argument>& arguments, Frame& f, Position at,
                     const Object* object, const Body* children, const Context& context, Shapes* out);

  // statements
  Frame& unit_frame(const Unit& unit) {
    return unit_ready_[unit.index] != 0 ? unit_frames_[unit.index] : make_unit_frame(unit);
  }
  Frame& make_unit_frame(const Unit& unit);
  FrameRef enter_unit(const Unit& unit);
  void assign(const Body& b, Frame& f, std::size_t specials = Context::kNoMark);
  void run_statements(const Body& b, const Context& context, Shapes& out);
  void run_statement(const Statement& s, const Context& context, Shapes& out);
  void run_kind(const Statement& s, const Context& context, Shapes& out);
  void run_call(const Statement& s, const Context& context, Shapes& out);
  void run_builtin(const Statement& s, const Context& context, Shapes& out);
  void run_module(const Statement& s, const Context& context, Shapes& out);
  void run_method(const Statement& s, const Context& context, Shapes& out);
  void run_loop(const Statement& s, std::size_t argument, const Context& inner, Shapes& out);

  HeapFrame* new_heap_frame(Frame* parent, std::uint32_t slots);

  const Program& program_;
  RunLimits limits_;
  CommandSet commands_;
  PrintTo output_;
  Diagnostics& diagnostics_;
  Progress* progress_;
  Meter meter_;
  ValueStack stack_;
  HeapFrame heap_frames_;  // heads the list
  std::vector<Value> root_values_;
  Frame root_;
  std::vector<std::vector<Value>> unit_values_;
  std::vector<Frame> unit_frames_;
  std::vector<char> unit_ready_;
  std::vector<Value> specials_;
  std::vector<std::pair<std::uint32_t, Value>> undo_;
  Trace outermost_;
  const Trace* trace_ = &outermost_;
  const Activation* activation_ = nullptr;
  std::uint64_t steps_ = 0;
  std::uint64_t printed_ = 0;
  std::uint32_t seed_ = 0;  // of rands() without one
  const char* stack_start_ = nullptr;
  bool stopped_ = false;
  bool has_root_ = false;
  std::unordered_map<const CallExpr*, std::vector<Value>> standard_values_;  // of calls in tail position
  Shapes root_shapes_;
  ImportedFiles files_;
};

/// As eval_number(), with the usual operands inline: a constant or a variable of this frame.
inline bool Interpreter::number(const Expr& e, Frame& f, double& x, Value& other) {
  if (e.kind == ExprKind::local) {
    if (const Value& v = f.slots[e.slot]; v.is_number()) {
      x = v.number();
      return true;
    }
  } else if (e.kind == ExprKind::constant) {
    if (const Value& v = static_cast<const Constant&>(e).value; v.is_number()) {
      x = v.number();
      return true;
    }
  }
  return eval_number(e, f, x, other);
}

// ---- tables of what is built in

enum class BuiltinArguments : std::uint8_t {
  all,
  until_no_number,  // those after the first one that is no number are not evaluated
  key_first,        // the same, and a key that is no number is evaluated twice
};
struct BuiltinFunction {
  std::string_view name;
  Value (*run)(BuiltinCall& call);
  double (*of_number)(double) = nullptr;  // for one number
  // As OpenSCAD: with fewer or more arguments than these none is evaluated.
  static constexpr std::size_t kAny = static_cast<std::size_t>(-1);
  std::size_t least = 0, max = kAny;
  BuiltinArguments evaluated = BuiltinArguments::all;
};
const std::vector<BuiltinFunction>& builtin_functions();

/// A module of OpenSCAD with its arguments evaluated.
struct ModuleCall {
  Interpreter& run;
  const Statement& statement;
  const struct BuiltinModule& module;
  const Context& context;     // of the children
  std::vector<Value> values;  // of the parameters, those with positions first
  Shapes& out;
};
enum class ModuleArguments : std::uint8_t { all, first, none };
struct BuiltinModule {
  std::string_view name;
  void (*run)(ModuleCall& call);
  std::vector<std::string_view> positional = {}, named = {};  // parameters
  ModuleArguments evaluated = ModuleArguments::all;
};
const std::vector<BuiltinModule>& builtin_modules();

// ---- shapes, see solids.cpp

/// The union; an error, and the first kind of shape, for areas and solids together.
Shape united(Interpreter& run, Shapes shapes, Position at);
/// What all passes of intersection_for have in common.
void intersect_passes(Interpreter& run, Position at, Shapes& passes, Shapes& out);

// ---- operators, with the warnings of undefined ones

/// As C's fmod.
double remainder_of(double x, double y);
Value operate(Interpreter& run, ExprKind kind, const Value& a, const Value& b, Position at);
Value negative(Interpreter& run, const Value& a, Position at);
/// As equal(); each compared value counts as a step, as a value can hold another one many times.
bool same(Interpreter& run, const Value& a, const Value& b, Position at);
Value index_value(const Value& a, const Value& b);
Value member_value(const Value& a, const std::string& name);
/// The characters of UTF-8 text. In text that is not valid, the first byte of each decides on its size.
std::vector<std::string_view> characters(std::string_view text);
std::size_t character_count(std::string_view text);
/// The number of one character; nothing where it is not valid.
std::optional<char32_t> code_point(std::string_view character);

}  // namespace kerf::scad
