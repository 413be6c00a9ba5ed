// The shapes that the operations of a job cut, and the order in which they are cut.
#pragma once

#include "kerf/program/cut_job.h"

namespace kerf::cut_detail {

/// An operation, or its part on some of its shapes.
struct CutUnit {
  const CutOperation* operation = nullptr;
  std::vector<const ArtShape*> shapes;
  bool whole = false;  ///< its work does not lie at its shapes: a mesh, the stock, nothing
};

/// The circle that a shape is, if it is one.
std::optional<Circle> circle_of(const ArtShape& shape);
/// The stock seen from above, as an outline.
ArtShape top_of(const Box3& stock);
/// Whether an operation names neither layers nor outlines.
bool selects_all(const CutOperation& operation);

/// The shapes of each operation, as they are written; `stock_top` is that of the job's stock. Nothing, with
/// errors, if an operation names layers or outlines that do not exist.
std::optional<std::vector<CutUnit>> select_shapes(const CutJob& job, const std::vector<ArtShape>& art,
                                                  const ArtShape& stock_top, Diagnostics& diagnostics);

/// In the order of the job. What an operation cuts out comes after the work inside of it, whatever is
/// written, but in the order `as_written`, where that is a warning. Work in the same area keeps its order.
std::vector<CutUnit> in_order(const std::vector<CutUnit>& written, const CutJob& job,
                              const std::map<int, Tool>& tools, Diagnostics& diagnostics);

}  // namespace kerf::cut_detail
