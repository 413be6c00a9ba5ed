// A setup sheet: what the operator of a machine needs beside the program, on one page. Stock and zero as a
// drawing, tools with their stick-out, operations in order, times, fixtures and what was found.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/job/job.h"
#include "kerf/program/post.h"

namespace kerf {

/// All as texts, in the unit of the sheet.
struct SetupSheet {
  struct Column {
    std::string head;
    double width = 1.0;  // in proportion to the others
  };
  struct Table {
    std::string id, title;  // "tools", "Tools"
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows;  // a row of one cell covers all columns
    /// Of the first cells: the layer of the plan whose line it shows; kNoLayer: none.
    std::vector<std::size_t> layers;
  };
  static constexpr std::size_t kNoLayer = static_cast<std::size_t>(-1);
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // "Stock", "100 x 60 x 12 mm ..."
  std::vector<Table> tables;                               // only those with rows
  Drawing plan;                                            // mm on paper
};

struct SetupSheetOptions {
  const Machine* machine = nullptr;     // for the times; nullptr: by the feeds alone
  std::optional<LengthUnit> unit = {};  // nothing: that of the program
};

/// The sheet of a job that cuts. The job is checked for it; what `diagnostics` hold is listed with the
/// findings. Nothing, with an error, for a print; nothing if stopped.
std::optional<SetupSheet> setup_sheet(const Job& job, const SetupSheetOptions& options,
                                      Diagnostics& diagnostics, Progress* progress = nullptr);

/// A page that needs no other file, for A4 or letter paper.
std::string setup_sheet_html(const SetupSheet& sheet);
/// The same as one drawing, in mm.
std::string setup_sheet_svg(const SetupSheet& sheet);

}  // namespace kerf
