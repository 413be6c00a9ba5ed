// The shapes that a job file contains itself.
#pragma once

#include "base/toml.h"

#include "kerf/program/cut_job.h"

namespace kerf::cut_detail {

/// Reads a [[shape]]: one of rectangle, circle, polygon, line and point. Nothing, with an error, if invalid.
std::optional<ArtShape> read_shape(const toml::node& node, const std::string& file, Diagnostics& diagnostics);

/// A value as keys take it; a pair of numbers is a point.
std::optional<CutValue> value_of(const toml::node& value);
/// A coordinate or a length in mm: a number, or a text with a unit.
std::optional<double> length_of(const toml::node& value);

/// Whether a [[shape]] is a text.
bool is_text_shape(const toml::node& node);
/// Reads a [[shape]] that is a text. Nothing, with an error, if invalid.
std::optional<TextShape> read_text_shape(const toml::node& node, const std::string& file,
                                         Diagnostics& diagnostics);

/// Likewise a [[shape]] that is a picture.
bool is_picture_shape(const toml::node& node);
std::optional<PictureShape> read_picture_shape(const toml::node& node, const std::string& file,
                                               Diagnostics& diagnostics);
/// Reads [surface]: the name of a mesh file, or heights. Nothing, with errors, if invalid.
std::optional<CutSurface> read_surface(const toml::table& table, const std::string& file,
                                       Diagnostics& diagnostics);

}  // namespace kerf::cut_detail
