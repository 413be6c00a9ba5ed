// Steps of a toolpath in Python: helpers of motions, and the steps without a motion.
#pragma once

#include <map>
#include <memory>

#include "bindings.h"

#include "kerf/path/toolpath.h"
#include "kerf/tool/tool.h"

namespace kerf::python {

/// Raises ValueError unless the feed is above 0 and within the limits.
Feed positive_feed(double value);
/// Sets the positions of the axes A, B and C at the end of a motion; None: they do not move.
void set_rotary(Toolpath& path, std::size_t motion, const pybind11::object& rotary);
/// Bits 1, 2, 4 of the axes that letters name; `argument` for the message of a ValueError.
unsigned axes_named(const std::string& letters, const char* argument);
/// Shared with a machine of gcodepreview that adds to it.
using ToolpathClass = pybind11::class_<Toolpath, std::shared_ptr<Toolpath>>;
void bind_steps(ToolpathClass& c);
/// The attribute of a Toolpath with the tools of the programs in it, by number.
inline constexpr const char* kToolsOfPath = "_tools";
/// Stores the tools of the programs in a toolpath with its object, for `append`.
void remember_tools(const pybind11::handle& path, const std::map<int, Tool>& tools);

}  // namespace kerf::python
