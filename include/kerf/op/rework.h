// All changes that can be made to a finished program, in one call: what `kerf post` and the bindings offer.
//
//   ReworkOptions options;
//   set_rework(options, "step-down", "2");
//   const auto changed = rework(path, {{1, mm(6)}}, options, diagnostics);
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/op/leads.h"
#include "kerf/op/order.h"
#include "kerf/op/resume.h"
#include "kerf/op/step_down.h"
#include "kerf/op/tabs.h"
#include "kerf/op/transform.h"
#include "kerf/toolpath.h"

namespace kerf {

/// Applied in this order, each where it is given.
struct ReworkOptions {
  ResumeOptions resume{};    ///< line 0: from the start
  LeadOptions leads{};       ///< as `passes` has `top` and `part`; sizes 0: none
  StepDownOptions passes{};  ///< stepdown 0 and plunge: as it is
  TabOptions tabs{};         ///< height 0: none
  bool order = false;
  PathTransform transform{};
  bool reverse_loops = false;  ///< climb becomes conventional and the other way round
  Copies copies{};
};

/// One of the options as text: for command lines and bindings.
struct ReworkKey {
  std::string_view name;     ///< "step-down"
  std::string_view value;    ///< "MM", or empty for one that is given or not
  std::string_view meaning;  ///< one line
  /// Empty, or what it can be instead: "a whole number from 1 to 1000".
  std::string (*set)(ReworkOptions& options, std::string_view text) = nullptr;
};
const std::vector<ReworkKey>& rework_keys();
/// Empty, or why it is not set: that there is no such key, or what its value can be.
std::string set_rework(ReworkOptions& options, std::string_view name, std::string_view text);

struct Reworked {
  Toolpath path;
  std::optional<Ordered> ordered;  ///< without its path; if requested
};
/// `diameters`: of the tools by number. Nothing, with an error, where one of the changes is not possible.
std::optional<Reworked> rework(Toolpath path, const std::map<int, Length>& diameters,
                               const ReworkOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
