// Operations of gcmc programs, by the rows and the keys of `kerf cut`.
#include "job/gcmc_workshop.h"

#include <fmt/format.h>

#include "base/codes/gcmc.h"
#include "tool/tool_comments.h"
#include "tool/tool_description.h"

#include "kerf/formats/workshop_files.h"
#include "kerf/job/cut_program.h"

namespace kerf {
namespace {

constexpr double kClosed = 1e-9;  // mm, between the ends of a closed outline

Outline outline_of(const std::vector<std::array<double, 3>>& points, bool is_area) {
  Outline outline{{points.front()[0], points.front()[1]}};
  for (std::size_t i = 1; i < points.size(); ++i) outline.segments.push_back({{points[i][0], points[i][1]}});
  if (outline.segments.empty()) return outline;
  if (distance(outline.segments.back().to, outline.start) <= kClosed)
    outline.segments.back().to = outline.start;
  else if (is_area)
    outline.segments.push_back({outline.start});
  return outline;
}

std::vector<ArtShape> shapes_for(const CutRow& row, const GcmcOperation& operation) {
  std::vector<ArtShape> shapes;
  for (const auto& points : operation.shapes) {
    if (row.input == CutInput::points || row.input == CutInput::circles) {
      for (const auto& [x, y, d] : points) {
        ArtShape& shape = shapes.emplace_back();
        if (row.input == CutInput::points) {
          shape.point = Point2{x, y};
        } else {
          shape.circle = Circle{{x, y}, mm(d / 2)};
          shape.outline = as_outline(*shape.circle);
        }
      }
    } else {
      shapes.emplace_back().outline = outline_of(points, row.cuts_region());
    }
  }
  return shapes;
}

class Workshop final : public GcmcWorkshop {
 public:
  std::optional<std::string> tool_comment(const std::string& text, double scale, const TextLocation& where,
                                          Diagnostics& diagnostics) const override {
    const auto tool = read_tool_option(text, where, diagnostics);
    if (!tool) return std::nullopt;
    if (auto comment = write_tool_comment(tool->shape, scale)) return comment;
    return write_tool_description(*tool);
  }

  std::optional<Toolpath> cut(const GcmcOperation& operation, Diagnostics& diagnostics,
                              Progress* progress) const override {
    const CutRow* row = cut_row(operation.name);
    if (row != nullptr && (row->laser || row->cuts_mesh())) row = nullptr;
    if (row == nullptr) {
      diagnostics.error(codes::gcmc_arguments, operation.where,
                        fmt::format("'{}' is not an operation on outlines or points", operation.name));
      return std::nullopt;
    }
    CutValues values{{"op", CutValue(operation.name)}};
    for (const auto& [key, value] : operation.keys) values.emplace_back(key, CutValue(value));
    auto job = cut_job_of(values, diagnostics);
    if (!job) return std::nullopt;
    CutOperation& only = job->operations.front();
    only.tool = operation.tool;
    only.name = operation.name;
    only.where = operation.where;
    job->tools[operation.tool] = operation.tool_text;
    job->shapes = shapes_for(*row, operation);
    auto program = load_cut_job(*job, "", operation.where.file, diagnostics, progress);
    if (!program) return std::nullopt;
    return std::move(program->path);
  }
};

}  // namespace

const GcmcWorkshop& gcmc_workshop() {
  static const Workshop workshop;
  return workshop;
}

}  // namespace kerf
