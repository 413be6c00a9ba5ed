// What is common to the rows of all operations.
#include "kerf/op/rows.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/names.h"
#include "base/quantity.h"

namespace kerf {
namespace {

/// " above 0", " from 15 to 90"; empty: any number.
std::string text_of(const CutRange& range) {
  const bool below = std::isfinite(range.high);
  if (!std::isfinite(range.low)) return below ? fmt::format(" of at most {}", range.high) : std::string();
  if (range.above && below) return fmt::format(" above {} and at most {}", range.low, range.high);
  if (range.above) return fmt::format(" above {}", range.low);
  return below ? fmt::format(" from {} to {}", range.low, range.high)
               : fmt::format(" of {} or more", range.low);
}

}  // namespace

std::string text_of(const CutValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return fmt::format("\"{}\"", clipped(*text, 60));
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:g}", *number);
  return "a list";
}

std::string rule_of(const CutKeyText& key) {
  using Type = CutKeyText::Type;
  switch (key.type) {
    case Type::list: return "a list of texts";
    case Type::text: return "a text";
    case Type::point: return "a point, as [x, y] in mm";
    case Type::choice: return "one of: " + joined(key.choices, ", ");
    case Type::tool: return "the number of a tool";
    case Type::whole: return "a whole number" + text_of(key.range);
    case Type::number: break;
  }
  return (key.unit.empty() ? "a number" : fmt::format("a number in {}", key.unit)) + text_of(key.range);
}

std::string fault_of(const CutKeyText& key, const CutValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  std::string fault;
  if (text == nullptr || !key.is_number()) return {};
  if (const auto number = read_quantity(*text, key.unit, {}, fault))
    fault = fmt::format("{} is {:g}", text_of(value), *number);
  return "; " + fault;
}

std::vector<Outline> CutWork::outlines() const {
  std::vector<Outline> all = closed;
  all.insert(all.end(), open.begin(), open.end());
  return all;
}

const Tool* CutWork::tool_of(int number, Diagnostics& diagnostics) const {
  if (const auto found = tools.find(number); found != tools.end()) return &found->second;
  diagnostics
      .error(codes::cut_job_key, operation.where,
             fmt::format("{}: tool {} has no shape", operation.name, number))
      .hint = fmt::format("[tools]\n{} = \"square d=6\"", number);
  return nullptr;
}

const CutKey* CutRow::key(std::string_view of_name) const {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const CutKey& k) { return k.name == of_name; });
  return found == keys.end() ? nullptr : &*found;
}

CutOperation CutRow::operation() const {
  CutOperation made;
  made.row = this;
  made.options = options();
  return made;
}

std::optional<double> number_of(const CutOperation& operation, std::string_view name) {
  const CutKey* key = operation.row->key(name);
  const auto value = key != nullptr ? key->get(operation) : std::nullopt;
  const double* number = value ? std::get_if<double>(&*value) : nullptr;
  return number != nullptr ? std::optional(*number) : std::nullopt;
}

void set_number(CutOperation& operation, std::string_view name, double value) {
  if (const CutKey* key = operation.row->key(name)) key->set(operation, value);
}

}  // namespace kerf
