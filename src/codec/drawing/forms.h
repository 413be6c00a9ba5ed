// The forms of drawing files: the text around the shapes, and the format of handles and numbers. The default
// forms are those of write_dxf() and write_svg(); other forms reproduce the files of another program.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "kerf/drawing/drawing_files.h"

namespace kerf::drawings {

/// shortest: as few digits as give the number to the form's decimals; fixed: all decimals.
enum class Decimals : std::uint8_t { shortest, fixed };

/// Whether the angles of arcs are normalised to less than a full turn.
enum class DxfAngles : std::uint8_t { below_a_turn, as_given };

/// Texts of group codes with their values ("0 LINE|5 {HANDLE}"), '|' or a line end between them. Values in
/// braces are filled in: {UNITS}, {LAYER_COUNT}, {LAYERS} (the records of all layers, without a group code),
/// {LAYER}, {HANDLE}, {TYPE} and {SUBCLASS}.
struct DxfForm {
  std::string_view head;    // up to the first entity
  std::string_view tail;    // after the last entity
  std::string_view layer;   // the record of a layer
  std::string_view entity;  // the start of an entity
  bool arc_marker = true;   // arcs have a subclass marker before their angles
  DxfAngles angles = DxfAngles::below_a_turn;
  Decimals decimals = Decimals::shortest;
  int digits = 10;
  /// The handle of layer number `index` from 0, and of entity number `count` from 1.
  std::function<std::string(std::size_t index)> layer_handle;
  std::function<std::string(std::size_t count)> entity_handle;
};

/// Lines, arcs and circles only.
std::string write_dxf(const Drawing& drawing, const DxfForm& form);

/// Whether y points down in the numbers, or by a transform of the groups.
enum class SvgY : std::uint8_t { turned, as_drawn };

struct SvgForm {
  std::string head;  // up to the first group
  /// The start of a layer's group; if empty, the layer is not written.
  std::function<std::string(std::size_t layer)> group;
  /// The attributes of path number `count` from 1, which is entity number `entity`, before its data.
  std::function<std::string(std::size_t entity, std::size_t count)> attributes;
  SvgY y = SvgY::turned;
  Decimals decimals = Decimals::shortest;
  int digits = 6;
  std::string_view command_gap = "";  // between a command's letter and its numbers
  std::string_view flag_gap = " ";    // between the two flags of an arc
};

std::string write_svg(const Drawing& drawing, const SvgForm& form);

}  // namespace kerf::drawings
