// The arguments of the modules of OpenSCAD, and what the modules have in common.
#pragma once

#include <string_view>
#include <vector>

#include "front/scad/run/solids.h"

namespace kerf::scad {

/// What a vector of numbers may be.
struct VectorForm {
  std::size_t least = 1, max = 3;  // values
  bool number = true;              // one number for all of them
};

/// The arguments of a module by the names of its parameters. Wrong values are errors.
class Arguments {
 public:
  /// Warns of arguments that have no parameter.
  explicit Arguments(ModuleCall& call);

  const Value& operator[](std::string_view name) const;
  bool given(std::string_view name) const { return !(*this)[name].is_undef(); }
  /// true; no other value, as in OpenSCAD.
  bool flag(std::string_view name) const;
  /// A finite number; another value is an error, and gives `otherwise`.
  double number(std::string_view name, double otherwise) const;
  /// Values that are not given are those of `otherwise`.
  Point3 vector(std::string_view name, Point3 otherwise, const VectorForm& form = {}) const;
  /// A string; empty if there is none.
  std::string text(std::string_view name) const;
  void wrong(std::string_view name, std::string_view expected) const;

 private:
  ModuleCall& call_;
};

/// The union of the children.
Shape children_of(ModuleCall& call);
/// One shape for each child that makes any, in order.
Shapes separate_children(ModuleCall& call);
void give(ModuleCall& call, Shape shape);
void refuse(ModuleCall& call, std::string message, std::string hint);
/// A radius from r or d.
double radius_of(const Arguments& a, double otherwise, std::string_view r = "r", std::string_view d = "d");
/// True, with an error, for what is not above 0.
bool not_positive(ModuleCall& call, double x, std::string_view what);
/// The number of edges of a circle; 0: it is a true circle.
int edges_of(ModuleCall& call);
/// A circle around the origin: of as many edges as $fn says, else of arcs.
Region circle_region(ModuleCall& call, double radius);
Region rectangle(Point2 low, Point2 high);

// Areas.
void circle(ModuleCall& call);
void square(ModuleCall& call);
void polygon(ModuleCall& call);
void offset_module(ModuleCall& call);
void text_module(ModuleCall& call);
void hull_module(ModuleCall& call);
void minkowski_module(ModuleCall& call);
void import_module(ModuleCall& call);
// Solids.
void cube(ModuleCall& call);
void cylinder(ModuleCall& call);
void sphere(ModuleCall& call);
void polyhedron(ModuleCall& call);
void linear_extrude(ModuleCall& call);
void rotate_extrude(ModuleCall& call);
void projection(ModuleCall& call);

}  // namespace kerf::scad
