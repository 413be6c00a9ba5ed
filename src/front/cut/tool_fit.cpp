// Which kinds of tools an operation can be cut with: a table of operations by names of shapes.
#include "front/cut/tool_fit.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "base/codes/op.h"

namespace kerf::cut_detail {
namespace {

// Kinds of tools, by what they can do.
enum Can : unsigned {
  sides = 1,      // cuts with its side, and enters from above
  undercuts = 2,  // cuts with its side, and is wider below
  holes = 4,      // makes a hole straight down
  threads = 8,    // has the profile of a thread
  slopes = 16,    // its edge becomes wider upwards
  any = 31
};

struct KindRow {
  std::string_view shape;
  unsigned can;
};
constexpr std::array kKinds{KindRow{"square", sides | holes},
                            KindRow{"ball", sides | slopes},
                            KindRow{"bull nose", sides | slopes},
                            KindRow{"bowl", sides | slopes},
                            KindRow{"V", sides | holes | slopes},
                            KindRow{"tapered ball", sides | slopes},
                            KindRow{"flat groove", sides | slopes},
                            KindRow{"chamfer", sides | slopes},
                            KindRow{"roundover", sides | slopes},
                            KindRow{"corner rounding", sides | slopes},
                            KindRow{"drill", holes},
                            KindRow{"centre drill", holes},
                            KindRow{"keyhole", undercuts},
                            KindRow{"dovetail", undercuts},
                            KindRow{"T-slot", undercuts},
                            KindRow{"lollipop", undercuts | threads},
                            KindRow{"thread mill", threads}};

struct NeedRow {
  std::string_view operation;
  unsigned needs;  // one of these
};
// Other operations, such as those on meshes and keyhole, test the form of the tool itself.
constexpr std::array kNeeds{NeedRow{"pocket", sides},
                            NeedRow{"contour", sides},
                            NeedRow{"engrave", sides},
                            NeedRow{"isolation", sides},
                            NeedRow{"face", sides},
                            NeedRow{"bore", sides},
                            NeedRow{"vcarve", slopes},
                            NeedRow{"trochoidal-slot", sides},
                            NeedRow{"vcarve-floor", sides},
                            NeedRow{"drill", holes},
                            NeedRow{"slot", sides | undercuts},
                            NeedRow{"thread", threads},
                            NeedRow{"chamfer", slopes}};

unsigned abilities(std::string_view shape) {
  const auto row =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const KindRow& k) { return k.shape == shape; });
  return row == kKinds.end() ? any : row->can;  // a drawn shape may be anything
}

}  // namespace

bool suits(const Tool& tool, const CutOperation& operation, Diagnostics& diagnostics) {
  const auto need = std::find_if(kNeeds.begin(), kNeeds.end(),
                                 [&](const NeedRow& n) { return n.operation == operation.row->name; });
  if (need == kNeeds.end() || (abilities(name_of(tool.shape)) & need->needs) != 0) return true;
  std::string others;
  for (const KindRow& kind : kKinds)
    if ((kind.can & need->needs) != 0) others += (others.empty() ? "" : ", ") + std::string(kind.shape);
  diagnostics
      .error(codes::op_tool_kind, operation.where,
             fmt::format("{}: tool {} ({}) cannot do the operation {}", operation.name, operation.tool,
                         name_of(tool.shape), operation.row->name))
      .hint = "tools that can: " + others;
  return false;
}

}  // namespace kerf::cut_detail
