// Numbers of a job that depend on its stock: their names, and their values once the stock is known.
#include "front/cut/formulas.h"

#include <array>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/quantity.h"

namespace kerf {
namespace {

using StockValues = std::array<std::pair<std::string_view, double>, 9>;

StockValues values_of(const Box3& box) {
  const Point3 size = box.high - box.low;
  return {{{"stock.x", size.x},
           {"stock.y", size.y},
           {"stock.z", size.z},
           {"stock.left", box.low.x},
           {"stock.right", box.high.x},
           {"stock.front", box.low.y},
           {"stock.back", box.high.y},
           {"stock.bottom", box.low.z},
           {"stock.top", box.high.z}}};
}

std::optional<double> value_of(std::string_view name, const Box3& box) {
  for (const auto& [known, value] : values_of(box))
    if (known == name) return value;
  return std::nullopt;
}

/// The depth of an operation that goes through the stock.
void resolve_through(CutOperation& operation, const std::optional<Box3>& stock, Diagnostics& diagnostics) {
  const auto refuse = [&](const char* why) -> Diagnostic& {
    return diagnostics.error(codes::cut_job_key, operation.where,
                             fmt::format("{}: through {}", operation.name, why));
  };
  if (!stock) {
    refuse("needs the stock, and the job has none").hint = "stock = \"100x60x12\"";
    return;
  }
  const double top = number_of(operation, "top").value_or(0.0);
  const double depth = top - stock->low.z + operation.through->mm();
  if (!(depth > 0.0))
    refuse("needs a top above the bottom of the stock");
  else
    set_number(operation, "depth", depth);
}

}  // namespace

namespace cut_detail {

bool needs_stock(const CutKeyText& key, const CutValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr && key.is_number() && text->find("stock") != std::string::npos;
}

std::string stock_fault(const CutKeyText& key, const CutValue& value) {
  std::string fault;
  const auto any = [](std::string_view name) { return value_of(name, {{0, 0, 0}, {1, 1, 1}}); };
  const std::string& text = std::get<std::string>(value);
  if (read_quantity(text, key.unit, any, fault)) return {};
  // A division by what is 0 here need not be one by 0 there.
  return fault.ends_with("is not finite") ? std::string() : "; " + fault;
}

std::string with_stock(std::string text, const Box3& stock) {
  const auto continues = [](char c) { return (c >= 'a' && c <= 'z') || c == '.' || c == '_'; };
  for (const auto& [name, value] : values_of(stock)) {
    const std::string number = fmt::format("({:.17g}mm)", value);
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) {
      const std::size_t end = at + name.size();
      const bool whole =
          (end == text.size() || !continues(text[end])) && (at == 0 || !continues(text[at - 1]));
      if (whole) text.replace(at, name.size(), number);
      at += whole ? number.size() : name.size();
    }
  }
  return text;
}

}  // namespace cut_detail

bool resolve_formulas(CutJob& job, const std::optional<Box3>& stock, Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  for (const CutFormula& formula : job.formulas) {
    const CutKey& key = *formula.key;
    CutOperation& operation = job.operations[formula.operation];
    if (!stock) {
      diagnostics
          .error(codes::cut_job_key, formula.where,
                 fmt::format("{} = \"{}\" needs the stock, and the job has none", key.name, formula.text))
          .hint = "stock = \"100x60x12\"";
      continue;
    }
    std::string fault;
    const auto value = read_quantity(
        formula.text, key.unit, [&](std::string_view name) { return value_of(name, *stock); }, fault);
    if (value && key.set(operation, *value)) continue;
    if (value) fault = fmt::format("\"{}\" is {:g}", formula.text, *value);
    diagnostics.error(codes::cut_job_key, formula.where,
                      fmt::format("{} must be {}; {}", key.name, rule_of(key), fault));
  }
  job.formulas.clear();
  job.stock_box = stock;
  for (CutOperation& operation : job.operations)
    if (operation.through) resolve_through(operation, stock, diagnostics);
  return diagnostics.errors() == errors;
}

}  // namespace kerf
