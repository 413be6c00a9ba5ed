// The parameters of a program: numbered ones, local and global names, and those that tell a controller's
// state.
//
// Source: LinuxCNC's page "Parameters, variables, functions": 1-30 belong to a subroutine's call, names that
// begin with '_' are known everywhere, other names in one subroutine only.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace kerf::gcode {

/// What a program can read of the controller's state: the parameters that no program sets.
class SystemValues {
 public:
  virtual ~SystemValues() = default;
  virtual std::optional<double> system_number(int number) const = 0;
  /// `name` in small letters without its brackets, such as "_x".
  virtual std::optional<double> system_name(std::string_view name) const = 0;
  /// What a number that the controller keeps in mm is divided by when the program reads it.
  virtual double unit_of(int number) const = 0;
};

class Parameters {
 public:
  static constexpr int kLast = 5602;
  static constexpr std::size_t kArguments = 30;

  explicit Parameters(const SystemValues& system) : system_(system), numbers_(kLast + 1), frames_(1) {}

  /// Nothing where the number is not from 1 to kLast.
  std::optional<double> number(int number) const;
  bool set_number(int number, double value);
  /// Names as normal_name() gives them.
  std::optional<double> name(const std::string& name) const;
  void set_name(const std::string& name, double value);

  /// What the controller itself keeps in numbered parameters (offsets, homes); no test of the number.
  double& slot(int number) { return numbers_[static_cast<std::size_t>(number)]; }
  double slot(int number) const { return numbers_[static_cast<std::size_t>(number)]; }

  /// A subroutine begins with its arguments in #1 to #30, and ends with the caller's values back in them.
  void enter(std::span<const double> arguments);
  void leave();

 private:
  using Names = std::unordered_map<std::string, double>;
  struct Frame {
    std::array<double, kArguments> kept{};
    Names names;
  };
  const SystemValues& system_;
  std::vector<double> numbers_;
  Names globals_;
  std::vector<Frame> frames_;
};

/// A name in small letters without blanks: "Cut Depth" is "cutdepth".
std::string normal_name(std::string_view text);

}  // namespace kerf::gcode
