// The virtual machine that executes compiled programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "front/gcmc/code/code.h"
#include "front/gcmc/run/machine.h"
#include "front/gcmc/text/parser.h"
#include "front/gcmc/value/gcmc_options.h"
#include "front/gcmc/value/runtime.h"

#include "kerf/base/progress.h"

namespace kerf::gcmc {

/// The data of a function that a call reads.
struct Callee {
  const Instruction* entry = nullptr;
  std::int32_t parameters = 0, variables = 0, slots = 0;
  std::int32_t cleared = 0;  // slots that release their blocks when it ends
  bool constants = false;    // it declares constants
  bool defined = false;      // its definition was executed
};

/// A call in progress. Without initial values, so that the stack of frames is not touched before it is used.
struct Frame {
  const Instruction* after;  // where the caller continues
  Value* base;               // of the caller
  const Callee* callee;      // running
  std::uint16_t x;           // the caller's slot for the value
  bool value_used;
};

class Vm final : public Runtime {
 public:
  Vm(const Tree& tree, const std::deque<Source>& sources, Program& code, const GcmcOptions& options,
     GcmcOutput& output, Diagnostics& diagnostics, Progress* progress);
  ~Vm() override;
  Vm(const Vm&) = delete;
  Vm& operator=(const Vm&) = delete;

  /// Defines a constant of the language before the program runs.
  void define_constant(NameId name, Value value);
  /// Runs to the end; throws Stop after an error. Returns the exit status of the program.
  int run();

  enum class At : std::uint8_t { here, program };  // the running instruction, or the call in the program
  /// message(), warning() and error() of the program itself, and warnings of the built-in library.
  void program_message(Severity severity, Code code, std::string text, std::string hint, At at);

  Machine& machine() { return machine_; }
  const GcmcOptions& options() const { return options_; }
  const Tree& tree() const { return tree_; }
  bool script_failed() const { return script_errors_ > 0; }
  std::size_t warnings() const { return warnings_; }
  bool was_stopped() const { return stopped_; }

  /// The variable of that name in the running function, or nullptr.
  const Value* variable(std::string_view name) const;
  bool is_constant(const Value& variable) const { return constants_.count(&variable) != 0; }
  /// To be called for every output: it is not an endless loop without output.
  void reset_quiet_steps() {
    quiet_steps_ = 0;
    count_output(1);
  }
  /// Ends the program if its output exceeds the limit.
  void count_output(std::size_t bytes) {
    output_bytes_ += bytes;
    if (output_bytes_ > options_.max_output) fail_output();
  }

  std::size_t current_instruction() const {
    return static_cast<std::size_t>(at_ - code_.instructions.data());
  }
  /// Calls in progress, outermost first.
  std::size_t depth() const { return static_cast<std::size_t>(top_ - frames_.get()); }
  std::size_t call_site(std::size_t frame) const {
    return static_cast<std::size_t>(frames_[frame].after - code_.instructions.data()) - 1;
  }
  TextLocation location(std::size_t instruction) const;

 private:
  using Pc = const Instruction*;
  void report_warning(Code code, std::string text, std::string hint) override;
  void report_error(Code code, std::string text, std::string hint) override;
  void loop();
  const Value& operand(std::int32_t o, const Value* frame, const Value* constants) const {
    return o < 0 ? constants[~o] : frame[o];
  }
  Value& slot(std::int32_t o);
  /// The operand's value; a variable that does not exist is an error.
  const Value& present(std::int32_t o) {
    const Value& v = operand(o, frame_, code_.constants.data());
    if (v.is_absent()) fail_absent(o);
    return v;
  }
  [[noreturn]] void fail_absent(std::int32_t slot);
  [[noreturn]] void fail_unknown(std::string_view kind, NameId name, const std::vector<std::string>& known);
  std::string name_text(NameId name) const { return tree_.names[static_cast<std::size_t>(name)]; }
  const FunctionCode& running() const;
  const FunctionCode& code_of(const Callee& callee) const {
    return code_.functions[static_cast<std::size_t>(&callee - callees_.data())];
  }
  bool reach(Value* end);
  void refuel();
  [[noreturn]] void fail_output();

