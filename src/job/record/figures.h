// The records of findings and figures: of milling, prints, times, comparisons and burns.
#pragma once

#include <string>
#include <vector>

#include "job/filament.h"
#include "job/planned_print.h"
#include "job/record/record.h"

#include "kerf/job/findings.h"
#include "kerf/job/job.h"
#include "kerf/job/outputs.h"
#include "kerf/op/level.h"
#include "kerf/sim/burn.h"
#include "kerf/sim/compare.h"
#include "kerf/sim/print.h"

namespace kerf {

Record record_of(const Finding& finding);
Record record_of(const std::vector<Finding>& findings);
/// As findings, with the length and volume of the contact.
Record record_of(const std::vector<PrintHazard>& hazards, const Toolpath& path);

Record record_of(const MotionFigures& figures);
Record record_of(const TimeFigures& time);
/// The times of a job: all, by tool and by operation, and how they were computed.
Record record_of(const JobTimes& times);

/// {"stock_mm3":.., "removed_mm3":.., "left_mm3":..}
Record record_of_volumes(Volume stock, Volume removed);
/// A tool of a table: number, shape, dimensions, names.
Record record_of_tool(int number, const Tool& tool);
/// The bar, or the block with its source; null for a job without stock.
Record record_of_stock(const Job& job);

Record record_of(const PrintVolumes& volumes);
Record record_of(const PrintLayer& layer);
/// Volumes of the whole print, with what was extruded in place.
Record record_of_totals(const PrintVolumes& volumes);
/// The lowest and highest of the layers' heights, mm.
Range heights_of(const PrintFigures& figures);
Record record_of(const PrintFigures& figures, const Filament& filament);
/// The time of a print and what planned it, with the machine or printer whose limits are used ("": none).
struct TimeOfPrint {
  Duration motion, dwell;
  std::string method, machine;
};
Record record_of(const TimeOfPrint& time);
/// The highest flow of a planned print with its step, and the limit, mm3/s; null where there is none.
Record record_of_flow(const PlannedPrint& plan);

/// Volumes, sides and regions of a comparison.
Record record_of(const Comparison& comparison);
Record record_of(const BurnMap& map);
Record record_of(const LevelReport& report);
/// The paths of files that were written.
Record record_of(const std::vector<PartFile>& files);

}  // namespace kerf
