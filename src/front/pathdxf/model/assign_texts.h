// Which element of a path layer a parameter text belongs to.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "front/pathdxf/model/drawing.h"
#include "front/pathdxf/text/text_circle.h"
#include "geom/base/box_tree.h"

namespace kerf::pathdxf {

/// The elements of one layer that may take a text. Each takes one only.
class TextTargets {
 public:
  /// Adds an element by its number; its position must stay valid.
  void add(const Element& element, std::size_t number);
  /// The number of the free element that overlaps the circle, which is then taken: of circles the one with
  /// the nearest centre; if there are none, of arcs; if there are none, of lines the nearest.
  std::optional<std::size_t> take(const TextCircle& text);

 private:
  struct Target {
    const Element* element;
    std::size_t number;
    bool taken = false;
  };
  /// Those of one shape.
  struct Group {
    std::vector<Target> targets;
    std::optional<BoxTree> tree;
  };
  static std::optional<std::size_t> take_of(Group& group, const TextCircle& text);

  Group circles_, arcs_, lines_;
};

}  // namespace kerf::pathdxf
