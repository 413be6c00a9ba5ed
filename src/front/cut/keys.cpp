// The rows of all operations, and their keys together as options of the command.
#include <algorithm>
#include <fmt/format.h>

#include "base/names.h"
#include "op/laser/rows.h"
#include "op/mesh/rows.h"
#include "op/mill/rows.h"

#include "kerf/program/cut_job.h"

namespace kerf {

const std::vector<CutRow>& cut_rows() {
  static const std::vector<CutRow> rows = [] {
    std::vector<CutRow> all = op_detail::mill_rows();
    for (auto& room : {op_detail::mesh_rows(), op_detail::laser_rows()})
      all.insert(all.end(), room.begin(), room.end());
    return all;
  }();
  return rows;
}

const CutRow* cut_row(std::string_view name) {
  for (const CutRow& row : cut_rows())
    if (fold_name(row.name) == fold_name(name)) return &row;
  return nullptr;
}

std::vector<std::string> cut_operation_names() {
  std::vector<std::string> names;
  for (const CutRow& row : cut_rows()) names.emplace_back(row.name);
  return names;
}

namespace {

/// The default of a key, as text; empty: it has none.
std::string default_of(const CutRow& row, const CutKey& key) {
  if (key.required) return {};
  if (!key.otherwise.empty()) return std::string(key.otherwise);
  const auto value = key.get(row.operation());
  if (!value) return {};
  if (const double* number = std::get_if<double>(&*value)) return fmt::format("{:.6g}", *number);
  const auto* text = std::get_if<std::string>(&*value);
  return text != nullptr ? *text : std::string();
}

/// Texts with the operations that they hold for, where they differ.
class Texts {
 public:
  void add(std::string_view operation, const std::string& text) {
    const auto known =
        std::find_if(rows_.begin(), rows_.end(), [&](const auto& row) { return row.first == text; });
    if (known == rows_.end())
      rows_.emplace_back(text, operation);
    else
      known->second += fmt::format(", {}", operation);
  }
  /// `form`: of a text and operations.
  std::string joined(const char* form) const {
    std::string all;
    for (const auto& [text, operations] : rows_) {
      if (text.empty()) continue;
      const bool first = &text == &rows_.front().first;
      all += (all.empty() ? "" : "; ") + (first ? text : fmt::format(fmt::runtime(form), text, operations));
    }
    return all;
  }

 private:
  std::vector<std::pair<std::string, std::string>> rows_;  // text, operations
};

}  // namespace

const std::vector<CutOption>& cut_options() {
  static const std::vector<CutOption> options = [] {
    std::vector<CutOption> made;
    std::vector<std::pair<Texts, Texts>> texts;
    for (const CutRow& row : cut_rows())
      for (const CutKey& key : row.keys) {
        const auto known = std::find_if(made.begin(), made.end(),
                                        [&](const CutOption& o) { return o.key->name == key.name; });
        const std::size_t at = static_cast<std::size_t>(known - made.begin());
        if (known == made.end()) made.push_back({&row, &key, {}, {}}), texts.emplace_back();
        texts[at].first.add(row.name, std::string(key.meaning));
        texts[at].second.add(row.name, default_of(row, key));
      }
    for (std::size_t i = 0; i < made.size(); ++i)
      made[i].meaning = texts[i].first.joined("{1}: {0}"),
      made[i].usual = texts[i].second.joined("{0} for {1}");
    return made;
  }();
  return options;
}

}  // namespace kerf
