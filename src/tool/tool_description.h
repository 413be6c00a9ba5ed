// The description of a tool in the comments that Kerf writes, with all of its sizes and their units:
// "keyhole, diameter 9.525 mm, head 3.175 mm, neck diameter 6.35 mm, flute 6.35 mm".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/tool/tool.h"

namespace kerf {

/// The text for a tool; read_tool_description makes the same tool of it (sizes within a millionth of a mm). A
/// flute of assumed length is left out, so that it is assumed again.
std::string write_tool_description(const Tool& tool);

/// The neck without what the shape itself brings of it: that of the keys neck_diameter and neck_length.
Profile neck_of_body(const Tool& tool);

/// True if a text starts as those of write_tool_description do: with the name of a shape and a comma.
bool starts_tool_description(std::string_view text);

/// The tool that a text in this form describes. Nothing without a message for all other texts; nothing with
/// errors for sizes of which there is no tool. The description of the tool is the text.
std::optional<Tool> read_tool_description(std::string_view text, int number, const Origin& where,
                                          Diagnostics& diagnostics);

/// True for a tool that read_tool_description has made: it is known with all of its sizes.
bool is_from_description(const Tool& tool);

}  // namespace kerf
