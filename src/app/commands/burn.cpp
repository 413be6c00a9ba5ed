// The burn of a laser: options, pictures and figures.
#include "app/commands/burn.h"

#include <algorithm>
#include <fmt/format.h>

#include "app/options/common.h"
#include "base/codes/files.h"
#include "base/number.h"
#include "job/record/figures.h"
#include "job/record/record.h"

#include "kerf/base/limits.h"

namespace kerf::app {
namespace {

constexpr double kMaxPower = 1e5;   // W
constexpr double kMaxEnergy = 1e9;  // J/mm2

bool are_pictures(const std::vector<PartFile>& files, Diagnostics& diagnostics) {
  const auto other =
      std::find_if(files.begin(), files.end(), [](const PartFile& file) { return !file.is_picture(); });
  if (other == files.end()) return true;
  diagnostics
      .error(codes::output_kind_unknown, CallLocation{"", 0, "-o"},
             fmt::format("\"{}\": a burn is written as a picture only", other->path))
      .hint = "-o burn.png";
  return false;
}

/// The energy that is black in the picture, J/mm2.
double black_of(const BurnCommand& burn, const BurnMap& map) {
  return burn.black > 0.0 ? burn.black : map.usual_highest;
}

void print(Console& console, const BurnCommand& burn, const Program& program, const BurnMap& map,
           const std::vector<PartFile>& files, const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    Record out;
    out["source"] = program.source;
    Record& figures = out["burn"] = record_of(map);
    figures["black_j_mm2"] = record_of(black_of(burn, map));
    figures["beam_mm"] = record_of(burn.beam);
    figures["max_power_w"] = record_of(burn.power);
    figures["max_s"] = record_of(burn.max_s);
    out["outputs"] = record_of(files);
    out["diagnostics"] = record_of(diagnostics);
    console.print_json(text_of(out, Layout::indented));
    return;
  }
  console.summary(fmt::format("{}: {} steps", program.source, program.path.size()));
  console.summary(fmt::format("laser    {} W at S {}, beam {} mm", number_text(burn.power, 3),
                              number_text(burn.max_s, 1), number_text(burn.beam, 3)));
  console.summary(fmt::format("beam on  {} s, {} J on {} mm2", number_text(map.on.seconds(), 1),
                              number_text(map.joules, 2), number_text(map.burnt_mm2, 1)));
  console.summary(fmt::format("highest  {} J/mm2 at X{} Y{}; black from {} J/mm2 on",
                              number_text(map.highest, 3), number_text(map.highest_at.x, 2),
                              number_text(map.highest_at.y, 2), number_text(black_of(burn, map), 3)));
  show_written(console, files);
}

}  // namespace

void add_burn_options(CommandParser& parser, BurnCommand& burn) {
  burn.options = {add_length(parser, "--spot", burn.beam, limits::kThinnestBeam, limits::kWidestBeam,
                             "Diameter of the laser's beam for a burn (default: 0.1)"),
                  add_number(parser, "--max-power", burn.power, 1e-6, kMaxPower, "W",
                             "Power of the laser's light at full S for a burn (default: 5)"),
                  add_number(parser, "--max-s", burn.max_s, 1e-6, limits::kMaxSpeed, "S",
                             "S of full power for a burn, $30 in GRBL (default: 1000)"),
                  add_number(parser, "--black", burn.black, 0.0, kMaxEnergy, "J/mm2",
                             "Energy that is black in the picture of a burn (default: what 99% of the "
                             "burnt area do not exceed)")};
}

Status run_burn(Console& console, const BurnCommand& burn, const Program& program,
                const std::vector<PartFile>& files, const View& view, TerminalProgress& progress,
                Diagnostics& diagnostics) {
  if (!are_pictures(files, diagnostics)) return fail(console, diagnostics, Status::input_errors);
  const BurnOptions options{.beam = mm(burn.beam), .full_power = burn.power, .full_s = burn.max_s};
  const auto map = map_burn(program.path, options, diagnostics, &progress);
  OutputSet set(program.files);
  bool written = map.has_value();
  if (written && !files.empty()) {
    const std::string bytes = burn_picture(*map, burn.black, view.width, view.height);
    written = std::all_of(files.begin(), files.end(),
                          [&](const PartFile& file) { return set.write(file.path, bytes, diagnostics); });
  }
  if (const auto end = finish_outputs(console, progress, written, set, diagnostics)) return *end;
  print(console, burn, program, *map, files, diagnostics);
  return Status::done;
}

}  // namespace kerf::app
