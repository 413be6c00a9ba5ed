// Origins: their text form and the compact table.
#include "kerf/origin.h"

#include <cassert>
#include <fmt/format.h>

#include "kerf/number.h"

namespace kerf {
namespace {

std::string text_of(const TextSpot& spot) {
  if (spot.line == 0) return spot.file;
  if (spot.column == 0) return fmt::format("{}:{}", spot.file, spot.line);
  return fmt::format("{}:{}:{}", spot.file, spot.line, spot.column);
}

std::string text_of(const DxfSpot& spot) {
  return fmt::format("{}: layer {}, handle {}, at {}, {}", spot.file, spot.layer, spot.handle,
                     number_text(spot.x, 3), number_text(spot.y, 3));
}

std::string text_of(const CallSpot& spot) {
  if (spot.file.empty()) return spot.call;
  return fmt::format("{}:{} ({})", spot.file, spot.line, spot.call);
}

std::string text_of(std::monostate) { return {}; }

}  // namespace

std::string to_string(const Origin& origin) {
  return std::visit([](const auto& spot) { return text_of(spot); }, origin);
}

OriginTable::OriginTable() : records_(1) {}

std::uint32_t OriginTable::file(std::string_view name) {
  auto [it, is_new] = file_index_.try_emplace(std::string(name), static_cast<std::uint32_t>(files_.size()));
  if (is_new) files_.emplace_back(name);
  return it->second;
}

OriginId OriginTable::text(std::uint32_t file, std::uint32_t line, std::uint32_t column) {
  assert(file < files_.size());
  records_.push_back({file, line, column, Kind::text});
  return static_cast<OriginId>(records_.size() - 1);
}

OriginId OriginTable::add(const Origin& origin) {
  if (const auto* spot = std::get_if<TextSpot>(&origin))
    return text(file(spot->file), spot->line, spot->column);
  if (const auto* spot = std::get_if<DxfSpot>(&origin)) {
    dxf_.push_back(*spot);
    records_.push_back({file(spot->file), static_cast<std::uint32_t>(dxf_.size() - 1), 0, Kind::dxf});
    return static_cast<OriginId>(records_.size() - 1);
  }
  if (const auto* spot = std::get_if<CallSpot>(&origin)) {
    auto [it, is_new] = call_index_.try_emplace(spot->call, static_cast<std::uint32_t>(calls_.size()));
    if (is_new) calls_.push_back(spot->call);
    records_.push_back({file(spot->file), spot->line, it->second, Kind::call});
    return static_cast<OriginId>(records_.size() - 1);
  }
  return OriginId::none;
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
    case Kind::text: return TextSpot{files_[r.file], r.line, r.column};
    case Kind::dxf: return dxf_[r.line];
    case Kind::call: return CallSpot{files_[r.file], r.line, calls_[r.column]};
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
