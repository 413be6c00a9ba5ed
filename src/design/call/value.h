// Values that the commands of the machine take and return, whatever the language of the caller.
//
// A caller makes them of its own values and back. Lengths in mm, angles in degrees.
#pragma once

#include <cassert>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kerf/geom/outline.h"

namespace kerf::design {

/// A height above each point of the plane: a surface of the machine, or a function of the caller's language.
class Surface {
 public:
  Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  virtual ~Surface() = default;
  /// Z above a point; not finite where there is none.
  virtual double height(Point2 at) const = 0;
};

/// One outline, or those of a region with its holes.
struct Outlines {
  std::vector<Outline> list;
  bool single = false;
};

/// A value of the caller's language that no command takes: its text for messages.
struct Other {
  std::string text;
};

enum class Type : unsigned char {
  unset,      ///< an argument that was not given
  undefined,  ///< undef, None
  truth,
  number,
  text,
  list,
  outlines,
  surface,
  other
};

class Value {
 public:
  using List = std::vector<Value>;

  Value() = default;
  Value(double number) : type_(Type::number), number_(number) {}  // NOLINT: numbers are values
  Value(std::string text);                                        // NOLINT
  Value(List list);                                               // NOLINT
  Value(Outlines outlines);                                       // NOLINT
  Value(std::shared_ptr<const Surface> surface);                  // NOLINT
  Value(Other other);                                             // NOLINT
  static Value truth(bool b) { return Value(Type::truth, b ? 1.0 : 0.0); }
  static Value unset() { return Value(Type::unset, 0.0); }

  Type type() const { return type_; }
  bool is(Type type) const { return type_ == type; }

  // Each asserts the type.
  bool truth() const { return of(Type::truth) != 0.0; }
  double number() const { return of(Type::number); }
  const std::string& text() const;
  const List& list() const;
  const Outlines& outlines() const;
  const std::shared_ptr<const Surface>& surface() const;
  const std::string& other() const;

  /// As a condition: false, 0, "", an empty list and an undefined value are false.
  bool is_true() const;

 private:
  struct Content;  // of what is no number
  Value(Type type, double number) : type_(type), number_(number) {}
  Value(Type type, Content content);
  double of([[maybe_unused]] Type type) const {
    assert(type_ == type);
    return number_;
  }
  const Content& content(Type type) const;

  Type type_ = Type::undefined;
  double number_ = 0.0;
  std::shared_ptr<const Content> content_;
};

/// "1.5", "true", "text", "undef": a value as comments and messages of programs show it; a list as its items
/// in square brackets.
std::string text_of(const Value& value);

}  // namespace kerf::design
