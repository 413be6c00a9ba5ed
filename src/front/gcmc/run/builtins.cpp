// The table of built-in functions and constants, and the conversion of arguments.
#include "front/gcmc/run/builtins.h"

#include <cmath>
#include <unordered_map>

#include "base/codes/gcmc.h"
#include "front/gcmc/code/operators.h"

namespace kerf::gcmc {

const std::vector<Builtin>& all_builtins() {
  static const std::vector<Builtin> all = [] {
    std::vector<Builtin> out;
    for (const auto* part : {&math_builtins(), &vector_builtins(), &convert_builtins(), &machine_builtins(),
                             &compensated_builtins()})
      out.insert(out.end(), part->begin(), part->end());
    return out;
  }();
  return all;
}

int builtin_index(std::string_view name) {
  static const std::unordered_map<std::string_view, int> index = [] {
    std::unordered_map<std::string_view, int> out;
    for (const Builtin& b : all_builtins()) out.try_emplace(b.name, static_cast<int>(out.size()));
    return out;
  }();
  const auto found = index.find(name);
  return found == index.end() ? -1 : found->second;
}

const std::vector<std::string>& builtin_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Builtin& b : all_builtins()) out.emplace_back(b.name);
    return out;
  }();
  return names;
}

std::vector<LanguageConstant> language_constants(Meter& meter, GcmcVersion version) {
  constexpr std::int32_t kMajor = 1, kPoint = 0;
  const std::int32_t minor = version == GcmcVersion::v1_9 ? 9 : version == GcmcVersion::v1_8 ? 8 : 0;
  const std::string_view name = gcmc_version_text(version);
  const auto integer = [](std::int32_t v) { return Value::integer(v); };
  return {
      {"GCMC_VERSION_STR", Value::string(std::u32string(name.begin(), name.end()), meter)},
      {"GCMC_VERSION", integer((kMajor * 1000 + minor) * 1000 + kPoint)},
      {"GCMC_VERSION_MAJOR", integer(kMajor)},
      {"GCMC_VERSION_MINOR", integer(minor)},
      {"GCMC_VERSION_POINT", integer(kPoint)},
      {"PLANE_QUERY", Value::undef()},
      {"PLANE_XY", integer(0)},
      {"PLANE_XZ", integer(1)},
      {"PLANE_YZ", integer(2)},
      {"COOLANT_OFF", integer(0)},
      {"COOLANT_MIST", integer(1)},
      {"COOLANT_FLOOD", integer(2)},
      {"COOLANT_ALL", integer(3)},
      {"COOLANT_MISTFLOOD", integer(3)},
      {"FEEDMODE_INVERSE", integer(0)},
      {"FEEDMODE_UPM", integer(1)},
      {"FEEDMODE_UPR", integer(2)},
      {"FONTF_BOLD", integer(0x100)},
      {"FONTF_ITALIC", integer(0x200)},
      {"FONT_HSANS_1", integer(1)},
      {"FONT_HSANS_2", integer(2)},
      {"FONT_HSCRIPT_1", integer(3)},
      {"FONT_HSCRIPT_2", integer(4)},
      {"FONT_HTIMES", integer(5)},
      {"FONT_HSANS_1_RS", integer(6)},
      {"FONT_HTIMES_BOLD", integer(0x105)},
      {"FONT_HTIMES_ITALIC", integer(0x205)},
      {"FONT_HTIMES_ITALIC_BOLD", integer(0x305)},
  };
}

// ---- arguments

void Call::fail(Code code, std::string text) const { vm.fail(code, std::move(text)); }
void Call::warn(Code code, std::string text, std::string hint) const {
  vm.warn(code, std::move(text), std::move(hint));
}

Scalar Call::scalar(int i) const {
  if (!arguments[i].is_scalar() || arguments[i].is_undef())
    fail(codes::gcmc_type, fmt::format("{}() argument {} must be scalar", name, i + 1));
  return arguments[i].scalar();
}

double Call::length(int i) const {
  const Scalar s = scalar(i);
  if (is_angle(s.unit())) {
    warn(codes::gcmc_unit,
         fmt::format("{}() argument {} has incompatible angular units attached", name, i + 1),
         fmt::format("a length is expected; {} is used as {}", text_of(s), text_of(s.with_unit(vm.native))));
    return s.number();
  }
  return native_number(vm, s);
}

double Call::unitless(int i) const {
  const Scalar s = scalar(i);
  if (s.unit() != Unit::none)
    warn(codes::gcmc_unit, fmt::format("{}() argument {} has units attached", name, i + 1));
  return s.number();
}

double Call::angle(int i) const {
  const Scalar s = scalar(i);
  if (is_distance(s.unit())) {
    warn(codes::gcmc_unit,
         fmt::format("{}() argument {} has incompatible distance units attached", name, i + 1),
         fmt::format("an angle is expected; {} is used as {}", text_of(s), text_of(s.with_unit(Unit::rad))));
    return s.number();
  }
  return s.unit() == Unit::deg ? convert(s.number(), Unit::deg, Unit::rad) : s.number();
}

std::int32_t Call::integer(int i) const {
  const Scalar s = scalar(i);
  if (s.unit() != Unit::none)
    warn(codes::gcmc_unit, fmt::format("{}() argument {} has units attached", name, i + 1));
  return to_integer(s);
}

bool Call::truth(int i) const { return kerf::gcmc::truth(arguments[i]); }

std::string joined_text(const Call& call) {
  std::string text;
  for (int i = 0; i < call.count; ++i) append_text(text, call[i], call.vm.decimals);
  return text;
}

}  // namespace kerf::gcmc
