// Origins: their text form and the compact table.
#include "kerf/base/origin.h"

#include <cassert>
#include <fmt/format.h>
#include <utility>

#include "base/names.h"
#include "base/number.h"

namespace kerf {
namespace {

std::string text_of(const TextLocation& where) {
  if (where.line == 0) return where.file;
  if (where.column == 0) return fmt::format("{}:{}", where.file, where.line);
  return fmt::format("{}:{}:{}", where.file, where.line, where.column);
}

std::string text_of(const DrawingLocation& where) {
  std::string text = fmt::format("{}: layer {}", where.file, clipped(where.layer));
  if (!where.entity.empty() || !where.handle.empty()) {
    text += fmt::format(", {}", where.entity.empty() ? "handle" : where.entity);
    if (!where.handle.empty()) text += " " + where.handle;
  }
  return text + fmt::format(", at {}, {}", number_text(where.x, 3), number_text(where.y, 3));
}

std::string text_of(const CallLocation& where) {
  if (where.file.empty()) return where.call;
  return fmt::format("{}:{} ({})", where.file, where.line, where.call);
}

std::string text_of(std::monostate) { return {}; }

}  // namespace

std::string to_string(const Origin& origin) {
  return std::visit([](const auto& where) { return text_of(where); }, origin);
}

OriginTable::OriginTable() : records_(1) {}

std::uint32_t OriginTable::file(std::string_view name) {
  auto [it, is_new] = file_index_.try_emplace(std::string(name), static_cast<std::uint32_t>(files_.size()));
  if (is_new) files_.emplace_back(name);
  return it->second;
}

void OriginTable::rename_file(std::uint32_t index, const std::string& name) {
  assert(index < files_.size() && (name == files_[index] || file_index_.count(name) == 0));
  const std::string old = std::exchange(files_[index], name);
  file_index_.erase(old);
  file_index_[name] = index;
  for (DrawingLocation& at : dxf_)
    if (at.file == old) at.file = name;
}

OriginId OriginTable::text(std::uint32_t file, std::uint32_t line, std::uint32_t column) {
  assert(file < files_.size());
  records_.push_back({file, line, column, Kind::text});
  return static_cast<OriginId>(records_.size() - 1);
}

OriginId OriginTable::add(const Origin& origin) {
  if (const auto* where = std::get_if<TextLocation>(&origin))
    return text(file(where->file), where->line, where->column);
  if (const auto* where = std::get_if<DrawingLocation>(&origin)) {
    dxf_.push_back(*where);
    records_.push_back({file(where->file), static_cast<std::uint32_t>(dxf_.size() - 1), 0, Kind::dxf});
    return static_cast<OriginId>(records_.size() - 1);
  }
  if (const auto* where = std::get_if<CallLocation>(&origin)) {
    auto [it, is_new] = call_index_.try_emplace(where->call, static_cast<std::uint32_t>(calls_.size()));
    if (is_new) calls_.push_back(where->call);
    records_.push_back({file(where->file), where->line, it->second, Kind::call});
    return static_cast<OriginId>(records_.size() - 1);
  }
  return OriginId::none;
}

OriginId OriginTable::add_again(OriginId id) {
  assert(static_cast<std::size_t>(id) < records_.size());
  records_.push_back(Record(records_[static_cast<std::size_t>(id)]));
  return static_cast<OriginId>(records_.size() - 1);
}

void OriginTable::set_caller(OriginId inner, OriginId caller) {
  assert(static_cast<std::size_t>(inner) < records_.size() &&
         static_cast<std::size_t>(caller) < records_.size());
  callers_[static_cast<std::uint32_t>(inner)] = caller;
}

Origin OriginTable::resolve(OriginId id) const {
  assert(static_cast<std::size_t>(id) < records_.size());
  const Record& r = records_[static_cast<std::size_t>(id)];
  switch (r.kind) {
    case Kind::text: return TextLocation{files_[r.file], r.line, r.column};
    case Kind::dxf: return dxf_[r.line];
    case Kind::call: return CallLocation{files_[r.file], r.line, calls_[r.column]};
    case Kind::none: break;
  }
  return std::monostate{};
}

std::vector<Origin> OriginTable::callers(OriginId id) const {
  std::vector<Origin> chain;
  for (auto it = callers_.find(static_cast<std::uint32_t>(id)); it != callers_.end();
       it = callers_.find(static_cast<std::uint32_t>(it->second))) {
    chain.push_back(resolve(it->second));
    if (chain.size() > callers_.size()) break;  // a cycle
  }
  return chain;
}

std::uint32_t OriginTable::line(OriginId id) const {
  const Record& r = records_[static_cast<std::size_t>(id)];
  return r.kind == Kind::text || r.kind == Kind::call ? r.line : 0;
}

}  // namespace kerf