  // instructions that are more than a few lines
  void do_move(const Instruction& in);
  void do_operate(const Instruction& in);
  void operate_with(const Instruction& in, Op op, const Value& b);
  void do_append(const Instruction& in);
  Value appended(std::int32_t o, bool take);
  void do_compare(const Instruction& in);
  bool slow_holds(const Instruction& in, Op op);
  bool slow_holds_integer(const Instruction& in, Op op);
  bool slow_truth(const Instruction& in);
  void do_get_global(const Instruction& in);
  void do_get_dynamic(const Instruction& in);
  void do_dereference(const Instruction& in);
  void do_refer(const Instruction& in);
  void do_refer_dynamic(const Instruction& in);
  void do_need_target(const Instruction& in);
  void do_store(const Instruction& in);
  void do_apply(const Instruction& in);
  void do_step(const Instruction& in);
  void do_step_target(const Instruction& in);
  void do_step_element(const Instruction& in);
  void step_in(const Instruction& in, Value& v);
  void do_logic_not(const Instruction& in);
  void do_bit_not(const Instruction& in);
  void do_index(const Instruction& in);
  void do_element(const Instruction& in);
  void do_set_element(const Instruction& in);
  void do_vector(const Instruction& in);
  void do_small_vector(const Instruction& in, std::size_t count);
  Scalar entry(std::int32_t o);
  void forget_constants(const Callee& callee);
  void do_list(const Instruction& in);
  void do_call_builtin(const Instruction& in);
  void do_define(const Instruction& in);
  void do_declare_local(const Instruction& in);
  void do_declare_constant(const Instruction& in);
  void do_warn_global(const Instruction& in);
  void do_repeat_start(const Instruction& in);
  bool do_repeat_next(const Instruction& in);
  void do_foreach_start(const Instruction& in);
  bool do_foreach_next(const Instruction& in);
  void do_clear(const Instruction& in);
  void do_stray_break(const Instruction& in);
  void do_unknown_function(const Instruction& in);
  void do_by_reference(const Instruction& in);
  void do_wrong_count(const Instruction& in);
  Pc enter(const Instruction& in, Pc pc);
  void do_end_program(const Instruction& in);
  Pc return_value(const Instruction& in);
  Pc return_nothing();
  Pc leave();
  Value result_of(const Instruction& in);
  [[noreturn]] void fail_undefined_function(std::int32_t index, std::string hint);
  Value& writable_target(std::int32_t reference);
  void report(Severity severity, Code code, std::string text, std::string hint, At at = At::here);

  const Tree& tree_;
  const std::deque<Source>& sources_;
  Program& code_;
  const GcmcOptions& options_;
  GcmcOutput& output_;
  Diagnostics& diagnostics_;
  Machine machine_;

  std::size_t slots_;  // of the stack
  std::unique_ptr<std::byte[]> storage_;
  Value* stack_ = nullptr;
  Value* stack_end_ = nullptr;
  Value* reached_ = nullptr;  // slots before this are constructed
  Value* frame_ = nullptr;    // of the running function
  Pc at_ = nullptr;           // the running instruction
  std::unique_ptr<Frame[]> frames_;
  Frame* top_ = nullptr;  // after the innermost call
  Frame* frames_end_ = nullptr;
  std::vector<Callee> callees_;
  const struct Builtin* builtins_;
  std::unordered_set<const Value*> constants_;  // variables that may not be assigned to
  std::int32_t fuel_ = 0;
  std::uint64_t quiet_steps_ = 0, steps_ = 0, output_bytes_ = 0;
  std::size_t script_errors_ = 0;
  std::size_t warnings_ = 0;
  bool stopped_ = false;
  int status_ = 0;
};

/// The location of the call in the user's program that led into the built-in library.
TextLocation location_in_program(const Vm& vm);

}  // namespace kerf::gcmc
