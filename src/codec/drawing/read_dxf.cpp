// The sections of a DXF file: header, tables and blocks; entities are read in read_dxf_entities.cpp.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/drawing/dxf_reader.h"

namespace kerf::dxf {
namespace {

constexpr std::string_view kVersions[] = {"AC1006", "AC1009", "AC1012", "AC1014", "AC1015",
                                          "AC1018", "AC1021", "AC1024", "AC1027", "AC1032"};
constexpr std::string_view kFirstUtf8 = "AC1021";  // R2007

/// Whether the first non-blank line is a group code.
bool starts_like_dxf(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n", bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  if (first == std::string_view::npos) return false;
  const std::string_view line = bytes.substr(first, bytes.find_first_of("\r\n", first) - first);
  const std::size_t digits = line.find_first_not_of("0123456789");
  return digits > 0 && (digits == std::string_view::npos ||
                        line.find_first_not_of(" \t", digits) == std::string_view::npos);
}

/// A hint for a file that is not DXF, by its first bytes.
std::string_view hint_for(std::string_view bytes) {
  if (bytes.starts_with("AC10")) return "this is a DWG file; save the drawing as DXF";
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    return "the file is UTF-16; DXF is ASCII, UTF-8 or binary";
  if (bytes.starts_with("<")) return "this looks like XML or SVG; save the drawing as DXF";
  return "a DXF file starts with the lines 0 and SECTION";
}

/// Appends a row with a name to a table and returns its index.
template <class Row>
std::uint32_t add_row(std::vector<Row>& table, std::string name) {
  table.emplace_back().name = std::move(name);
  return static_cast<std::uint32_t>(table.size() - 1);
}

}  // namespace

std::string folded(std::string_view name) {
  std::string made(name);
  for (char& c : made)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return made;
}

DxfReader::DxfReader(std::string_view bytes, const std::string& file, Diagnostics& diagnostics,
                     Progress* progress)
    : tags_(bytes, file, diagnostics, progress) {
  drawing_.file = file;
  drawing_.binary = tags_.binary();
  add_row(drawing_.layers, "0");
  layers_.insert("0", kLayerZero);
  for (const char* name : {"ByLayer", "ByBlock", "Continuous"}) {
    linetypes_.insert(name, add_row(drawing_.linetypes, name));
  }
  styles_.insert("Standard", add_row(drawing_.styles, "Standard"));
  drawing_.extrusions.push_back({0.0, 0.0, 1.0});
  extrusions_.emplace(std::array<double, 3>{0.0, 0.0, 1.0}, 0u);
}

Diagnostic& DxfReader::warn_structure(const std::string& message) {
  return tags_.warning(codes::dxf_structure, tags_.value_position(), message);
}

// --------------------------------------------------------------------------------------------------- names

std::uint32_t DxfReader::layer_index(std::string_view raw) {
  return layers_.find(raw, decoder_,
                      [&](std::string name) { return add_row(drawing_.layers, std::move(name)); });
}

std::uint32_t DxfReader::linetype_index(std::string_view raw) {
  return linetypes_.find(raw, decoder_,
                         [&](std::string name) { return add_row(drawing_.linetypes, std::move(name)); });
}

std::uint32_t DxfReader::style_index(std::string_view raw) {
  return styles_.find(raw, decoder_,
                      [&](std::string name) { return add_row(drawing_.styles, std::move(name)); });
}

std::uint32_t DxfReader::block_index(std::string_view raw) {
  return blocks_.find(raw, decoder_, [&](std::string name) {
    first_use_.push_back(0);
    return add_row(drawing_.blocks, std::move(name));
  });
}

// ------------------------------------------------------------------------------------------------- sections

std::optional<Drawing> DxfReader::read() {
  while (!end_of_file_ && tags_.next()) {
    if (tags_.group() != 0) {
      warn_structure(fmt::format("group {} outside of a section; skipped", tags_.group()));
      skip_tags();
    } else if (tags_.text() == "SECTION") {
      section();
    } else if (tags_.text() == "EOF") {
      end_of_file_ = true;
    } else if (tags_.text() == "ENDSEC" || tags_.text() == "ENDBLK" || tags_.text() == "ENDTAB") {
      warn_structure(fmt::format("{} without its start; skipped", tags_.text()));
    } else if (tags_.text() == "BLOCK") {
      warn_structure("BLOCK outside of a section");
      block();
    } else {
      warn_structure(fmt::format("{} outside of a section; read as an entity", tags_.text()));
      tags_.repeat();
      entities(drawing_.entities);
    }
  }
  if (tags_.stopped()) return std::nullopt;
  if (sections_ == 0 && drawing_.entities.empty()) {
    tags_.error(codes::dxf_not_dxf, 0, "the file has no section and no entity");
    return std::nullopt;
  }
  if (!end_of_file_)
    tags_
        .warning(codes::dxf_truncated, tags_.position(),
                 fmt::format("the file ends without EOF ({})", tags_.position_text(tags_.position())))
        .hint = "the file may be cut off; export it again";
  if (decoder_.faulty_texts() > 0)
    tags_.warning(
        codes::dxf_encoding, 0,
        fmt::format("{} texts or names have characters that do not exist in {}; they read as U+FFFD",
                    decoder_.faulty_texts(), encoding_));
  check_blocks();
  find_repeated_handles();
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    for (std::size_t group = 0; group < unused_[kind].size(); ++group)
      if (unused_[kind][group] > 0)
        drawing_.unused_tags.push_back(
            {name_of(static_cast<Kind>(kind)), static_cast<int>(group), unused_[kind][group]});
  drawing_.comments = tags_.comments();
  return std::move(drawing_);
}

void DxfReader::section() {
  ++sections_;
  if (!tags_.next()) return;
  if (tags_.group() != 2) {
    warn_structure("a section without its name; skipped");
    if (tags_.group() == 0) tags_.repeat();
    return skip_section();
  }
  const std::string_view name = tags_.text();
  if (name == "HEADER" && !drawing_.header.empty()) {
    warn_structure("a second section HEADER; skipped");
    return skip_section();
  }
  if (name == "HEADER") {
    header();
  } else if (name == "TABLES") {
    tables();
  } else if (name == "BLOCKS") {
    blocks();
  } else if (name == "ENTITIES") {
    entities(drawing_.entities);
  } else {
    return skip_section();
  }
  end_section(name);
}

void DxfReader::end_section(std::string_view name) {
  if (!tags_.next()) return;
  if (tags_.is(0, "ENDSEC")) return;
  warn_structure(fmt::format("section {} ends without ENDSEC", name));
  tags_.repeat();
}

void DxfReader::skip_section() {
  while (tags_.next()) {
    if (tags_.group() != 0) continue;
    if (tags_.text() == "ENDSEC") return;
    if (tags_.text() == "SECTION" || tags_.text() == "EOF") return tags_.repeat();
  }
}

/// Skips to the next group code 0.
void DxfReader::skip_tags() {
  while (tags_.next())
    if (tags_.group() == 0) return tags_.repeat();
}

void DxfReader::header() {
  std::vector<HeaderVariable>& variables = drawing_.header;
  while (tags_.next() && tags_.group() != 0) {
    if (tags_.group() == 9)
      variables.push_back({std::string(tags_.text()), {}});
    else if (!variables.empty())
      variables.back().values.emplace_back(tags_.group(), tags_.value_text());
  }
  if (tags_.group() == 0) tags_.repeat();
  for (const HeaderVariable& variable : variables) {
    if (variable.values.empty()) continue;
    const auto& [group, value] = variable.values.front();
    if (variable.name == "$ACADVER") drawing_.version = trim(value);
    if (variable.name == "$DWGCODEPAGE") drawing_.code_page = trim(value);
    if (variable.name != "$INSUNITS") continue;
    const auto number = parse_number(trim(value));
    if (number && *number >= 0.0 && *number <= 100.0) drawing_.unit = static_cast<int>(*number);
  }
  use_encoding();
  for (HeaderVariable& variable : variables)
    for (auto& [group, value] : variable.values) value = decoder_.decode(value);
}

void DxfReader::use_encoding() {
  const bool known =
      std::find(std::begin(kVersions), std::end(kVersions), drawing_.version) != std::end(kVersions);
  if (!known && !drawing_.version.empty())
    tags_.warning(codes::dxf_version, 0,
                  fmt::format("unknown version {}; read as {}", drawing_.version, kVersions[9]));
  if (drawing_.version >= kFirstUtf8) {
    decoder_.use(kUtf8);
    encoding_ = "UTF-8";
    return;
  }
  if (drawing_.code_page.empty()) return;
  const auto page = code_page_number(drawing_.code_page);
  if (page && decoder_.use(*page)) {
    encoding_ = drawing_.code_page;
    return;
  }
  tags_.warning(
      codes::dxf_encoding, 0,
      fmt::format("unknown code page {}; texts are read as UTF-8 or ANSI_1252", drawing_.code_page));
}

void DxfReader::tables() {
  while (tags_.next()) {
    if (tags_.group() != 0) continue;
    const std::string_view name = tags_.text();
    if (name == "LAYER") {
      layer_record();
    } else if (name == "LTYPE") {
      linetype_record();
    } else if (name == "STYLE") {
      style_record();
    } else if (name == "ENDSEC" || name == "SECTION" || name == "EOF") {
      return tags_.repeat();
    }
  }
}

void DxfReader::layer_record() {
  Layer layer;
  layer.declared = true;
  std::optional<std::uint32_t> index;
  while (tags_.next() && tags_.group() != 0) {
    switch (tags_.group()) {
      case 2:
        index = layer_index(tags_.text());
        layer.name = text_value();
        break;
      case 6: layer.linetype = linetype_index(tags_.text()); break;
      case 62: {
        const int colour = tags_.integer().value_or(7);
        layer.off = colour < 0;
        layer.colour = colour == 0 || colour < -255 || colour > 255 ? 7 : std::abs(colour);
        break;
      }
      case 70: {
        const int flags = tags_.integer().value_or(0);
        layer.frozen = (flags & 1) != 0;
        layer.locked = (flags & 4) != 0;
        break;
      }
      case 290: layer.plotted = tags_.integer().value_or(1) != 0; break;
      case 420: layer.true_colour = tags_.integer().value_or(kNoTrueColour); break;
      default: break;
    }
  }
  if (tags_.group() == 0) tags_.repeat();
  if (!index) return;
  if (drawing_.layers[*index].declared)
    warn_structure(fmt::format("layer \"{}\" is declared twice; the first declaration is used", layer.name));
  else
    drawing_.layers[*index] = std::move(layer);
}

void DxfReader::linetype_record() {
  Linetype linetype;
  linetype.declared = true;
  std::optional<std::uint32_t> index;
  while (tags_.next() && tags_.group() != 0) {
    if (tags_.group() == 2) {
      index = linetype_index(tags_.text());
      linetype.name = text_value();
    } else if (tags_.group() == 3) {
      linetype.description = text_value();
    } else if (tags_.group() == 49) {
      linetype.pattern.push_back(tags_.number().value_or(0.0));
    }
  }
  if (tags_.group() == 0) tags_.repeat();
  if (index && !drawing_.linetypes[*index].declared) drawing_.linetypes[*index] = std::move(linetype);
}

void DxfReader::style_record() {
  TextStyle style;
  style.declared = true;
  std::optional<std::uint32_t> index;
  while (tags_.next() && tags_.group() != 0) {
    switch (tags_.group()) {
      case 2:
        if (tags_.text().empty()) break;  // the style of a shape file
        index = style_index(tags_.text());
        style.name = text_value();
        break;
      case 3: style.font = text_value(); break;
      case 40: style.height = tags_.number().value_or(0.0); break;
      case 41: style.width_factor = tags_.number().value_or(1.0); break;
      default: break;
    }
  }
  if (tags_.group() == 0) tags_.repeat();
  if (index && !drawing_.styles[*index].declared) drawing_.styles[*index] = std::move(style);
}

void DxfReader::blocks() {
  while (tags_.next()) {
    if (tags_.group() != 0) continue;
    const std::string_view name = tags_.text();
    if (name == "BLOCK") {
      block();
    } else if (name == "ENDSEC" || name == "SECTION" || name == "EOF") {
      return tags_.repeat();
    } else if (name == "ENDBLK") {
      warn_structure("ENDBLK without BLOCK; skipped");
    } else {
      warn_structure(fmt::format("{} outside of a block; skipped", name));
    }
  }
}

void DxfReader::block() {
  constexpr int kExternal = 4;
  Block block;
  block.declared = true;
  const std::size_t position = tags_.position();
  std::optional<std::uint32_t> index;
  fields_.clear();
  while (tags_.next() && tags_.group() != 0) {
    const int group = tags_.group();
    if (group == 2) {
      index = block_index(tags_.text());
      block.name = text_value();
    } else if (group == 1) {
      block.file = text_value();
    } else if (group == 10 || group == 20 || group == 30 || group == 70) {
      if (const auto value = tags_.number()) fields_.set(group, *value);
    } else if (group == 102) {
      skip_application_data();
    }
  }
  block.base = fields_.point(10);
  block.external = (fields_.integer(70, 0) & kExternal) != 0;
  if (tags_.group() == 0) tags_.repeat();
  entities(block.entities);
  if (tags_.next()) {
    if (tags_.is(0, "ENDBLK")) {
      skip_tags();
    } else {
      warn_structure(fmt::format("block \"{}\" ends without ENDBLK", block.name));
      tags_.repeat();
    }
  }
  const std::string key = folded(block.name);
  const bool paper = key.starts_with("*PAPER_SPACE") || key.starts_with("$PAPER_SPACE");
  if (paper || key == "*MODEL_SPACE" || key == "$MODEL_SPACE") {
    for (Entity& entity : block.entities) entity.paper = paper;
    std::move(block.entities.begin(), block.entities.end(), std::back_inserter(drawing_.entities));
    block.entities.clear();
  }
  if (!index)
    tags_.warning(codes::dxf_structure, position, "a block without a name; skipped");
  else if (drawing_.blocks[*index].declared)
    tags_.warning(codes::dxf_structure, position,
                  fmt::format("block \"{}\" is declared twice; the first declaration is used", block.name));
  else
    drawing_.blocks[*index] = std::move(block);
}

void DxfReader::check_blocks() {
  for (std::size_t i = 0; i < drawing_.blocks.size(); ++i)
    if (!drawing_.blocks[i].declared)
      tags_.warning(codes::dxf_block, first_use_[i],
                    fmt::format("block \"{}\" is inserted, but not in the file", drawing_.blocks[i].name));
}

/// In most files handles ascend; otherwise they are sorted first.
void DxfReader::find_repeated_handles() {
  struct Use {
    std::uint64_t handle;
    std::size_t position;
  };
  std::vector<Use> uses;
  bool ascending = true;
  std::uint64_t last = 0;
  const auto for_all = [&](auto visit) {
    for (const Block& block : drawing_.blocks)
      for (const Entity& entity : block.entities) visit(entity);
    for (const Entity& entity : drawing_.entities) visit(entity);
  };
  for_all([&](const Entity& entity) {
    ascending = ascending && (entity.handle == 0 || entity.handle > last);
    last = std::max(last, entity.handle);
  });
  if (ascending) return;
  for_all([&](const Entity& entity) {
    if (entity.handle != 0) uses.push_back({entity.handle, entity.position});
  });
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return a.handle != b.handle ? a.handle < b.handle : a.position < b.position;
  });
  const Use* first = nullptr;
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].handle != uses[i - 1].handle) continue;
    ++drawing_.repeated_handles;
    if (first == nullptr || uses[i].position < first[1].position) first = &uses[i - 1];
  }
  if (first == nullptr) return;
  tags_.warning(
      codes::dxf_handle_repeated, first[1].position,
      fmt::format("handle {} is already used at {} ({} repeated handles in all)", handle_text(first->handle),
                  tags_.position_text(first[0].position), drawing_.repeated_handles));
}

std::optional<Drawing> read_dxf(std::string_view bytes, const std::string& file_name,
                                Diagnostics& diagnostics, Progress* progress) {
  if (!bytes.starts_with("AutoCAD Binary DXF") && !starts_like_dxf(bytes)) {
    const bool empty = bytes.find_first_not_of(" \t\r\n") == std::string_view::npos;
    diagnostics
        .error(codes::dxf_not_dxf, TextLocation{file_name, 0, 0},
               empty ? "the file is empty" : "not a DXF file")
        .hint = empty ? "" : hint_for(bytes);
    return std::nullopt;
  }
  return DxfReader(bytes, file_name, diagnostics, progress).read();
}

}  // namespace kerf::dxf
