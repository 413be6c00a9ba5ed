// The parameters of one element.
#include "front/pathdxf/model/values.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "front/pathdxf/text/nearly.h"

#include "kerf/base/limits.h"

namespace kerf::pathdxf {
namespace {

constexpr Bilingual kUnsupported{"Unsupported {} value; {}", "{}-Wert nicht unterstützt; {}"};
constexpr Bilingual kSupported{"parameters of this element: {}", "Parameter dieses Elements: {}"};
constexpr Bilingual kUndefined{"Variable {} in '{}' is not defined, or has no value",
                               "Variable {} in '{}' ist nicht definiert oder hat keinen Wert"};
constexpr Bilingual kUndefinedHint{
    "define it at the start of the path as :{}VALUES; its value is given where the path is embedded",
    "Sie wird am Start des Pfades mit :{}WERTE definiert; ihren Wert gibt die Einbettung des Pfades an"};
constexpr Bilingual kEndless{"The variables of '{}' refer to each other",
                             "Die Variablen in '{}' verweisen aufeinander"};
constexpr Bilingual kNoNumber{"{} value '{}' is not a number; text '{}' on layer {}",
                              "{}-Wert '{}' ist keine Zahl; Text '{}' auf Layer {}"};
constexpr Bilingual kPositive{"{}={} must be > 0", "{}={} muss > 0 sein"};
constexpr Bilingual kBeyond{"{}={} is beyond {}", "{}={} liegt jenseits von {}"};
constexpr Bilingual kMissing{"{} value missing", "{}-Wert fehlt"};

/// "MTEXT @ [0.000 0.000]"
std::string position_of(const Origin& where) {
  const auto* at = std::get_if<DrawingLocation>(&where);
  return at == nullptr ? to_string(where) : fmt::format("{} @ [{:.3f} {:.3f}]", at->entity, at->x, at->y);
}

}  // namespace

Values::Values(const ParameterText* text, std::string_view keys, const Variables& variables, Origin where,
               Report& report)
    : where_(std::move(where)), report_(report) {
  if (text == nullptr) return;
  text_ = text->text;
  if (const auto* at = std::get_if<DrawingLocation>(&text->where)) layer_ = at->layer;
  for (const Parameter& p : text->values) {
    if (p.key.size() != 1 || keys.find(p.key[0]) == std::string_view::npos) {
      report_.error(codes::pathdxf_key, where_, kUnsupported, p.key, position_of(text->where));
      report_.hint(kSupported, keys);
      continue;
    }
    values_.push_back({p.key, replaced(p.value, *text, variables)});
  }
  const bool takes_variables = keys.find(':') != std::string_view::npos;
  for (const Parameter& p : text->variables) {
    if (!takes_variables) {
      report_.error(codes::pathdxf_key, where_, kUnsupported, ":", position_of(text->where));
      break;
    }
    variables_.push_back({p.key, replaced(p.value, *text, variables)});
  }
}

std::string Values::replaced(std::string_view value, const ParameterText& text,
                             const Variables& variables) const {
  std::string unknown;
  const auto out = replace_variables(value, variables, unknown);
  if (!out) report_.error(codes::pathdxf_variable, text.where, kEndless, text.text);
  if (!unknown.empty()) {
    report_.error(codes::pathdxf_variable, where_, kUndefined, unknown, text.text);
    report_.hint(kUndefinedHint, unknown);
  }
  return out.value_or(std::string());
}

const std::string* Values::find(char key) const {
  for (const Parameter& p : values_)
    if (p.key[0] == key) return &p.value;
  return nullptr;
}

std::optional<std::string> Values::text(char key) const {
  const std::string* value = find(key);
  return value == nullptr ? std::nullopt : std::optional(*value);
}

std::optional<double> Values::number(char key) const {
  const std::string* value = find(key);
  if (value == nullptr || value->empty()) return std::nullopt;
  const auto number = parse_value(*value);
  const std::string name(1, key);
  // A variable without a value has been reported.
  if (!number && value->find('=') == std::string::npos)
    report_.error(codes::pathdxf_value_range, where_, kNoNumber, name, *value, text_, layer_);
  if (!number || std::abs(*number) <= limits::kMaxCoordinate) return number;
  report_.error(codes::pathdxf_value_range, where_, kBeyond, name, *value, limits::kMaxCoordinate);
  return std::nullopt;
}

std::optional<double> Values::positive(char key) const {
  const auto value = number(key);
  if (value && !above(*value, 0.0))
    report_.error(codes::pathdxf_value_range, where_, kPositive, std::string(1, key), *find(key));
  return value;
}

void require(const std::optional<double>& value, char key, const Origin& where, Report& report) {
  if (!value) report.error(codes::pathdxf_value_missing, where, kMissing, std::string(1, key));
}

}  // namespace kerf::pathdxf
