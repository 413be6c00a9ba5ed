// The parameters of a program: numbered ones, local and global names, and those that hold the controller's
// state.
//
// Source: LinuxCNC's page "Parameters, variables, functions": 1 to 30 belong to a subroutine's call, names
// that start with '_' are global, other names belong to one subroutine.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace kerf::gcode {

/// The controller's state as parameters that a program can read but not set.
class SystemValues {
 public:
  virtual ~SystemValues() = default;
  virtual std::optional<double> system_number(int number) const = 0;
  /// `name` in lower case without < and >, such as "_x".
  virtual std::optional<double> system_name(std::string_view name) const = 0;
  /// The divisor for parameters that are stored in mm: mm per unit of the program; 1 for all others.
  virtual double unit_of(int number) const = 0;
  /// Whether the value is known only at run time and is an assumption here.
  virtual bool is_unknown_number(int number) const = 0;
  virtual bool is_unknown_name(std::string_view name) const = 0;
};

/// A value of a program. `unknown`: known only at run time.
struct ParameterValue {
  static ParameterValue nothing() {
    ParameterValue none;
    none.vacant = true;
    return none;
  }
  // NOLINTNEXTLINE(google-explicit-constructor): most values are known
  ParameterValue(double v = 0.0, bool is_unknown = false) : value(v), unknown(is_unknown) {}
  bool operator==(const ParameterValue&) const = default;
  double value;
  bool unknown;
  bool vacant = false;  // of Fanuc's macros: a variable that was never set; its value is 0
};

class Parameters {
 public:
  static constexpr int kLast = 5602, kFirstStored = 5161, kAlarm = 3000, kMessage = 3006;
  static constexpr std::size_t kArguments = 30, kMacroLocals = 33;

  explicit Parameters(const SystemValues& system) : system_(system), numbers_(kLast + 1), frames_(1) {}

  /// Fanuc's variables: #0 and all that were never set are vacant, #1 to #33 belong to a macro's call.
  void use_vacant_variables() { has_vacant_ = true; }
  bool has_vacant() const { return has_vacant_; }
  /// The last assignment to #3000 (an alarm) or #3006 (a stop with a message) of Fanuc's controls, once.
  std::optional<int> take_stop() { return std::exchange(stop_, std::nullopt); }
  /// Nothing where the number is not from 1 to kLast.
  std::optional<ParameterValue> number(int number) const;
  bool set_number(int number, ParameterValue value);
  /// Names as normal_name() gives them.
  std::optional<ParameterValue> name(const std::string& name) const;
  void set_name(const std::string& name, ParameterValue value);

  /// Direct access to what the controller stores in numbered parameters (offsets, homes); `number` is not
  /// checked.
  double& slot(int number) { return numbers_[static_cast<std::size_t>(number)]; }
  double slot(int number) const { return numbers_[static_cast<std::size_t>(number)]; }
  /// Sets a number as the controller does (G28.1); is_assigned() is false after it.
  void store(int number, double value);
  /// Whether the last value of a number that the controller stores is from an assignment of the program.
  bool is_assigned(int number) const { return assigned_.count(number) != 0; }

  /// Starts a subroutine: its arguments are in #1 to #30. leave() restores the caller's values.
  void enter(std::span<const ParameterValue> arguments);
  void leave();

 private:
  using Names = std::unordered_map<std::string, ParameterValue>;
  struct Frame {
    std::array<ParameterValue, kMacroLocals> caller{};  // of #1 to #30, #33 of Fanuc's
    Names names;
  };
  void mark(int number, bool unknown);
  std::size_t locals() const { return has_vacant_ ? kMacroLocals : kArguments; }
  void note_given(int number, const ParameterValue& value);
  void put(int number, const ParameterValue& value);
  ParameterValue taken(int number) const;

  const SystemValues& system_;
  std::vector<double> numbers_;
  std::unordered_set<int> unknown_;  // of these numbers
  bool has_vacant_ = false;
  std::optional<int> stop_;
  std::unordered_set<int> given_;     // numbers that a program with vacant variables has set
  std::unordered_set<int> assigned_;  // from kFirstStored
  Names globals_;
  std::vector<Frame> frames_;
};

/// A name in lower case without blanks: "Cut Depth" is "cutdepth".
std::string normal_name(std::string_view text);

}  // namespace kerf::gcode
