// The reader of DXF files: its state while it reads the sections.
#pragma once

#include <array>
#include <bitset>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "codec/drawing/code_page.h"
#include "codec/drawing/dxf_tags.h"

#include "kerf/drawing/dxf.h"

namespace kerf::dxf {

/// `name` with ASCII letters in capitals, by which names of tables are compared.
std::string folded(std::string_view name);

/// The index of each name of a table, in the file's spelling and folded.
class NameIndex {
 public:
  /// The index of a name as it is in the file; `add` is called with the decoded name for a new one and
  /// returns its index.
  template <class Add>
  std::uint32_t find(std::string_view raw, TextDecoder& decoder, Add add) {
    if (has_last_ && raw == last_raw_) return last_;
    auto found = raw_.find(std::string(raw));
    if (found == raw_.end()) {
      std::string name = decoder.decode(raw);
      const std::string key = folded(name);
      auto known = folded_.find(key);
      if (known == folded_.end()) known = folded_.emplace(key, add(std::move(name))).first;
      found = raw_.emplace(raw, known->second).first;
    }
    has_last_ = true;
    last_raw_ = raw;
    return last_ = found->second;
  }
  void insert(std::string_view name, std::uint32_t index) { folded_.emplace(folded(name), index); }

 private:
  std::unordered_map<std::string, std::uint32_t> raw_, folded_;
  std::string_view last_raw_;
  std::uint32_t last_ = 0;
  bool has_last_ = false;
};

/// The kinds of entities that are read.
enum class Kind : std::uint8_t {
  line,
  circle,
  arc,
  point,
  lwpolyline,
  polyline,
  vertex,
  text,
  attribute,
  attribute_definition,
  mtext,
  insert,
  ellipse,
  spline,
  hatch,
  solid,
  trace,
  end_of_sequence,
  other
};
inline constexpr std::size_t kKinds = 19;
std::string_view name_of(Kind kind);

/// The numbers of one entity by group code; of a code that occurs several times the last one.
class Fields {
 public:
  static constexpr int kGroups = 256;
  void clear() { present_.reset(); }
  void set(int group, double value) {
    value_[static_cast<std::size_t>(group)] = value;
    present_.set(static_cast<std::size_t>(group));
  }
  bool has(int group) const { return present_.test(static_cast<std::size_t>(group)); }
  double get(int group, double otherwise) const {
    return has(group) ? value_[static_cast<std::size_t>(group)] : otherwise;
  }
  int integer(int group, int otherwise) const;
  /// x of `group`, y and z of the codes 10 and 20 above it.
  Point point(int group) const { return {get(group, 0.0), get(group + 10, 0.0), get(group + 20, 0.0)}; }

 private:
  std::array<double, kGroups> value_;
  std::bitset<kGroups> present_;
};

class DxfReader {
 public:
  DxfReader(std::string_view bytes, const std::string& file, Diagnostics& diagnostics, Progress* progress);
  std::optional<Drawing> read();

 private:
  // Sections
  void section();
  void header();
  void use_encoding();
  void tables();
  void layer_record();
  void linetype_record();
  void style_record();
  void blocks();
  void block();
  void end_section(std::string_view name);
  void skip_section();
  void skip_tags();
  void find_repeated_handles();
  void check_blocks();

  // Entities
  void entities(std::vector<Entity>& out);
  void entity(std::vector<Entity>& out);
  template <class Hook>
  bool entity_tags(Kind kind, Entity& entity, Hook hook);
  bool common_tag(Kind kind, Entity& entity);
  bool number_tag(Kind kind);
  void skip_application_data();
  bool has_required(Kind kind, const Entity& entity);
  void simple_shape(Kind kind, Entity& entity, std::vector<Entity>& out);
  bool make_simple_shape(Kind kind, Entity& entity);
  void lwpolyline(Entity& entity, std::vector<Entity>& out);
  void polyline(Entity& entity, std::vector<Entity>& out);
  bool vertex(Polyline& polyline, double default_widths[2]);
  void text(Kind kind, Entity& entity, std::vector<Entity>& out);
  void make_text(Kind kind, Text& text);
  void insert(Entity& entity, std::vector<Entity>& out);
  void attributes(std::vector<Entity>& out);
  void spline(Entity& entity, std::vector<Entity>& out);
  void hatch(Entity& entity, std::vector<Entity>& out);
  void solid(Kind kind, Entity& entity, std::vector<Entity>& out);
  void other(std::string_view name, Entity& entity, std::vector<Entity>& out);
  std::uint32_t extrusion_of_fields();
  std::uint32_t other_type(std::string_view name, std::size_t position);
  bool refuse(const Entity& entity, Kind kind, const std::string& what);

  // Names
  std::string text_value() { return decoder_.decode(tags_.text()); }
  std::uint32_t layer_index(std::string_view raw);
  std::uint32_t linetype_index(std::string_view raw);
  std::uint32_t style_index(std::string_view raw);
  std::uint32_t block_index(std::string_view raw);
  Diagnostic& warn_structure(const std::string& message);

  TagReader tags_;
  TextDecoder decoder_;
  Drawing drawing_;
  NameIndex layers_, linetypes_, styles_, blocks_, others_;
  std::map<std::array<double, 3>, std::uint32_t> extrusions_;
  std::vector<std::size_t> first_use_;  // of each block: position of the first INSERT
  Fields fields_;
  std::array<std::vector<std::size_t>, kKinds> unused_;  // by kind and group code
  std::string raw_text_;
  std::string encoding_ = "ANSI_1252";
  std::size_t sections_ = 0;
  bool end_of_file_ = false;
};

}  // namespace kerf::dxf
